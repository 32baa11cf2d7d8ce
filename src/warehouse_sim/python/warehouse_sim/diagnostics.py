# SPDX-License-Identifier: Apache-2.0
"""The health of a running warehouse, /diagnostics: its world, robots, viewer and vehicles.

Functions `of_…` judge one part by its last messages.
"""

import time
import urllib.error
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Header

from gazebo_msgs.msg import PerformanceMetrics
from gazebo_msgs.srv import GetPhysicsProperties
from warehouse_client.message_check import subscribe
from warehouse_client.message_names import STATUS, failures_of
from warehouse_msgs.msg import FleetState, KivaStatus, Vda5050
from warehouse_viewer.server.hub_link import open_here

PERIOD = 1.0  # between two messages [s, wall]
SILENCE = 5.0  # age at which a message is stale [s, wall]
SLOW = 0.9  # share of the requested real-time factor below which the world is slow
MOST_NAMED = 5  # robots in a sentence


def status(
    name: str, level: int, message: str, values: Mapping[str, object] | None = None
) -> DiagnosticStatus:
    """Returns the status of a part of the warehouse; its values as text."""
    pairs = [KeyValue(key, str(value)) for key, value in (values or {}).items()]
    return DiagnosticStatus(level, f"warehouse: {name}", message, "", pairs)


def of_world(factor: float | None, requested: float, is_paused: bool) -> DiagnosticStatus:
    """Judges the speed of the world.

    `factor`: its last real-time factor, None without messages; `requested`: the configured one, 0:
    as fast as possible.
    """
    if factor is None:
        return status("world", DiagnosticStatus.STALE, "nothing is heard of the world")
    values = {"real-time factor": f"{factor:.3f}", "requested": f"{requested:g}"}
    if is_paused:
        return status("world", DiagnosticStatus.OK, "paused", values)
    if factor < SLOW * requested:
        share = f"runs at {factor:.2f} times real time; {requested:g} is requested"
        return status("world", DiagnosticStatus.WARN, share, values)
    return status("world", DiagnosticStatus.OK, f"runs at {factor:.2f} times real time", values)


def of_robots(fleet: FleetState | None) -> DiagnosticStatus:
    """Names the robots that failed or are blocked."""
    if fleet is None:
        return status("robots", DiagnosticStatus.STALE, "nothing is heard of the robots")
    failed = {
        f"kiva{number}": ", ".join(failures_of(bits))
        for number, bits in zip(fleet.kiva_id, fleet.failures)
        if bits
    }
    blocked = [
        f"kiva{number}"
        for number, state in zip(fleet.kiva_id, fleet.status)
        if state == KivaStatus.STATUS_BLOCKED
    ]
    counts = {word.lower(): list(fleet.status).count(value) for value, word in STATUS.items()}
    values = {"robots": len(fleet.kiva_id), **counts, "failed": len(failed), **failed}
    level, sentences = DiagnosticStatus.OK, []
    if blocked:
        level, sentences = DiagnosticStatus.WARN, [f"blocked: {_some(blocked)}"]
    if failed:
        level = DiagnosticStatus.ERROR
        sentences.insert(0, f"failed: {_some([f'{k} ({v})' for k, v in failed.items()])}")
    count = len(fleet.kiva_id)
    calm = f"{count} robot{'s' if count != 1 else ''}, none failed or blocked"
    return status("robots", level, "; ".join(sentences) or calm, values)


def of_viewer(address: str, fault: str) -> DiagnosticStatus:
    """Judges the pages and the HTTP API. `fault`: why they do not answer; "" if they do."""
    values = {"address": address}
    if fault:
        return status("viewer", DiagnosticStatus.ERROR, f"does not answer: {fault}", values)
    return status("viewer", DiagnosticStatus.OK, "answers", values)


def of_broker(message: Vda5050) -> DiagnosticStatus:
    """Names the robots without a connection to the broker of VDA 5050."""
    names = [f"kiva{number}" for number in message.kiva_id]
    away = [name for name, state in zip(names, message.connection) if state != Vda5050.ONLINE]
    values = {"broker": message.broker, "robots": len(names), "connected": len(names) - len(away)}
    part = "vehicles at the broker" if message.direction == Vda5050.VEHICLE else "vehicles driven"
    if away:
        return status(part, DiagnosticStatus.WARN, f"not connected: {_some(away)}", values)
    return status(part, DiagnosticStatus.OK, f"{len(names)} connected", values)


