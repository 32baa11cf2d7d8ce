# SPDX-License-Identifier: Apache-2.0
"""What is checked before a launch file starts anything: arguments, and that the master is free."""

import math
from xmlrpc.client import ServerProxy

from warehouse_sim import world_file
from warehouse_sim.request import PRESETS

TIMEOUT = 3.0  # for a world to say that it is there [s, wall]
ENGINE = "/gazebo"


class LaunchError(ValueError):
    """Why nothing was started, and what helps."""


def check_arguments(size, world, rtf, worlds):
    """Raises LaunchError; `worlds` is the folder of the world files that go by their name."""
    if size not in ("", "none", *PRESETS):
        raise LaunchError(f"size:={size}: one of none, {', '.join(PRESETS)} was expected")
    if not (math.isfinite(rtf) and rtf >= 0):
        raise LaunchError(f"rtf:={rtf:g}: a factor above 0, or 0 (as fast as it goes) was expected")
    if world:
        try:
            world_file.find(world, worlds)
        except world_file.WorldFileError as error:
            raise LaunchError(str(error)) from error


def master_of(command_line, environment):
    """The master that a roslaunch of this command line (a list) uses; None of another program.

    rostest, say, always starts one of its own.
    """
    names = [part.rpartition("/")[2] for part in command_line[:2]]
    if "roslaunch" not in names:
        return None
    rest = iter(command_line[names.index("roslaunch") + 1 :])
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
    except OSError:  # nobody answers: no master, or a world that died
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
