# SPDX-License-Identifier: Apache-2.0
"""One vehicle: takes orders and instant actions, drives by a Driver, reports its state.

vehicle = Vehicle(driver, grid)
vehicle.on_order(order, now)       # as they come; now is any monotonic clock [s]
vehicle.update(now)                # ten times a second
state = vehicle.take_state(now)    # to be sent, None if there is nothing new
"""

import itertools
import math
from typing import Any

from warehouse_vda5050.driver import Driver, Report
from warehouse_vda5050.errors import Error, ErrorType
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import (
    Factsheet,
    InstantActions,
    Node,
    Responses,
    VehicleOrder,
    VehicleState,
    Visualization,
    ZoneSet,
)
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.actions import unknown_parameters
from warehouse_vda5050.validation.demands import Robot
from warehouse_vda5050.vehicle import reception
from warehouse_vda5050.vehicle.abilities import completed
from warehouse_vda5050.vehicle.actions import ActionQueue
from warehouse_vda5050.vehicle.complaints import Complaints, of_order
from warehouse_vda5050.vehicle.hands import Hands
from warehouse_vda5050.vehicle.instant import InstantDesk
from warehouse_vda5050.vehicle.journal import Journal
from warehouse_vda5050.vehicle.outlook import intermediate_path, planned_path
from warehouse_vda5050.vehicle.phase import FOLLOWS, Phase
from warehouse_vda5050.vehicle.progress import OrderProgress
from warehouse_vda5050.vehicle.reception import TAKING_ORDERS, Reception
from warehouse_vda5050.vehicle.settings import VehicleSettings
from warehouse_vda5050.vehicle.state_report import Situation, StateReporter
from warehouse_vda5050.vehicle.wheels import Wheels
from warehouse_vda5050.vehicle.zone_guard import ZoneGuard


