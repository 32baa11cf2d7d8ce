# SPDX-License-Identifier: Apache-2.0
"""Tables of numbers that C++ headers list in fields(): realism, and the plugins of a robot."""

import re
from typing import NamedTuple

import yaml

from reference.markdown import code, page, prose, table
from reference.pages import ROOT

HEADERS = ROOT / "src/kiva_plugin_cpp/include/kiva_plugin_cpp"
GAZEBO = ROOT / "src/kiva_plugin_cpp/src/ros/gazebo_plugins"
DAYS = ("typical", "bad_day")
# The plugins that make a robot, and where their numbers are.
ROBOT = {
    "motion": ("DriveParameters", "motionFields"),
    "rotation": ("DriveParameters", "rotationFields"),
    "lift": ("LiftParameters", "fields"),
    "laser": ("LaserParameters", "fields"),
}
# Plugins of a world, by their element's parameters.
WORLD = {
    "core/world.cpp": "Light curtain and grid of a world",
    "core/motion/wheels/ground.cpp": "Floor of another friction",
    "plugins/motion.cpp": "Motion, beside its numbers",
}
CALL = re.compile(
    r'\bp(?:arameters)?\.(number|text|flag|whole|numbers)\(\s*"(\w+)",\s*((?:[^(),{}"]|"[^"]*"|\{[^}]*\}|\([^()]*\))+)'
)
NEEDED = re.compile(r'\b(?:required|link)\(p, "(\w+)"')


PLUGINS = (
    'A plugin stands in a model or a world: `<plugin name="…" filename="lib….so">`, with its '
    "parameters inside. A parameter that a plugin of a robot or a world does not know is refused; "
    "plugins known from gazebo_ros leave unknown ones out. How to write one: "
    "[worlds](worlds.md#a-plugin-of-your-own)."
)


class Number(NamedTuple):
    """A number that a file may give."""

    name: str
    default: str
    least: str
    most: str
    comment: str


def structs(header: str) -> dict[str, tuple[str, str]]:
    """Returns {struct: (comment, body)} of a header; each default stands on its member's line."""
    text = re.sub(r" =\n +", " = ", (HEADERS / header).read_text())
    matches = re.findall(r"((?:^///[^\n]*\n)*)^struct (\w+) \{\n(.*?)^\};", text, re.M | re.S)
    return {
        name: (" ".join(re.sub(r"^/// ?", "", about, flags=re.M).split()), body)
        for about, name, body in matches
    }


def numbers(body: str, method: str = "fields") -> list[Number]:
    """Returns the numbers that a struct's method lists."""
    listed = re.search(rf"static void {method}\(.*?\n  \}}", body, re.S)
    calls = re.findall(r'field\("(\w+)", s\.(\w+), ([^,]+), ([^)]+)\)', listed[0] if listed else "")
    limits = dict(re.findall(r"\b(kMost\w+) = ([\d.e]+)", (HEADERS / "description.h").read_text()))
    limits["M_PI"] = "π"
    calls = [
        (
            name,
            member,
            *(re.sub(r"\w+$", lambda m: limits.get(m[0], m[0]), limit.strip()) for limit in ends),
        )
        for name, member, *ends in calls
    ]
    return [
        Number(name, default_of(body, member), least, most.strip(), comment_of(body, member))
        for name, member, least, most in calls
    ]


def default_of(body: str, member: str) -> str:
    """Returns a member's default."""
    match = re.search(rf"^  \w+ {member} = ([^;]+);", body, re.M)
    return match[1] if match else ""


def comment_of(body: str, member: str) -> str:
    """Returns what is said of a member: behind it, on the lines below, or above."""
    lines = body.splitlines()
    at = next(i for i, line in enumerate(lines) if re.match(rf"  \w+ {member} = ", line))
    text = [lines[at].partition("///<")[2]]
    for line in lines[at + 1 :]:
        if not re.match(r" +///<", line):
            break
        text.append(line.partition("///<")[2])
    above = at - 1
    while not "".join(text).strip() and above >= 0 and lines[above].startswith("  /// "):
        text.insert(0, lines[above].strip()[4:])
        above -= 1
    return " ".join(" ".join(text).split())


