# SPDX-License-Identifier: Apache-2.0
"""What is checked before a launch file starts anything: arguments, and that the master is free."""

import os
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from xmlrpc.client import ServerProxy

from warehouse_layout import files
from warehouse_sim import launch_arguments

TIMEOUT = 3.0  # for a world to say that it is there [s, wall]
SHARE = files.share(__file__)  # the folder with launch/
ENGINE = "/gazebo"
OURS = "$(find warehouse_sim)/"  # how a launch file names files of this package


class LaunchError(ValueError):
    """Why nothing was started, and what helps."""


class Caller:
    """The process that reads a launch file, from its command line (a list) and its folder."""

    def __init__(self, command_line, cwd, share):
        self._share = share
        names = [part.rpartition("/")[2] for part in command_line[:2]]
        self.is_roslaunch = "roslaunch" in names
        self.words = command_line[names.index("roslaunch") + 1 :] if self.is_roslaunch else []
        self.cwd = Path(cwd)

    @classmethod
    def of_process(cls, number, share):
        """The one of that number."""
        process = Path(f"/proc/{number}")
        line = (process / "cmdline").read_text(errors="replace").split("\0")
        return cls(line, os.readlink(process / "cwd"), share)

    @property
    def typed(self):
        """The arguments {name: text} that a person typed."""
        pairs = (re.fullmatch(r"(?!__)([^:=]+):=(.*)", word, re.DOTALL) for word in self.words)
        return dict(pair.groups() for pair in pairs if pair)

    def launch_file(self):
        """The one file of which the arguments are; None if that can't be told."""
        files = [word for word in self.words if word.endswith((".launch", ".xml"))]
        if len(files) != 1:
            return None
        before = self.words[: self.words.index(files[0])]
        ours = self._share / "launch" / files[0]
        path = ours if before[-1:] == ["warehouse_sim"] else self.cwd / files[0]
        return path if path.is_file() else None

    @property
    def name(self):
        """What a person launched."""
        path = self.launch_file()
        return path.name if path else "warehouse.launch"

    def known(self):
        """The arguments that the launch file takes; None if that can't be told."""
        path = self.launch_file()
        return known_arguments(path, self._share) if path else None


def known_arguments(path, share):
    """The names of arguments of a launch file, and of those that get all of its arguments; None
    where one of them is not to be found."""
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError):
        return None
    known = {arg.get("name") for arg in root.iter("arg") if "value" not in arg.attrib}
    for include in root.iter("include"):
        if include.get("pass_all_args", "").lower() != "true":
            continue
        file = include.get("file", "").replace(OURS, f"{share}/")
        inner = None if "$" in file else known_arguments(file, share)
        if inner is None:
            return None
        known |= inner - {arg.get("name") for arg in include.iter("arg")}
    return known


def check_arguments(given, caller, place):
    """Raises LaunchError with a sentence for each argument that is wrong: those that the launch
    file hands on, {name: text}, and those that a person typed."""
    known = caller.known()
    texts = launch_arguments.unknown(caller.typed, known) if known is not None else []
    # A launch file of one's own may have arguments of the same names.
    path = caller.launch_file()
    is_ours = path and path.resolve().is_relative_to((place.worlds.parent / "launch").resolve())
    typed = caller.typed if is_ours else {}
    checked = launch_arguments.ARGUMENTS.keys() & (known or ())
    values = {**given, **{name: text for name, text in typed.items() if name in checked}}
    texts += launch_arguments.faults(values, place)
    if texts:
        raise LaunchError("\n  ".join(texts))


def master_of(caller, environment):
    """The master that a roslaunch uses; None of another program.

    rostest, say, always starts one of its own.
    """
    if not caller.is_roslaunch:
        return None
    rest = iter(caller.words)
    for part in rest:
        for option in ("-p", "--port"):
            if part == option:
                return f"http://localhost:{next(rest, '')}"
            if part.startswith(option) and part.removeprefix(option).lstrip("=").isdigit():
                return f"http://localhost:{part.removeprefix(option).lstrip('=')}"
    return environment.get("ROS_MASTER_URI", "http://localhost:11311")


def check_master(uri, connect=ServerProxy):
    """Raises LaunchError where a world runs at that master already.

    A second of the same name would end the first, and with it the master of both.
    """
    try:
        code, _, address = connect(uri).lookupNode("/launch_check", ENGINE)
        if code != 1 or connect(address).getPid("/launch_check")[0] != 1:
            return
        name = connect(uri).getParam("/launch_check", "/warehouse/name")
        page = connect(uri).getParam("/launch_check", "/viewer/address")
    except OSError:  # no answer: no master, or a world that died
        return
    raise LaunchError(_runs_already(uri, *(v if code == 1 else "" for code, _, v in (name, page))))


def _runs_already(uri, name, page):
    lines = [
        f"a warehouse{f' ({name})' if name else ''} runs at {uri} already; nothing was started",
        f"  join it:             rostopic echo /warehouse/events{f'    or {page}' if page else ''}",
        "  build another in it: rosservice call /warehouse/create_warehouse_models"
        " '{warehouse_name: medium}'",
        "  start one beside it: export ROS_MASTER_URI=http://localhost:11312, then the same with"
        " viewer_port:=8081",
    ]
    return "\n".join(lines)
