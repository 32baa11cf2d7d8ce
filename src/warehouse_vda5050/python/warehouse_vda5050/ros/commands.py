# SPDX-License-Identifier: Apache-2.0
"""The topics by which robots are commanded, as plain commands; of some robots alone.

A client that waits for a connection before it commands has to have that to the world, which drives
all other robots: what the world publishes on /warehouse/commands is heard from there. This node is
itself the receiver of its robots' paths, which the world does not publish again, and of stop and
cancel, which have to reach a vehicle even where no world runs any more.
"""

from collections.abc import Callable, Collection, Iterator

import rospy

from warehouse_client.heard_commands import Heard, hear
from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import (
    Cancel,
    FleetFollow,
    FleetOrders,
    FollowPath,
    Lift,
    LimitedPath,
    Stop,
)
from warehouse_vda5050.master import commands
from warehouse_vda5050.master.commands import Command
from warehouse_vda5050.master.fleet import ALL

QUEUE = 1000
OTHERS = {  # that no vehicle takes
    "mov": "way of its own to a point",
    "movx": "distance along x",
    "movy": "distance along y",
    "rot": "turn",
}


class CommandTopics:
    """Calls post(kiva_id, command) for each command to one of `numbers`, in threads of rospy.

    `timeline` returns the world's; what a coordinator decided upon in another one is left out.
    """

    def __init__(
        self,
        numbers: Collection[int],
        post: Callable[[int, Command], None],
        timeline: Callable[[], int],
    ) -> None:
        self._numbers, self._post, self._timeline = numbers, post, timeline
        for topic, kind, take in (
            ("follow", FollowPath, self._on_follow),
            ("follow_limited", LimitedPath, self._on_limited),
            ("warehouse/follow", FleetFollow, self._on_fleet_follow),
            ("warehouse/fleet_orders", FleetOrders, self._on_orders),
            ("cancel", Cancel, self._on_cancel),
            ("stop", Stop, self._on_stop),
        ):
            subscribe(rospy, topic, kind, take, queue_size=QUEUE)
        self._heard = {rospy.resolve_name(topic): topic for topic in ("lift", *OTHERS)}
        hear(rospy, self._on_heard)

    def _send(self, kiva_id: int, command: Command) -> None:
        if kiva_id in self._numbers:
            self._post(kiva_id, command)

    def _on_follow(self, m: FollowPath) -> None:
        follow = commands.Follow(m.path_id, m.first, tuple(zip(m.x, m.y)), m.released)
        self._send(m.kiva_id, follow)

    def _on_limited(self, message: LimitedPath) -> None:
        m, speeds = message.path, tuple(message.max_speed)
        if speeds and len(speeds) != len(m.x) or not all(speed > 0 for speed in speeds):
            return  # the world refuses it with the reason
        points = tuple(zip(m.x, m.y))
        self._send(m.kiva_id, commands.Follow(m.path_id, m.first, points, m.released, speeds))

    def _on_fleet_follow(self, message: FleetFollow) -> None:
        for kiva_id, follow in paths_of(message):
            self._send(kiva_id, follow)

    def _on_orders(self, message: FleetOrders) -> None:
        if message.timeline != self._timeline():
            return
        for cancel in message.cancels:
            self._on_cancel(cancel)
        self._on_fleet_follow(message.follow)
        for lift in message.lifts:
            self._on_lift(lift)

    def _on_lift(self, message: Lift) -> None:
        up = message.status == Lift.CARRY
        self._send(message.kiva_id, commands.Lift(up, message.shelf_id))

    def _on_cancel(self, message: Cancel) -> None:
        self._send(message.kiva_id, commands.Cancel())

    def _on_stop(self, message: Stop) -> None:
        if message.kiva_id == ALL:
            self._post(ALL, commands.Stop(message.stop))
        else:
            self._send(message.kiva_id, commands.Stop(message.stop))

    def _on_heard(self, heard: Heard) -> None:
        topic, fields = self._heard.get(heard.topic, ""), heard.fields
        if not topic:
            return
        try:
            names = ("kiva_id", "status", "shelf_id") if topic == "lift" else ("kiva_id",)
            values = {name: int(fields[name]) for name in names}
        except (KeyError, TypeError, ValueError):
            return  # the world refuses it
        if topic == "lift":
            self._on_lift(Lift(**values))
        else:
            self._send(values["kiva_id"], commands.Other(OTHERS[topic]))


def paths_of(message: FleetFollow) -> Iterator[tuple[int, commands.Follow]]:
    """Yields (kiva_id, path) of a FleetFollow; nothing of one whose arrays don't fit each other,
    which the world refuses with the reason."""
    columns = (message.kiva_id, message.path_id, message.first, message.points, message.released)
    fits = len({len(column) for column in columns}) == 1
    if not fits or not sum(message.points) == len(message.x) == len(message.y):
        return
    at = 0
    for kiva_id, path_id, first, count, released in zip(*columns):
        points = tuple(zip(message.x[at : at + count], message.y[at : at + count]))
        at += count
        yield kiva_id, commands.Follow(path_id, first, points, released)