def sections() -> dict[str, str]:
    """Returns {section of a realism file: struct}."""
    text = (HEADERS / "realism.h").read_text()
    matches = re.findall(r"^  (\w+Realism) (\w+);", text, re.M)
    members = {member: struct for struct, member in matches}
    return {
        name: members[member]
        for name, member in re.findall(r'call\("(\w+)", realism\.(\w+)\)', text)
    }


def realism() -> str:
    """Returns the page of realism parameters, with the values of the days that come along."""
    days = {day: yaml.safe_load((ROOT / f"worlds/realism/{day}.yaml").read_text()) for day in DAYS}
    known, parts = structs("realism.h"), []
    for section, struct in sections().items():
        about, body = known[struct]
        rows = []
        for field in numbers(body):
            values = [valued(day.get(section), field.name) for day in days.values()]
            rows.append(
                (
                    code(field.name),
                    field.default,
                    f"{field.least} … {field.most}",
                    *values,
                    prose(field.comment),
                )
            )
        on = ", ".join(day for day, text in days.items() if text.get(section))
        description = (
            table(["number", "default", "range", *DAYS, ""], rows) if rows else "It has no numbers."
        )
        parts.append(
            f"## {section}\n\n{prose(about)}\n\nOn in: {on or 'neither day'}.\n\n{description}"
        )
    return page(
        "Realism parameters",
        "A realism file is YAML: a section is on if it is `true` or any of its "
        "numbers is given; the others are at their defaults. An unknown key is "
        "refused. The models behind the numbers and their sources are in [days that "
        "are not ideal](../explanation/realism.md).",
        *parts,
    )


def valued(section: object, name: str) -> str:
    """Returns a day's own value of a number."""
    return str(section[name]) if isinstance(section, dict) and name in section else ""


def plugins() -> str:
    """Returns the page of plugins and their parameters."""
    known = structs("fleet.h")
    parts = []
    for plugin, (struct, method) in ROBOT.items():
        about, body = known[struct]
        rows = [
            (code(field.name), field.default, f"{field.least} … {field.most}", prose(field.comment))
            for field in numbers(body, method)
        ]
        parts.append(f"## {plugin}\n\n" + table(["parameter", "default", "range", ""], rows))
    for file, title in WORLD.items():
        parts.append(
            f"## {title}\n\n" + taken((ROOT / "src/kiva_plugin_cpp/src" / file).read_text())
        )
    for file in sorted(GAZEBO.rglob("*.cpp"), key=lambda file: file.stem):
        if text := taken(file.read_text()):
            names = ", ".join(code(name) for name in libraries().get(file.stem, []))
            note = f"In {names}.\n\n" if names else ""
            parts.append(f"## gazebo_ros: {file.stem}\n\n{note}{text}")
    return page(
        "Plugins and their parameters",
        PLUGINS,
        *parts,
        "## Known libraries of gazebo_ros\n\n"
        + table(["library", "class"], [(code(name), kind) for name, kind in tabled()]),
    )


def taken(text: str) -> str:
    """Returns a table of the parameters that C++ code reads."""
    rows = [
        (code(name), kind, code(" ".join(default.split())))
        for kind, name, default in CALL.findall(text)
    ]
    rows += [(code(name), "text", "needed") for name in NEEDED.findall(text)]
    return table(["parameter", "type", "default"], dict.fromkeys(rows)) if rows else ""


def tabled() -> list[tuple[str, str]]:
    """Returns (library, class) of the plugins known from gazebo_ros."""
    text = (GAZEBO / "plugin_table.cpp").read_text()
    return re.findall(r'\{"(lib\w+\.so)",\s*&?\w*<?(\w+)', text)


def libraries() -> dict[str, list[str]]:
    """Returns {source file: libraries that it stands in for}."""
    out: dict[str, list[str]] = {}
    for library, kind in tabled():
        stem = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", kind).lower()
        out.setdefault(stem, []).append(library)
    return out
