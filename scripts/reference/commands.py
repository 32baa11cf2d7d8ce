# SPDX-License-Identifier: Apache-2.0
"""Command lines, by what their programs say themselves."""

import contextlib
import io
import re
import runpy
import signal
import sys
from pathlib import Path
from unittest import mock

from reference.markdown import block, code, page, prose, table
from reference.pages import ROOT

# Where rosrun finds a program, if not in the package of its folder; `drive` is in two.
PACKAGES = {
    "warehouse_viewer/drive": "warehouse_fleet",
    "warehouse_viewer/simulate": "warehouse_fleet",
    "warehouse_viewer/replay": "warehouse_fleet",
    "warehouse_viewer/whatif": "warehouse_fleet",
    "warehouse_viewer/edit": "warehouse_layout",
    "warehouse_operations/report": "warehouse_fleet",
    "warehouse_operations/sweep": "warehouse_fleet",
    "warehouse_operations/size": "warehouse_fleet",
    "warehouse_operations/check": "warehouse_fleet",
}
NODES = (
    "viewer",
    "coordinator",
    "operations",
    "vehicles",
    "master",
)  # take parameters, and need a ROS master


def programs() -> list[Path]:
    """Returns the programs of all packages."""
    return sorted(ROOT.glob("src/*/nodes/*"), key=lambda one: one.name)


def package(program: Path) -> str:
    """Returns the package in which rosrun finds a program."""
    folder = program.parts[-3]
    return PACKAGES.get(f"{folder}/{program.name}", folder)


def modules() -> list[str]:
    """Returns the modules that a person calls by python3 -m."""
    found = []
    for file in ROOT.glob("src/*/python/**/*.py"):
        text = file.read_text()
        if "__main__" in text and "ArgumentParser" in text:
            top = next(one for one in file.parents if one.name == "python")
            found.append(".".join(file.relative_to(top).with_suffix("").parts))
    return sorted(found)


def is_command(program: Path) -> bool:
    """Returns whether a program is one that a person calls with options."""
    text = program.read_text()
    return program.name not in NODES and ("ArgumentParser" in text or "command.main" in text)


def written() -> str:
    """Returns the page of command lines: what each prints on --help."""
    called = [
        (f"rosrun {package(one)} {one.name}", [str(one)]) for one in programs() if is_command(one)
    ]
    called += [(f"python3 -m {one}", ["-m", one]) for one in modules()]
    called.append(("scripts/film", [str(ROOT / "scripts/film")]))
    sections = [section(*one) for one in called]
    nodes = [
        (code(one.name), code(one.parts[-3]), prose(docstring(one)))
        for one in programs()
        if not is_command(one)
    ]
    return page(
        "Command lines",
        "Run them after `source devel/setup.bash`, or that of an install space. "
        "`make` without a target lists the targets of the source tree.",
        *sections,
        "## Nodes\n\nLaunch files start these; they take [parameters](parameters.md).\n\n"
        + table(["node", "package", ""], nodes),
    )


def section(name: str, command: list[str]) -> str:
    """Returns a program's help, with that of its commands."""
    told = helped(command)
    inner = re.search(r"\{([\w,-]+)\}\s*\.\.\.", told)
    parts = [f"## {name}", block(told)]
    for one in inner[1].split(",") if inner else []:
        parts += [f"### {name} {one}", block(helped([*command, one]))]
    return "\n\n".join(parts)


def helped(command: list[str]) -> str:
    """Returns what a command prints on --help.

    It runs in this process: what all of them import is imported once.
    """
    out = io.StringIO()
    handlers = {
        one: signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE)
    }
    environment = mock.patch.dict("os.environ", COLUMNS="100", NO_COLOR="1")
    as_module = command[0] == "-m"
    argv = command[1:] if as_module else command
    arguments = mock.patch.object(sys, "argv", [*argv, "--help"])
    run = runpy.run_module if as_module else runpy.run_path
    with environment, arguments, contextlib.redirect_stdout(out), contextlib.suppress(SystemExit):
        run(argv[0], run_name="__main__")
    for one, handler in handlers.items():
        signal.signal(one, handler)
    if "usage:" not in out.getvalue():
        raise ValueError(f"{' '.join(command)} --help prints no usage")
    return out.getvalue()


def docstring(program: Path) -> str:
    """Returns the first paragraph of a program's docstring."""
    found = re.search(r'^"""(.*?)(?:\n\n|""")', program.read_text(), re.M | re.S)
    return " ".join(found[1].split()) if found else ""
