# SPDX-License-Identifier: Apache-2.0
"""Kinds of events, and the sentences in which the code refuses something."""

import ast
import re
from functools import cache
from pathlib import Path

from reference.markdown import code, page, prose, table
from reference.pages import ROOT

ADVICE = ROOT / "scripts/reference/advice.txt"
# Messages whose constants are states, kinds or outcomes.
CONSTANT = re.compile(r"^u?int\d+ (\w+)\s*=\s*(\d+)\s*(?:#\s*(.*))?$", re.M)
RAISED = re.compile(
    r"(?:\bthrow [\w:]+\(|\brefuse\(|\bfail\(|warn\(|ROS_(?:ERROR|FATAL|WARN)\w*\()"
)
PLACEHOLDER = re.compile(r"%[-+.\d]*(?:[a-z]|l[a-z])(?![a-z])")  # of printf
ERRORS = re.compile(r"(Error|Exception|Refusal|Refused|refused|refuse|error)$")


def kinds() -> dict[str, list[tuple[str, str, str]]]:
    """Returns {message or service: (constant, number, comment)}."""
    files = sorted(ROOT.glob("src/warehouse_msgs/msg/*.msg")) + sorted(
        ROOT.glob("src/warehouse_msgs/srv/*.srv")
    )
    return {
        path.stem: constants for path in files if (constants := CONSTANT.findall(path.read_text()))
    }


def refusals() -> dict[str, list[tuple[str, str]]]:
    """Returns {package: (sentence, place)}, with … for what only running code knows."""
    out: dict[str, list[tuple[str, str]]] = {}
    for package in sorted(ROOT.glob("src/*/package.xml")):
        sentences = []
        for file in sorted(package.parent.rglob("*")):
            place = str(file.relative_to(package.parent))
            if file.suffix in (".cpp", ".h") and "examples" not in file.parts:
                sentences += [(sentence, place) for sentence in of_cpp(file.read_text())]
            elif is_python(file):
                sentences += [(sentence, place) for sentence in of_python(file.read_text())]
        if sentences:
            out[package.parent.name] = list(dict.fromkeys(sentences))
    return out


def is_python(file: Path) -> bool:
    """Returns whether a file is Python code of a package."""
    return (
        file.is_file()
        and "__pycache__" not in file.parts
        and (file.suffix == ".py" or file.parent.name == "nodes")
    )


def of_cpp(text: str) -> list[str]:
    """Returns the sentences that C++ code throws, refuses or warns with."""
    out = []
    for begun in RAISED.finditer(text):
        inside = _arguments(text, begun.end())
        parts = re.findall(r'"((?:[^"\\]|\\.)*)"', re.sub(r'"\s*\n\s*"', "", inside))
        sentence = "…".join(part.replace('\\"', '"').replace("\\n", " ") for part in parts)
        sentence = PLACEHOLDER.sub("…", sentence)
        if is_sentence(sentence):
            out.append(sentence.strip())
    return out


def is_sentence(text: str) -> bool:
    """Returns whether a literal says something by itself."""
    return len(re.findall(r"[a-z]{2,}", text)) > 1


def _arguments(text, begin):
    """What stands within parentheses that were opened just before `begin`."""
    depth, at = 1, begin
    while depth and at < len(text):
        depth += {"(": 1, ")": -1}.get(text[at], 0)
        at += 1
    return text[begin : at - 1]


def of_python(text: str) -> list[str]:
    """Returns the sentences that Python code raises, refuses or ends with."""
    out = []
    for node in ast.walk(ast.parse(text)):
        call = node.exc if isinstance(node, ast.Raise) else node
        if not isinstance(call, ast.Call) or not call.args:
            continue
        name = (
            call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
        )
        if (
            isinstance(node, ast.Raise)
            or ERRORS.search(name)
            or name in ("exit", "logwarn", "logerr", "warn")
        ):
            out += [
                sentence for argument in call.args if is_sentence(sentence := _sentence(argument))
            ]
    return list(dict.fromkeys(out))


def _sentence(node):
    """A literal's text, with … for what is computed."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(
            part.value if isinstance(part, ast.Constant) else "…" for part in node.values
        )
    if isinstance(node, ast.BinOp):
        return _sentence(node.left) + _sentence(node.right)
    return ""


@cache
def advices() -> list[tuple[re.Pattern[str], bool, str]]:
    """Returns what to do, by a pattern; whether the pattern is one of places, else of sentences."""
    lines = [line for line in ADVICE.read_text().splitlines() if line and line[0] != "#"]
    parts = [line.partition(" => ") for line in lines]
    return [
        (re.compile(pattern.removeprefix("@")), pattern[0] == "@", advice)
        for pattern, _, advice in parts
    ]


def advice(package: str, sentence: str, place: str) -> str:
    """Returns what to do about a refusal of a package's file, "" where nothing is known.

    The first pattern that is found holds.
    """
    of_sentence, of_place = f"{package}: {sentence}", f"{package}/{place}"
    remedies = (
        remedy
        for pattern, is_place, remedy in advices()
        if pattern.search(of_place if is_place else of_sentence)
    )
    return next(remedies, "")


def written() -> str:
    """Returns the page of events and refusals."""
    parts = []
    for name, constants in kinds().items():
        folder = (
            "messages" if (ROOT / f"src/warehouse_msgs/msg/{name}.msg").exists() else "services"
        )
        rows = [(code(constant), number, prose(comment)) for constant, number, comment in constants]
        parts.append(
            f"### [{name}]({folder}.md#warehouse_msgs{name.lower()})\n\n"
            + table(["name", "number", ""], rows)
        )
    sentences = [
        f"### {package}\n\n"
        + table(
            ["sentence", "what to do", "in"],
            [
                (prose(sentence), advice(package, sentence, place), code(place))
                for sentence, place in sentences
            ],
        )
        for package, sentences in refusals().items()
    ]
    return page(
        "Events and refusals",
        "## Kinds, states and outcomes",
        *parts,
        "## Refusals and warnings\n\nThe sentences with which something is refused, "
        "with … for what only a running program knows, and what to do about each. "
        "[Troubleshooting](../how-to/troubleshooting.md) has the most frequent ones by occasion.",
        *sentences,
    )