def _some(names: Iterable[str]) -> str:
    """Returns the names in one line, those beyond MOST_NAMED as a count."""
    names = list(names)
    rest = len(names) - MOST_NAMED
    return ", ".join(names[:MOST_NAMED]) + (f" and {rest} more" if rest > 0 else "")


class Heard:
    """The last message of a topic, for SILENCE seconds. `ros` is rospy."""

    def __init__(self, ros: Any, topic: str, kind: Any) -> None:
        self._message, self._at = None, time.monotonic()
        self._subscriber = subscribe(ros, topic, kind, self._take)
        self.close = self._subscriber.unregister

    def _take(self, message: Any) -> None:
        self._message, self._at = message, time.monotonic()

    @property
    def message(self) -> Any:
        """The message; None if none came within SILENCE."""
        return self._message if time.monotonic() - self._at < SILENCE else None

    @property
    def is_known(self) -> bool:
        """Whether a message came, or none within SILENCE."""
        return self._message is not None or time.monotonic() - self._at >= SILENCE


class Watch:
    """Subscribes to the messages behind the statuses. `ros` is rospy."""

    def __init__(self, ros: Any) -> None:
        self._ros = ros
        self._speed = Heard(ros, "gazebo/performance_metrics", PerformanceMetrics)
        self._fleet = Heard(ros, "warehouse/fleet", FleetState)
        self._brokers: dict[int, Vda5050] = {}  # by direction
        self._physics = ros.ServiceProxy("gazebo/get_physics_properties", GetPhysicsProperties)
        self._vehicles = subscribe(ros, "warehouse/vda5050", Vda5050, self._take_broker)

    def close(self) -> None:
        """Ends the subscriptions."""
        self._speed.close()
        self._fleet.close()
        self._vehicles.unregister()

    @property
    def is_ready(self) -> bool:
        """Whether world and robots have been heard, or for long enough not."""
        return self._speed.is_known and self._fleet.is_known

    def _take_broker(self, message: Vda5050) -> None:
        self._brokers[message.direction] = message

    def statuses(self) -> Iterator[DiagnosticStatus]:
        """Yields the status of each part that runs."""
        yield self._world()
        yield of_robots(self._fleet.message)
        address = self._ros.get_param("viewer/address", "")
        if address:
            yield of_viewer(address, fault_of(address))
        yield from map(of_broker, list(self._brokers.values()))

    def _world(self) -> DiagnosticStatus:
        metrics = self._speed.message
        if metrics is None:
            return of_world(None, 0.0, False)
        try:
            physics = self._physics()
        except self._ros.ServiceException:  # it ended meanwhile
            return of_world(None, 0.0, False)
        requested = physics.max_update_rate * physics.time_step
        return of_world(metrics.real_time_factor, requested, physics.pause)


def fault_of(address: str) -> str:
    """Returns why no server answers at a URL of this machine, empty where one does."""
    try:
        open_here(address, PERIOD).close()
    except urllib.error.HTTPError:
        return ""  # it answers, and asks for a token
    except OSError as error:
        return str(getattr(error, "reason", error))
    return ""


def follow(ros: Any) -> None:
    """Publishes once a second until shutdown, while there is a subscriber. `ros` is rospy."""
    publisher = ros.Publisher("diagnostics", DiagnosticArray, queue_size=1)
    watch = None  # without a subscriber: robots report ten times a second
    while not ros.is_shutdown():
        time.sleep(PERIOD)
        if not publisher.get_num_connections():
            if watch:
                watch.close()
            watch = None
        elif watch is None:
            watch = Watch(ros)
        elif watch.is_ready:
            # By wall time: the simulated time of a paused or ended world stands still.
            stamp = ros.Time.from_sec(time.time())
            publisher.publish(DiagnosticArray(Header(stamp=stamp), list(watch.statuses())))