class Vehicle:
    """The state machine of one vehicle: `phase` says where it is with its order, and whatever its
    phase it may be `paused`. Not for more than one thread at a time.

    `report` is the last report of the robot; `order` is the order under way or the last one.
    """

    def __init__(self, driver: Driver, grid: Grid, settings: VehicleSettings | None = None) -> None:
        self.driver, self.grid = driver, grid
        self.settings = settings or VehicleSettings()
        self.sheet = completed(
            driver.factsheet(), self.settings.zones, keeps_speeds=driver.keeps_speeds
        )
        self.zones = ZoneGuard(self.sheet, self.settings.name) if self.settings.zones else None
        self.report: Report | None = None
        self.order: OrderProgress | None = None
        self.actions = ActionQueue()
        self.hands = Hands(driver, self.actions)
        self.wheels = Wheels(driver, grid, self.settings.first_path)
        self.instant = InstantDesk(self)
        self.phase = Phase.HELD if driver.is_taken() else Phase.AVAILABLE
        self.paused = False
        self.journal = Journal(self.settings.name, self.settings.logs)
        self.complaints = Complaints(self.journal)
        self._reception = Reception(
            self.sheet,
            begins_at_zero=self.settings.begins_at_zero,
            take=self.take,
            start=self.start,
            extend=self.extend,
            check_zones=self._check_zones,
        )
        self._reporter = StateReporter(self.sheet, self.settings)
        self._free_since: float | None = None

    # What comes in; a state answers each message.

    def on_order(self, order: VehicleOrder, now: float, unknown: tuple[str, ...] = ()) -> bool:
        """Takes an order or an update; `unknown` are fields of it that no version has. Returns
        whether it was accepted; if not, and it is no copy of what was, the state says why."""
        self.request_state()
        accepted = False
        try:
            now_is = reception.Situation(self.report, self.grid, self.order, self.phase)
            accepted = self._reception.accept(order, now_is)
        except MessageError as invalid:
            self.complaints.note(invalid.error)
        if accepted:
            self.complaints.clear()
            self.journal.write(f"order {order.id} update {order.update} is accepted")
        self.complaints.note_unknown(Kind.ORDER, unknown)
        self._settle()
        return accepted

    def on_instant_actions(
        self, message: InstantActions, now: float, unknown: tuple[str, ...] = ()
    ) -> None:
        """Begins instant actions; `unknown` are fields of the message that no version has."""
        self.request_state()
        count, most = len(message.actions), self.sheet.max_actions
        if count > most:
            text = f"{count} actions; at most {most} were expected"
            refer = (("topic", Kind.INSTANT_ACTIONS.value),)
            self.note(Error(ErrorType.VALIDATION.value, description=text, references=refer))
            return
        for action in message.actions:
            self.journal.write(f"{action.type} {action.id}")
            self.instant.begin(action, now)
            self._settle()
        unknown = (*unknown, *unknown_parameters(message.actions, self.sheet))
        self.complaints.note_unknown(Kind.INSTANT_ACTIONS, unknown)

    def on_zone_set(self, zones: ZoneSet, unknown: tuple[str, ...] = ()) -> None:
        """Adds a zone set, DISABLED; if it is refused the state says why."""
        self.request_state()
        if self.zones is None:
            return
        try:
            self.zones.store.add(zones)
        except MessageError as invalid:
            self.complaints.note(invalid.error)
        else:
            self.journal.write(f"zone set {zones.id} has {len(zones.zones)} zones")
        self.complaints.note_unknown(Kind.ZONE_SET, unknown)

    def on_responses(self, responses: Responses, unknown: tuple[str, ...] = ()) -> None:
        """Takes a master's answers to requests for zones. One that comes late is no error: the
        request may have ended meanwhile."""
        self.request_state()
        for id in self.zones.take(responses) if self.zones else ():
            self.journal.write(f"no request {id[:60]} is active, and it was answered")
        self.complaints.note_unknown(Kind.RESPONSES, unknown)

    def note(self, error: Error) -> None:
        """Reports an error of a message, until the next order or update is accepted."""
        self.request_state()
        self.complaints.note(error)

    # --- progress

    def update(self, now: float) -> None:
        """Reads the driver's report and continues the order."""
        self.report = self.driver.report()
        if self.report is None or not self.report.answers:
            return
        self._count(self.report, now)
        if self.zones:
            self.zones.update(self._driven_order, self.grid, self.report)
        self.hands.watch(self.report, now)
        if not self.paused:
            self._begin_actions(self.report, now)
            self._drive(self.report, now)
        elif not self.report.moving:
            self.instant.end("startPause")
        self._end_order(self.report, now)

    def _count(self, report: Report, now: float) -> None:
        passed = self.wheels.count(report, now)
        if self.order and passed:
            nodes = self.order.pass_nodes(passed)
            self.actions.make_due(nodes)
            self.journal.write(f"passed {', '.join(node.id for node in nodes)}")

    def _begin_actions(self, report: Report, now: float) -> None:
        standing = self.wheels.rest and not report.busy and not report.moving
        while action := self.actions.next(standing):
            self.hands.begin(action, report, now)

    def _drive(self, report: Report, now: float) -> None:
        order = self.order
        stays = self.actions.holds_driving or self.actions.failed
        if order and not order.is_driven and not stays and self.phase is Phase.WORKING:
            limit = self.zones.limit if self.zones else None
            self.wheels.drive(order, report, now, limit, self._speeds(order))

    def _speeds(self, order: OrderProgress) -> list[float]:
        """Returns the highest speed on each edge of the base, by order and zones [m/s];
        inf where that is no limit to the robot."""
        speeds = order.speeds()
        zones = self.zones.speeds if self.zones else ()
        lowest = map(min, itertools.zip_longest(speeds, zones, fillvalue=math.inf))
        return [speed if speed < self.sheet.max_speed else math.inf for speed in lowest]

    @property
    def _driven_order(self) -> OrderProgress | None:
        """The order that there is something left to drive of."""
        order = self.order
        return order if order and self.phase is Phase.WORKING and not order.is_driven else None

    def _check_zones(self, order: VehicleOrder, cells: list[Cell], robot: Robot) -> None:
        if self.zones:
            self.zones.check(order, cells, robot)

    def _end_order(self, report: Report, now: float) -> None:
        self._settle()
        if report.mode not in TAKING_ORDERS:
            self.begin_cancel(now)
        if self.phase in (Phase.CANCELLING, Phase.HALTED):
            self.wheels.cancel(now)
        if self.phase is Phase.CANCELLING and self.actions.is_over and self._has_halted(report):
            self._end_cancel()
        self._give_back(report, now)

    def _go_to(self, phase: Phase) -> None:
        """Enters a phase. Raises ValueError where it does not follow."""
        if phase not in FOLLOWS[self.phase]:
            raise ValueError(f"{phase.name} can't follow {self.phase.name}")
        self.phase = phase

    def _settle(self) -> None:
        """Ends the order whose nodes and actions are over."""
        order = self.order
        if self.phase not in (Phase.WORKING, Phase.HALTED) or order is None:
            return
        if order.is_driven and self.actions.is_over and self.wheels.rest:
            self._go_to(Phase.HELD)

    def _has_halted(self, report: Report) -> bool:
        """Returns whether the robot has ended its path, or stands on it and is paused."""
        if self.paused and not report.moving:
            return True
        return self.wheels.rest and not report.busy

    def _end_cancel(self) -> None:
        assert self.order
        self.order.cancel()
        self.wheels.forget_refused()
        self._go_to(Phase.HELD if self.wheels.rest else Phase.HALTED)
        self.instant.end("cancelOrder")
        self.journal.write(f"order {self.order.id} is cancelled")

    def _give_back(self, report: Report, now: float) -> None:
        """Gives the robot back some time after its order is over, unless it carries a unit."""
        if not self.is_free or report.load or report.busy:
            self._free_since = None
        elif self._free_since is None:
            self._free_since = now
        elif self.is_taken and now - self._free_since >= self.settings.linger:
            self._go_to(Phase.AVAILABLE)
            self.driver.give_back()

    # What the reception asks for.

    def take(self) -> str:
        """Takes the robot for an order, from whom commands it else. Returns why not, or ''."""
        if self.is_taken:
            return ""
        reason = self.driver.take()
        if not reason:
            self._go_to(Phase.HELD)
        return reason

    def start(self, progress: OrderProgress, order: VehicleOrder) -> None:
        """Begins an order that was accepted."""
        self._go_to(Phase.WORKING)
        self.order = progress
        self.actions = self.hands.actions = ActionQueue()
        self.wheels.begin()
        self.actions.add(order.nodes)
        self.actions.make_due(order.nodes[:1])

    def extend(self, nodes: tuple[Node, ...]) -> None:
        """Extends the order by the nodes of an update."""
        assert self.order
        if self.is_free:
            self._go_to(Phase.WORKING)
        self.actions.add(nodes)
        self.actions.keep_only(self.order.nodes)

    @property
    def is_taken(self) -> bool:
        """Whether an order has the robot, or had it just now."""
        return self.phase is not Phase.AVAILABLE

    @property
    def is_free(self) -> bool:
        """Whether no order is under way: nodes and actions are over, or there never was one."""
        return self.phase.is_free

    # What instant actions ask for.

    def begin_cancel(self, now: float) -> bool:
        """Begins to cancel the order. Returns False if there is none."""
        if self.phase not in (Phase.WORKING, Phase.CANCELLING):
            return False
        if self.phase is Phase.WORKING:
            self._go_to(Phase.CANCELLING)
        self.actions.fail_waiting("the order was cancelled")
        self.hands.give_up()
        self.wheels.cancel(now)
        return True

    def abandon(self) -> None:
        """Ends driving at the next grid point: the program that drives the robot ends."""
        self.wheels.cancel(0.0)

    def set_grid(self, grid: Grid) -> None:
        """Takes over a floor of the same cells, on which other things stand."""
        self.grid = self.wheels.grid = grid

    def set_paused(self, paused: bool) -> None:
        """Pauses or resumes the robot."""
        self.paused = paused
        self.driver.stop(paused)
        if not paused:
            self.instant.end("startPause")

    def request_state(self) -> None:
        """Lets the next take_state() return a state in any case."""
        self._reporter.request()

    def note_event(self, text: str) -> None:
        """Keeps what befell the vehicle for its reports, and lets a state be sent."""
        self.journal.write(text)
        self.request_state()

    def request_factsheet(self) -> None:
        """Lets the next take_factsheet() return the factsheet."""
        self._reporter.request_factsheet()

    # What goes out.

    @property
    def next_state(self) -> float:
        """When the next state is due, if nothing happens before [s, as `now`]."""
        return self._reporter.due

    def take_state(self, now: float) -> VehicleState | None:
        """Returns the state if something happened or it is time for one."""
        return self._reporter.take(self._situation(), now)

    def take_visualization(self, now: float) -> Visualization | None:
        """Returns position and speed if the robot moved and they are due."""
        return self._reporter.take_visualization(self.report, now)

    def state(self) -> VehicleState:
        """Returns the state as it is now."""
        return self._reporter.state(self._situation())

    def _outlook(self, report: Report) -> dict[str, Any]:
        """Where the vehicle will drive, for a state of 3.0."""
        order = self._driven_order
        if self.zones is None or order is None:
            return {}
        planned = planned_path(order, self.grid, report)
        limit, wall = self.zones.limit, self.zones.clock()
        held = self.paused or self.actions.holds_driving or bool(self.wheels.fault)
        if held:
            return {"planned": planned}
        speeds = self._speeds(order)
        soon = intermediate_path(order, self.grid, report, self.sheet, limit, speeds, wall)
        return {"planned": planned, "intermediate": soon}

    def _situation(self) -> Situation:
        return Situation(
            self.report,
            self.grid,
            self.order,
            is_free=self.is_free,
            paused=self.paused,
            actions=(*self.actions.states(self.paused), *self.instant.states()),
            errors=self.errors(),
            zone_sets=self.zones.store.states() if self.zones else (),
            zone_requests=self.zones.releases.states() if self.zones else (),
            **(self._outlook(self.report) if self.report else {}),
        )

    def errors(self) -> tuple[Error, ...]:
        """Returns all errors: of messages, of the robot, and of the order under way."""
        order = self.order
        zones = self.zones.errors() if self.zones else ()
        if order is None or order.cancelled or self.phase is Phase.CANCELLING:
            return self.complaints.all(self.report, zones)
        fault = "" if self.is_free else self.wheels.fault
        failed = (*self.actions.failed, *self.actions.retriable)
        return self.complaints.all(self.report, [*of_order(order, fault, failed), *zones])

    def take_factsheet(self) -> Factsheet | None:
        """Returns the factsheet if it is due: at first, and on request."""
        return self._reporter.take_factsheet()
