# SPDX-License-Identifier: Apache-2.0
"""The checks before a launch file starts anything: valid arguments, and a free master."""

import os
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit
from xmlrpc.client import ServerProxy

import rosgraph

from warehouse_layout.file import files
from warehouse_sim import launch_arguments
from warehouse_sim.launch_arguments import Place

TIMEOUT = 3.0  # for the answer of a world [s, wall]
SHARE = files.share(__file__)  # the folder with launch/
ENGINE = "gazebo"  # in the namespace of its launch
LOCAL = re.compile(r"localhost|127\..*")  # names of this machine
OURS = "$(find warehouse_sim)/"  # how a launch file names files of this package


class LaunchError(ValueError):
    """Raised where nothing was started; says why, and what helps."""


class Caller:
    """The process that reads a launch file, from its command line (a list) and its folder."""

    def __init__(self, command_line: Sequence[str], cwd: str | Path, share: Path) -> None:
        self._share = share
        names = [part.rpartition("/")[2] for part in command_line[:2]]
        self.is_roslaunch = "roslaunch" in names
        self.words = command_line[names.index("roslaunch") + 1 :] if self.is_roslaunch else []
        self.cwd = Path(cwd)

    @classmethod
    def of_process(cls, number: int, share: Path) -> "Caller":
        """Returns the process of that number."""
        process = Path(f"/proc/{number}")
        line = (process / "cmdline").read_text(errors="replace").split("\0")
        return cls(line, os.readlink(process / "cwd"), share)

    @property
    def typed(self) -> dict[str, str]:
        """The arguments {name: text} that a person typed."""
        pairs = (re.fullmatch(r"(?!__)([^:=]+):=(.*)", word, re.DOTALL) for word in self.words)
        return {pair[1]: pair[2] for pair in pairs if pair}

    def launch_file(self) -> Path | None:
        """Returns the launch file that was called; None if it is unknown."""
        files = [word for word in self.words if word.endswith((".launch", ".xml"))]
        if len(files) != 1:
            return None
        before = self.words[: self.words.index(files[0])]
        ours = self._share / "launch" / files[0]
        path = ours if before[-1:] == ["warehouse_sim"] else self.cwd / files[0]
        return path if path.is_file() else None

    def namespace(self, environment: Mapping[str, str]) -> str:
        """Returns the namespace of the launch's nodes, as `/` or `/sim1/`. The groups of a user's
        own launch file are not examined."""
        return rosgraph.names.get_ros_namespace({**environment}, [*self.words])

    @property
    def name(self) -> str:
        """The name of the launch file."""
        path = self.launch_file()
        return path.name if path else "warehouse.launch"

    def known(self) -> set[str] | None:
        """Returns the arguments that the launch file takes; None if they are unknown."""
        path = self.launch_file()
        return known_arguments(path, self._share) if path else None


def known_arguments(path: str | Path, share: Path) -> set[str] | None:
    """Returns the names of the arguments of a launch file and of the files that it passes all its
    arguments to; None if one of the files is missing."""
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError):
        return None
    known = {arg.get("name", "") for arg in root.iter("arg") if "value" not in arg.attrib}
    for include in root.iter("include"):
        if include.get("pass_all_args", "").lower() != "true":
            continue
        file = include.get("file", "").replace(OURS, f"{share}/")
        inner = None if "$" in file else known_arguments(file, share)
        if inner is None:
            return None
        known |= inner - {arg.get("name", "") for arg in include.iter("arg")}
    return known


def check_arguments(arguments: Mapping[str, str], caller: Caller, place: Place) -> None:
    """Checks the arguments {name: text} that a launch file passes on, and those that were typed.

    Raises LaunchError with a sentence for each that is wrong."""
    known = caller.known()
    texts = launch_arguments.unknown(caller.typed, known) if known is not None else []
    # A user's own launch file may have arguments of the same names.
    path = caller.launch_file()
    launch = (place.worlds.parent / "launch").resolve()
    is_ours = path is not None and path.resolve().is_relative_to(launch)
    typed = caller.typed if is_ours else {}
    checked = launch_arguments.ARGUMENTS.keys() & (known or ())
    values = {**arguments, **{name: text for name, text in typed.items() if name in checked}}
    texts += launch_arguments.faults(values, place) or launch_arguments.conflicts(values, place)
    if texts:
        raise LaunchError("\n  ".join(texts))


def master_of(caller: Caller, environment: Mapping[str, str]) -> str | None:
    """Returns the URI of the master that a roslaunch uses; None for any other program.

    rostest, for example, always starts a master of its own.
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


def openness(caller: Caller, environment: Mapping[str, str]) -> str:
    """Returns a sentence if other machines reach the master and nodes of a launch; else ""."""
    master = master_of(caller, environment)
    host = urlsplit(master or "").hostname or ""
    if {"ROS_HOSTNAME", "ROS_IP"} & {*environment} or not LOCAL.fullmatch(host):
        return ""
    return (
        "Master and nodes listen to every network of this machine. To keep them to it:"
        " export ROS_HOSTNAME=localhost"
    )


def check_master(
    uri: str, namespace: str = "/", connect: Callable[[str], Any] = ServerProxy
) -> None:
    """Raises LaunchError if a world runs at that master already, in that namespace.

    A second of the same name would end the first, and with it the master of both.
    """
    try:
        code, _, address = connect(uri).lookupNode("/launch_check", namespace + ENGINE)
        if code != 1 or connect(address).getPid("/launch_check")[0] != 1:
            return
        name = connect(uri).getParam("/launch_check", f"{namespace}warehouse/name")
        page = connect(uri).getParam("/launch_check", f"{namespace}viewer/address")
    except OSError:  # no answer: no master, or a world that died
        return
    texts = (v if code == 1 else "" for code, _, v in (name, page))
    raise LaunchError(_runs_already(uri, namespace, *texts))


def _runs_already(uri: str, namespace: str, name: str, page: str) -> str:
    within = f" in {namespace.rstrip('/')}" if namespace != "/" else ""
    events, create = (
        f"{namespace}warehouse/{topic}" for topic in ("events", "create_warehouse_models")
    )
    lines = [
        f"a warehouse{f' ({name})' if name else ''} runs at {uri}{within} already; nothing was"
        " started",
        f"  join it:             rostopic echo {events}{f'    or {page}' if page else ''}",
        f"  build another in it: rosservice call {create} '{{warehouse_name: medium}}'",
        "  start one beside it: the same with __ns:=another viewer_port:=8081, or first"
        " export ROS_MASTER_URI=http://localhost:11312",
    ]
    return "\n".join(lines)
