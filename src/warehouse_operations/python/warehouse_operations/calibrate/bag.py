# SPDX-License-Identifier: Apache-2.0
"""The recording that a rosbag of a fleet is: `/warehouse/fleet`, or `/kiva<id>/odom` and
`/kiva<id>/status`, in any namespace."""

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.message_enums import State
from warehouse_operations.calibrate import breakdowns
from warehouse_operations.calibrate.recording import (
    NOWHERE,
    CalibrationError,
    Recording,
    Track,
    named,
    require,
)

MAGIC = b"#ROSBAG V"
FLEET, STATUS, ODOM = "warehouse/fleet", "status", "odom"
OF_ROBOT = re.compile(r"/(kiva\d+)/(status|odom)$")
EXPECTED = "/warehouse/fleet, or /kiva<id>/odom and /kiva<id>/status, was expected"
LEAST = 10  # messages of a track
Look = Callable[[float, str], object]  # a share of the work, and what is done


def is_bag(path: Path) -> bool:
    """Returns whether a file begins as a bag does."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def read(path: Path, look: Look = lambda *_: None) -> Recording:
    """Returns the Recording of a bag. Raises CalibrationError."""
    import rosbag

    try:
        with rosbag.Bag(str(path)) as bag:
            return _recording(bag, path, look)
    except rosbag.ROSBagUnindexedException as error:
        raise CalibrationError(f"{path}: has no index; rosbag reindex makes one") from error
    except (rosbag.ROSBagException, OSError, EOFError) as error:
        raise CalibrationError(f"{path}: {error}; a whole bag was expected") from error


def _recording(bag: Any, path: Path, look: Look) -> Recording:
    topics = bag.get_type_and_topic_info()[1]
    require(bool(topics), f"{path}: is empty; {EXPECTED}")
    fleets = [name for name in topics if name.endswith(f"/{FLEET}")]
    of_robots = [name for name in topics if OF_ROBOT.search(name)]
    require(bool(fleets or of_robots), f"{path}: has {named(topics)}; {EXPECTED}")
    for topic in fleets:
        _check(path, topic, topics[topic].msg_type, "warehouse_msgs/FleetState")
    for topic in of_robots:
        kind = "nav_msgs/Odometry" if topic.endswith(ODOM) else "warehouse_msgs/KivaStatus"
        _check(path, topic, topics[topic].msg_type, kind)
    reader = _Reader()
    chosen = [*fleets, *of_robots]
    whole = sum(topics[topic].message_count for topic in chosen)
    for count, (topic, message, stamp) in enumerate(bag.read_messages(topics=chosen)):
        reader.take(topic, message, stamp.to_sec())
        look(count / whole, f"{path.name}: {count} of {whole} messages")
    out = reader.recording()
    require(
        bool(out.tracks or out.lifts),
        f"{path}: {named(chosen)} hold {whole} messages, too few for a track; a recording of a "
        "minute or more was expected",
    )
    out.sources = [f"{path}: {len(out.tracks)} robots, {whole} messages"]
    return out


def _check(path: Path, topic: str, kind: str, expected: str) -> None:
    require(kind == expected, f"{path}: {topic} is of type {kind}; {expected} was expected")


class _Reader:
    """Gathers rows of tracks. What a robot does and carries comes from its status."""

    def __init__(self) -> None:
        self._fleet: dict[str, list[list[float]]] = defaultdict(list)
        self._odometry: dict[str, list[list[float]]] = defaultdict(list)
        self._lifts = Lifts()
        self._fleet_lifts = Lifts()
        self._of_status: dict[str, tuple[bool, bool]] = {}  # loaded, lifting

    def take(self, topic: str, message: Any, _: float) -> None:
        """Takes in a message."""
        if topic.endswith(FLEET):
            self._take_fleet(topic.removesuffix(FLEET), message)
            return
        robot = topic.rpartition("/")[0]
        time = message.header.stamp.to_sec()
        if topic.endswith(STATUS):
            lifting = message.state == State.LIFTING
            self._of_status[robot] = message.shelf_id != 0, lifting
            self._lifts.note(robot, time, lifting)
        else:
            self._odometry[robot].append(_of_odometry(message, time, self._of_status.get(robot)))

    def _take_fleet(self, prefix: str, fleet: Any) -> None:
        time = fleet.stamp.to_sec()
        charges = any(charge != 1.0 for charge in fleet.charge)
        for i, number in enumerate(fleet.kiva_id):
            robot = f"{prefix}kiva{number}"
            lifting = fleet.state[i] == State.LIFTING
            self._fleet_lifts.note(robot, time, lifting)
            self._fleet[robot].append(
                [
                    time,
                    fleet.x[i],
                    fleet.y[i],
                    fleet.yaw[i],
                    (fleet.vx[i] ** 2 + fleet.vy[i] ** 2) ** 0.5,
                    fleet.yaw_rate[i],
                    fleet.shelf_id[i] != 0,
                    fleet.charge[i] if charges else NOWHERE,
                    fleet.failures[i],
                    lifting,
                ]
            )

    def recording(self) -> Recording:
        """Returns what was recorded. The fleet's messages go before a robot's odometry."""
        out = Recording()
        rows = self._fleet or self._odometry
        for robot, its in rows.items():
            if len(its) >= LEAST:
                out.tracks[robot] = Track.of_rows(its)
                if self._fleet:
                    breakdowns.note(out, out.tracks[robot])
        out.lifts = self._lifts.durations
        if not out.lifts and self._fleet_lifts.durations:
            out.lifts = self._fleet_lifts.durations
            track = next(iter(out.tracks.values()))
            out.lift_step = float(np.median(np.diff(track.time)))
        return out


class Lifts:
    """The durations of lifts, from changes of what robots do."""

    def __init__(self) -> None:
        self.durations: list[float] = []
        self._since: dict[str, float | None] = {}  # None: since an unknown time
        self._last: Counter[str] = Counter()

    def note(self, robot: str, time: float, lifting: bool) -> None:
        """Notes whether a robot raises or lowers at a time [s]."""
        if lifting and robot not in self._since:
            self._since[robot] = time if self._last[robot] else None
        elif not lifting and robot in self._since:
            since = self._since.pop(robot)
            if since is not None and time > since:
                self.durations.append(time - since)
        self._last[robot] = 1


def _of_odometry(message: Any, time: float, status: tuple[bool, bool] | None) -> list[float]:
    pose, twist = message.pose.pose, message.twist.twist
    loaded, lifting = status or (False, False)
    speed = (twist.linear.x**2 + twist.linear.y**2) ** 0.5
    yaw = 2 * math.atan2(pose.orientation.z, pose.orientation.w)  # it turns about z alone
    return [
        time,
        pose.position.x,
        pose.position.y,
        yaw,
        speed,
        twist.angular.z,
        loaded,
        NOWHERE,
        0,
        lifting,
    ]
