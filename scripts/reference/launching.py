# SPDX-License-Identifier: Apache-2.0
"""Arguments of launch files, and parameters of nodes."""

import ast
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from reference.markdown import code, page, prose, table
from reference.pages import ROOT

SETTINGS = ROOT / "src/kiva_plugin_cpp/src/ros/settings.h"
DEFAULTS = {"layout.SEED": "1", "SECONDS": "3600.0"}  # that have names in the code
# What launch files do not tell of parameters of Python nodes.
MEANINGS = {
    "~taken": "kept by the node for its next run: the former mode of each robot that an order has",
    "~rate": "requests a second that each address may send",
    "~history": "simulated seconds that can be looked at again; 0: none",
    "~deadline": "until which a step of the demonstration has to come true [s]",
    "~delivery": "for which the fleet delivers [s]",
    "~demand": "transports beside those requested: none, or random, which keeps all stations busy",
    "~max_topics": "topics that are kept at most, one a tracked object",
    "~patient": "true: wait for the warehouse without an end",
    "~size": "the warehouse to build, or whose shift it is",
    "~world": "the world file that runs",
}


def launch_files() -> list[Path]:
    """Returns all launch files."""
    return sorted(
        {*ROOT.glob("launch/*.launch"), *ROOT.glob("src/warehouse_vda5050/launch/*.launch")}
    )


def launches() -> str:
    """Returns the page of launch arguments."""
    sections = []
    for file in launch_files():
        package = "warehouse_vda5050" if "vda5050" in str(file) else "warehouse_sim"
        rows = [
            (
                code(argument.get("name")),
                code(argument.get("default", "")),
                prose(argument.get("doc", "")),
            )
            for argument in ElementTree.parse(file).getroot().iter("arg")
            if "value" not in argument.attrib and argument.get("doc")
        ]
        description = (
            table(["argument", "default", ""], rows)
            if rows
            else "It takes no arguments of its own."
        )
        sections.append(
            f"## {file.name}\n\n`roslaunch {package} {file.name}`\n\n{comment(file)}"
            f"\n\n{description}"
        )
    about = (
        "Give arguments as `NAME:=VALUE`. A wrong value or an unknown argument ends the "
        "launch before it starts, with a sentence for each."
    )
    return page("Launch files", about, *sections)


def comment(file: Path) -> str:
    """Returns what a launch file says of itself."""
    comments = [
        remark
        for remark in re.findall(r"<!--(.*?)-->", file.read_text(), re.S)
        if "SPDX" not in remark
    ]
    return prose(" ".join(comments[0].split())) if comments else ""


def settings() -> dict[str, str]:
    """Returns the parameters of the node /gazebo and their meanings, from its header."""
    out: dict[str, str] = {}
    name = ""
    for line in SETTINGS.read_text().splitlines():
        if begun := re.match(r"///   (~\w+) +(.*)", line):
            name = begun[1]
            out[name] = begun[2]
        elif name and (more := re.match(r"///    +(.*)|///   (\w.*)", line)):
            out[name] += " " + (more[1] or more[2])
        else:
            name = ""
    return out


def asked() -> dict[str, dict[str, str]]:
    """Returns {file: {parameter: default}} of get_param calls in Python nodes."""
    out: dict[str, dict[str, str]] = {}
    for file in sorted(ROOT.glob("src/*/nodes/*")) + sorted(ROOT.glob("src/*/python/**/*.py")):
        text = file.read_text()
        arguments_of = {}
        for name, rest in re.findall(r'get_param\(\s*"([~\w][\w/]+)"(?:,\s*([^()]*?))?\)', text):
            key = name if name.startswith("~") else f"/{name}"
            arguments_of[key] = DEFAULTS.get(rest.strip(), rest.strip())
        for name, default in viewer_settings(text) if file.name == "viewer" else ():
            arguments_of[name] = DEFAULTS.get(default, default)
        if arguments_of:
            out[str(file.relative_to(ROOT / "src"))] = arguments_of
    return out


def viewer_settings(text: str) -> list[tuple[str, str]]:
    """Returns the parameters of the viewer, which it reads from a table of defaults."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Dict):
            keys = [value.value for value in node.value.keys if isinstance(value, ast.Constant)]
            if "port" in keys:
                values = [ast.unparse(value) for value in node.value.values]
                return [(f"~{key}", value) for key, value in zip(keys, values)]
    return []


def meanings() -> dict[str, str]:
    """Returns what parameters mean, as launch files tell of the arguments of the same name."""
    out = dict(MEANINGS)
    for file in launch_files():
        for argument in ElementTree.parse(file).getroot().iter("arg"):
            if argument.get("doc"):
                out.setdefault(f"~{argument.get('name')}", argument.get("doc", ""))
                out.setdefault(
                    f"~{argument.get('name', '').removeprefix('viewer_')}", argument.get("doc", "")
                )
    return out


def parameters() -> str:
    """Returns the page of the nodes' parameters."""
    rows = [(code(name), prose(text)) for name, text in settings().items()]
    known, sections = meanings(), []
    for file, arguments_of in asked().items():
        own = [
            (code(name), code(value), prose(known.get(name, "")))
            for name, value in arguments_of.items()
            if name.startswith("~")
        ]
        if own:
            sections.append(
                f"## {Path(file).name.removesuffix('.py')}\n\nRead by `src/{file}`.\n\n"
                + table(["parameter", "default", ""], own)
            )
    shared = sorted(
        {name for arguments_of in asked().values() for name in arguments_of if name.startswith("/")}
        | set(SHARED)
    )
    return page(
        "Parameters",
        "Launch files set them; see [launch files](launch.md).",
        "## gazebo\n\nThe node of the world.\n\n" + table(["parameter", ""], rows),
        *sections,
        "## Of the warehouse\n\n"
        + table(["parameter", ""], [(code(name), SHARED.get(name, "")) for name in shared]),
    )


SHARED = {
    "/gazebo/autosave": "how many checkpoints the world keeps for `/warehouse/undo`",
    "/viewer/address": "the address of the page",
    "/warehouse/emergency_stop": "who holds the fleet's emergency stop, since when; or empty",
    "/warehouse/floor": "the floor's lowest and highest x and y [m]",
    "/warehouse/layout": "the layout file of the warehouse that runs",
    "/warehouse/name": "the name of the warehouse that runs",
    "/warehouse/id": "its number",
}
