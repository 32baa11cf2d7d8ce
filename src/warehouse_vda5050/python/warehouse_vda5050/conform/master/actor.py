# SPDX-License-Identifier: Apache-2.0
"""A vehicle on the stage: our vehicle core, a robot that drives by a formula, and accidents."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.conform.master.channel import Channel, Travel
from warehouse_vda5050.conform.master.facts import Fact, Facts, Scene, value_of
from warehouse_vda5050.conform.master.open_floor import OpenFloor
from warehouse_vda5050.conform.master.played import PlayedLink, PlayedVehicle
from warehouse_vda5050.conform.master.wire import StageWire
from warehouse_vda5050.conform.names import of_wire
from warehouse_vda5050.errors import ErrorLevel
from warehouse_vda5050.formula_driver import LIFT_TIME, FormulaRobot
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import Battery, ConnectionState, VehicleState
from warehouse_vda5050.mqtt.loop import Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Identity, Kind, Topics
from warehouse_vda5050.vehicle import VehicleSettings

LONGEST_STEP = 0.5  # of the robot; after a pause of this program it drives no farther at once [s]
Json = dict[str, Any]


@dataclass(frozen=True)
class Role:
    """Who a vehicle is, and where it stands at first [m, rad]."""

    identity: Identity
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    node: str = "conform_start"


class Actor:
    """One vehicle. heard(actor, kind, payload, scene): a message of the master and what held when
    it came; sent(actor, message): one of its own."""

    def __init__(
        self,
        role: Role,
        map_id: str,
        codec: Codec,
        topics: Topics,
        wire: StageWire,
        broker: BrokerSettings,
        heard: Callable[[Actor, Kind, bytes, Scene], None],
        sent: Callable[[Actor, Outgoing], None],
    ) -> None:
        self.role, self.map_id = role, map_id
        self._codec, self._topics, self._wire, self._broker = codec, topics, wire, broker
        self._heard, self._sent = heard, sent
        self.floor = OpenFloor(0.0, 0.0, 1.0, 1, 1)
        self.floor.add(role.node, role.x, role.y)
        self.robot = FormulaRobot(role.x, role.y, role.yaw)
        self.facts = Facts()
        self.facts.note(-math.inf, pushed=0)
        self._before: Scene = {}
        self._stepped_at = wire.now()
        self._paths = 1
        self.vehicle = self._new_vehicle()
        self.link = self._new_link()

    @property
    def name(self) -> str:
        """MANUFACTURER/SERIAL."""
        return f"{self.role.identity.manufacturer}/{self.role.identity.serial}"

    @property
    def channel(self) -> Channel:
        """How its states travel."""
        return self.link.channel

    # --- beginnings and ends

    def _new_vehicle(self) -> PlayedVehicle:
        is_new = self._codec.version.startswith("3")
        settings = VehicleSettings(
            begins_at_zero=is_new,
            first_path=self._paths,
            zones=is_new,
            # Requests of each start have ids of their own.
            name=f"{self.role.identity.serial}.{self._paths}",
        )
        self._paths += 100_000
        return PlayedVehicle(self.robot, self.floor, self.map_id, settings)

    def _new_link(self, headers: Headers | None = None) -> PlayedLink:
        identity = self.role.identity
        link = PlayedLink(self.vehicle, identity, self._codec, self._topics, self._broker)
        if headers:
            link.continue_headers(headers)
        link.before = self._look
        link.heard = self._take
        link.sent = self._note_sent
        self._wire.join(link)
        return link

    def leave(self) -> None:
        """Says OFFLINE and disconnects in good order."""
        self.link.close()
        self.facts.note(self._wire.now(), online=False)

    def enter(self) -> None:
        """Connects again after leave(), with the order that it had."""
        self.link = self._new_link(self.link.headers)

    def restart(self) -> None:
        """Ends its program and begins it again: it knows no order, and counts from 0."""
        self.leave()
        self.robot.carry_to(self.robot.x, self.robot.y)
        self.vehicle = self._new_vehicle()
        self.link = self._new_link()

    def cut(self) -> None:
        """Loses the connection as a radio does."""
        self.robot.reports["heard"] = False

    def restore(self) -> None:
        """Has the connection again."""
        self.robot.reports.pop("heard", None)

    def calm(self) -> None:
        """Ends all accidents."""
        self.robot.reports.clear()
        self.robot.lift_fault, self.robot.lift_time = "", LIFT_TIME
        self.vehicle.refusal, self.vehicle.deaf, self.vehicle.no_zones = None, False, False
        if self.link.edits.pop(Kind.FACTSHEET, None):
            self.vehicle.request_factsheet()
        self.link.edits.clear()
        self.channel.travel = Travel.PLAIN
        if self.vehicle.paused:
            self.vehicle.set_paused(False)
        if self.link.link.closed:
            self.enter()

    # --- what happens to it

    def report(self, **fields: Any) -> None:
        """Has the robot report other values from now on: mode, localized, errors, battery …"""
        self.robot.reports.update(fields)
        self.vehicle.request_state()

    def push(self, x: float, y: float) -> None:
        """Puts the vehicle elsewhere, as a person does who pushes it [m]."""
        self.robot.carry_to(x, y)
        self.facts.note(self._wire.now(), pushed=value_of(self.facts.scene(), "pushed") + 1)
        self.vehicle.request_state()

    def drain(self, charge: float) -> None:
        """Sets the charge of its battery [%]."""
        self.report(battery=Battery(charge))

    def change_sheet(self, edit: Callable[[Json], None]) -> None:
        """Publishes another factsheet; edit(sheet) changes it, by the names of 2.1.0."""
        self.link.edits[Kind.FACTSHEET] = edit
        self.vehicle.request_factsheet()

    # --- progress

    def tick(self, now: float) -> None:
        """Goes on; now: the clock of the wire [s]."""
        self.robot.step(min(LONGEST_STEP, now - self._stepped_at))
        self._stepped_at = now
        self.link.tick(now)
        self.link.send_late(now)
        self._observe(now)

    def _look(self) -> None:
        self._observe(self._wire.now())
        self._before = self.facts.scene()

    def _take(self, kind: Kind, payload: bytes) -> None:
        now = self._wire.now()
        accepted = Fact(kind is not Kind.ORDER or self.vehicle.accepted, now)
        self._heard(self, kind, payload, {**self._before, "accepted": accepted})
        self._observe(now)

    def _note_sent(self, message: Outgoing) -> None:
        now = self._wire.now()
        if message.topic.endswith(f"/{Kind.CONNECTION.value}"):
            self.facts.note(now, online=ConnectionState.ONLINE.value.encode() in message.payload)
        if message.topic.endswith(f"/{Kind.FACTSHEET.value}"):
            sheet = of_wire(self._codec, Kind.FACTSHEET, message.payload) or {}
            self.facts.note(now, sheet=_without_header(sheet))
        self._sent(self, message)

    @property
    def is_busy(self) -> bool:
        """Whether its order is under way: nodes or actions are left."""
        return _is_busy(self.vehicle.state())

    def _observe(self, now: float) -> None:
        state, robot = self.vehicle.state(), self.robot
        cancels = [action.status for action in state.actions if action.type == "cancelOrder"]
        fatal = tuple(e.type for e in state.errors if e.level is ErrorLevel.FATAL)
        self.facts.note(
            now,
            order=state.order_id,
            update=state.order_update,
            busy=_is_busy(state),
            node=state.last_node,
            sequence=state.last_node_sequence,
            at=(robot.x, robot.y),
            fatal=fatal,
            localized=state.position is None or state.position.initialized,
            mode=state.mode.value,
            charge=state.battery.charge,
            loaded=bool(state.loads),
            cancel=cancels[-1].value if cancels else "",
            paused=state.paused,
            zone_sets={s.id: s.enabled for s in state.zone_sets},
            zones=next((s.id for s in state.zone_sets if s.enabled), ""),
        )
        if not self.link.link.connected:
            self.facts.note(now, online=False)


def _is_busy(state: VehicleState) -> bool:
    rest = (a for a in state.actions if not a.instant and not a.status.is_over)
    return bool(state.nodes) or state.driving or any(rest)


def _without_header(sheet: Json) -> Json:
    header = ("headerId", "timestamp", "version", "manufacturer", "serialNumber")
    return {key: value for key, value in sheet.items() if key not in header}
