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

# Where rosrun finds a program, if not in the package of its folder.
PACKAGES = {
    "warehouse_viewer/drive": "warehouse_fleet",
    "warehouse_viewer/simulate": "warehouse_operations",
    "warehouse_viewer/replay": "warehouse_operations",
    "warehouse_viewer/whatif": "warehouse_operations",
    "warehouse_viewer/edit": "warehouse_layout",
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
    return sorted(ROOT.glob("src/*/nodes/*"), key=lambda path: path.name)


def package(program: Path) -> str:
    """Returns the package in which rosrun finds a program."""
    folder = program.parts[-3]
    return PACKAGES.get(f"{folder}/{program.name}", folder)


def modules() -> list[str]:
    """Returns the modules that a person calls by python3 -m."""
    names = []
    for file in ROOT.glob("src/*/python/**/*.py"):
        text = file.read_text()
        if "__main__" in text and "ArgumentParser" in text:
            top = next(parent for parent in file.parents if parent.name == "python")
            names.append(".".join(file.relative_to(top).with_suffix("").parts))
    return sorted(names)


def is_command(program: Path) -> bool:
    """Returns whether a program is one that a person calls with options."""
    text = program.read_text()
    return program.name not in NODES and ("ArgumentParser" in text or "command.main" in text)


def written() -> str:
    """Returns the page of command lines: what each prints on --help."""
    called = [
        (f"rosrun {package(program)} {program.name}", [str(program)])
        for program in programs()
        if is_command(program)
    ]
    called += [(f"python3 -m {program}", ["-m", program]) for program in modules()]
    called.append(("scripts/pages/film", [str(ROOT / "scripts/pages/film")]))
    sections = [section(*program) for program in called]
    nodes = [
        (code(program.name), code(program.parts[-3]), prose(docstring(program)))
        for program in programs()
        if not is_command(program)
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
    text = helped(command)
    inner = re.search(r"\{([\w,-]+)\}\s*\.\.\.", text)
    parts = [f"## {name}", block(text)]
    for subcommand in inner[1].split(",") if inner else []:
        parts += [f"### {name} {subcommand}", block(helped([*command, subcommand]))]
    return "\n\n".join(parts)


def helped(command: list[str]) -> str:
    """Returns what a command prints on --help.

    It runs in this process: what all of them import is imported once.
    """
    out = io.StringIO()
    handlers = {
        subcommand: signal.getsignal(subcommand)
        for subcommand in (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE)
    }
    environment = mock.patch.dict("os.environ", COLUMNS="100", NO_COLOR="1")
    as_module = command[0] == "-m"
    argv = command[1:] if as_module else command
    arguments = mock.patch.object(sys, "argv", [*argv, "--help"])
    run = runpy.run_module if as_module else runpy.run_path
    beside = [] if as_module else [str(Path(argv[0]).parent)]  # as if it was started itself
    paths = mock.patch.object(sys, "path", [*beside, *sys.path])
    with (
        environment,
        arguments,
        paths,
        contextlib.redirect_stdout(out),
        contextlib.suppress(SystemExit),
    ):
        run(argv[0], run_name="__main__")
    for subcommand, handler in handlers.items():
        signal.signal(subcommand, handler)
    if "usage:" not in out.getvalue():
        raise ValueError(f"{' '.join(command)} --help prints no usage")
    return out.getvalue()


def docstring(program: Path) -> str:
    """Returns the first paragraph of a program's docstring."""
    match = re.search(r'^"""(.*?)(?:\n\n|""")', program.read_text(), re.M | re.S)
    return " ".join(match[1].split()) if match else ""
