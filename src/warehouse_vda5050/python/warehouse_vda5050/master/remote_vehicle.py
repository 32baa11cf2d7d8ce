# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker that takes the commands of this project: one state machine.

Commands and states go in; orders and instant actions, reports and events come out. Times are wall
clock [s] of any zero.
"""

import math
import re
from dataclasses import dataclass
from enum import Enum, auto

from warehouse_vda5050.driver import Point
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master import journey
from warehouse_vda5050.master.abilities import Abilities
from warehouse_vda5050.master.commands import (
    Cancel,
    Command,
    Follow,
    Lift,
    RefusedError,
    Stop,
    UnfitError,
)
from warehouse_vda5050.master.instant import MOST_TIMES, RESEND, InstantRequests
from warehouse_vda5050.master.introduction import too_large
from warehouse_vda5050.master.journey import Journey
from warehouse_vda5050.master.load_fit import Measure, unknown
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.text_limits import too_long
from warehouse_vda5050.master.vehicle_view import VehicleView
from warehouse_vda5050.master.whereabouts import (
    is_elsewhere,
    jumped,
    left_way,
    missed,
    square,
)
from warehouse_vda5050.model import (
    ActionStatus,
    ConnectionState,
    Factsheet,
    InstantActions,
    Position,
    VehicleOrder,
    VehicleState,
)

ASKS_AFTER = 3  # orders sent again: the state that answers may be lost
UNIT = re.compile(r"(?:storage_unit)?([0-9]{1,9})")  # other names are a vehicle's own
NEAR = 0.5  # largest distance from point 0 at the start, and from the path while driving [cells]
DISPUTES = 5  # refused changes of its path in a row that a standing vehicle's path outlasts
BACK_OFF = (1.0, 30.0)  # the first and the longest wait after an order that was refused [s]


class Phase(Enum):
    """Where a vehicle is with a command.

    from         on                                                     to
    IDLE         begin: a command was accepted                          UNDER_WAY
    IDLE         it drives what no command asks for                     CLEARING
    UNDER_WAY    end, give up                                           IDLE
    UNDER_WAY    cancel                                                 CANCELLING
    CANCELLING   end                                                    IDLE
    CANCELLING   give up: it never had the order that is cancelled      CLEARING
    CLEARING     it has no order any more, and has answered             IDLE
    """

    IDLE = auto()
    UNDER_WAY = auto()  # a command is carried out by the journey
    CANCELLING = auto()  # the journey is to end early
    CLEARING = auto()  # it is to forget an order that belongs to no command


FOLLOWS: dict[Phase, frozenset[Phase]] = {
    Phase.IDLE: frozenset((Phase.UNDER_WAY, Phase.CLEARING)),
    Phase.UNDER_WAY: frozenset((Phase.IDLE, Phase.CANCELLING)),
    Phase.CANCELLING: frozenset((Phase.IDLE, Phase.CLEARING)),
    Phase.CLEARING: frozenset((Phase.IDLE,)),
}


class EventKind(Enum):
    """What became of a command, as in warehouse_msgs/Event."""

    ACCEPTED = "ACCEPTED"
    REFUSED = "REFUSED"
    DONE = "DONE"
    BLOCKED = "BLOCKED"
    LIFTED = "LIFTED"
    DROPPED = "DROPPED"
    FAILED = "FAILED"
    REPAIRED = "REPAIRED"


@dataclass(frozen=True)
class Happened:
    """An event of one robot; unit is the storage unit's number, 0 if none takes part."""

    kiva_id: int
    kind: EventKind
    text: str
    unit: int = 0


class RemoteVehicle:
    """Drives one vehicle. `run` distinguishes the orders of this run from those of others. There is
    a journey while a command is UNDER_WAY or CANCELLING. `measure` returns a unit's measures."""

    def __init__(
        self, robot: RemoteRobot, grid: Grid, run: str, measure: Measure = unknown
    ) -> None:
        self.robot, self._grid, self._run, self._measure = robot, grid, run, measure
        self.view = VehicleView(robot.frame)
        self.abilities = Abilities(robot.action_parameters)
        self._instants = InstantRequests(f"{run}-{robot.number}")
        self._state_id = self._instants.ask("stateRequest")  # else the first may be 30 s away
        self._count = 0  # of orders
        self._phase = Phase.IDLE
        self._journey: Journey | None = None
        self._cancel_id = ""
        self._sent_at, self._times = 0.0, 0
        self._refusals, self._not_before = 0, 0.0  # in a row, and until when nothing is ordered
        self._refused_at = self.view.pose  # where it refused the last
        self._fatal: frozenset[str] = frozenset()  # of its last state
        self._events: list[Happened] = []
        self._unread_sheet = ""  # why: of a factsheet that could not be read
        self.load = 0  # the number of the unit that it carries
        self.path_id = self.reached = 0
        self.last_end: EventKind | None = None

    # --- in

    def set_grid(self, grid: Grid) -> None:
        """Takes over the cells of the floor as it is now."""
        self._grid = grid

    def command(self, command: Command) -> None:
        """Takes a command; the answer is an event."""
        try:
            self._obey(command)
        except UnfitError as refusal:
            self._happened(EventKind.REFUSED, str(refusal), refusal.unit)
        except RefusedError as refusal:
            self._happened(EventKind.REFUSED, str(refusal))

    def expect_unit(self, unit: int) -> None:
        """Takes notice that it is to fetch a unit; one that it can't carry is refused at once,
        before it drives there."""
        try:
            loads = self.abilities.check_unit(unit, self._measure(unit)).loads
            for kind in ("pick", "drop"):
                self.abilities.action(kind, "", unit, loads)
        except RefusedError as refusal:
            self._happened(EventKind.REFUSED, str(refusal), unit)

    def take_state(self, state: VehicleState, now: float) -> None:
        """Takes the vehicle's state; drops one that is older than the last."""
        before, was_there = self.view.pose, self.view.is_there
        if not self.view.take_state(state, now):
            return
        self._instants.take(state)
        self._take_load(state)
        self._take_errors()
        is_idle = not state.nodes and not state.driving
        if is_idle and is_elsewhere(self._refused_at, self.view.pose):
            self._refusals, self._not_before = 0, 0.0  # what it refused there it may take here
        if self._phase is Phase.CLEARING and self._is_cancelled(state):
            self._go_to(Phase.IDLE)
        if self._journey:
            self._advance(self._journey, state, now)
        if was_there:
            fastest = self.abilities.top_speed
            self._check_place(jumped(before, self.view.pose, self.view.between, fastest))
        self._end_foreign(state)

    def take_factsheet(self, sheet: Factsheet) -> None:
        """Adapts what is to come to what the vehicle can, the rest of an order as well; reports
        the faults of a factsheet that were not known yet."""
        before = self.abilities.sheet
        if sheet.faults and (before is None or sheet.faults != before.faults):
            self._happened(
                EventKind.REFUSED, f"its factsheet is invalid: {'; '.join(sheet.faults)}"
            )
        self.abilities.sheet, self._unread_sheet = sheet, ""
        self.view.speedometer.fastest = self.abilities.top_speed
        self._instants.lengths = sheet.lengths
        if self._journey:
            self._journey.max_nodes = self.abilities.max_nodes or sheet.max_nodes
        misfit = too_large(sheet, self._grid.spacing)
        if misfit and misfit != self.view.misfit:
            self._happened(EventKind.REFUSED, f"it does not fit: {misfit}")
        self.view.misfit = misfit

    def refuse_factsheet(self, fault: str) -> None:
        """Reports a factsheet that can't be read; what was known before goes on to hold."""
        if fault != self._unread_sheet:
            self._unread_sheet = fault
            self._happened(EventKind.REFUSED, f"its factsheet can't be read: {fault}")

    def take_connection(self, state: ConnectionState, now: float) -> None:
        """Notes whether the vehicle is connected."""
        self.view.take_connection(state, now)
        if state is ConnectionState.ONLINE:  # states of the meantime are lost
            self._ask_for_state()

    # --- out

    def messages(self, now: float) -> list[VehicleOrder | InstantActions]:
        """Returns the messages to send."""
        if not self.view.hears:
            return []
        self._insist()
        order, instants = self._due_order(now), self._instants.due(now)
        return [message for message in (instants, order) if message is not None]

    def take_events(self) -> list[Happened]:
        """Returns what has happened since the last call."""
        events, self._events = self._events, []
        return events

    def note_refusals(self, texts: list[str]) -> None:
        """Reports why the vehicle refuses what is no command."""
        for text in texts:
            self._happened(EventKind.REFUSED, text)

    @property
    def is_idle(self) -> bool:
        """Whether it takes a new command."""
        return self._phase is Phase.IDLE

    @property
    def sheet_faults(self) -> tuple[str, ...]:
        """What is invalid in its factsheet, in sentences."""
        if self._unread_sheet:
            return (self._unread_sheet,)
        return self.abilities.sheet.faults if self.abilities.sheet else ()

    @property
    def order_id(self) -> str:
        """The order that its command is carried out by, '' without one."""
        return self._journey.order_id if self._journey else ""

    @property
    def lifts(self) -> bool:
        """Whether its command is to take up or put down a unit."""
        return self._journey is not None and self._journey.lift is not None

    @property
    def waits(self) -> bool:
        """Whether it stands at the end of the released part of a longer path."""
        way = self._journey
        return way is not None and self.reached >= way.released and not self.view.driving

    # --- commands

    def _obey(self, command: Command) -> None:
        if isinstance(command, Cancel):
            self._cancel()
        elif isinstance(command, Stop):
            self._instants.forget("startPause", "stopPause")
            self._instants.ask("startPause" if command.stop else "stopPause")
        elif isinstance(command, Follow):
            self._follow(command)
        elif isinstance(command, Lift):
            self._begin_lift(command)
        else:
            raise RefusedError(
                f"a vehicle behind a broker takes paths, lifts, cancel and stop; no {command.what}"
            )

    def _follow(self, command: Follow) -> None:
        self.abilities.check_speeds(command)
        way = self._journey
        if way and not way.lift and command.path_id == way.path_id:
            if self._phase is Phase.CANCELLING:
                raise RefusedError("its path is being cancelled")
            self._change(way, command)
            return
        self._check_ready()
        if command.path_id == 0:
            raise RefusedError("path_id must not be 0")
        heading = square(self.view.pose[2]) - self.robot.frame.theta
        way = journey.begin(command, self._next_id(), math.remainder(heading, math.tau))
        self._check_start(way.points[0])
        self.abilities.check_path()
        way.edge_demands = self.abilities.edge_demands
        self._begin(way, f"follow path {way.path_id}")
        self.path_id, self.reached = way.path_id, 1

    def _change(self, way: Journey, command: Follow) -> None:
        """Changes the path under way. The path of a standing vehicle that is asked again and again
        for what can't be, since a base is never taken back, ends. Raises RefusedError."""
        try:
            way.change(command)
        except RefusedError as refusal:
            way.disputes += 1
            if way.disputes < DISPUTES or not self.waits:
                raise
            self._end(EventKind.BLOCKED, f"its path can't go on: {refusal}")
            self._clear()
        else:
            way.disputes = 0

    def _begin_lift(self, command: Lift) -> None:
        self._check_ready()
        if command.up and self.load:
            raise RefusedError(f"it carries storage_unit{self.load}")
        if not command.up and not self.load:
            raise RefusedError("it carries nothing")
        unit = command.shelf_id or self.load
        loads = self.abilities.loads
        if command.up:
            loads = self.abilities.check_unit(unit, self._measure(unit)).loads
        name = f"{self._run}-{self.robot.number}-a{self._count}"
        action = self.abilities.action("pick" if command.up else "drop", name, unit, loads)
        x, y, _ = self.view.pose
        here = self._grid.position(self._grid.cell_at(x, y))
        lift = Lift(command.up, unit)
        way = Journey(0, self._next_id(), [here], 1, actions=(action,), lift=lift)
        self.abilities.loads = loads
        self._begin(way, f"{'carry' if command.up else 'drop'} {unit}")
        self.path_id = self.reached = 0

    def _go_to(self, phase: Phase) -> None:
        """Enters a phase. Raises ValueError where it does not follow."""
        if phase not in FOLLOWS[self._phase]:
            raise ValueError(f"{phase.name} can't follow {self._phase.name}")
        self._phase = phase

    def _begin(self, way: Journey, text: str) -> None:
        self._go_to(Phase.UNDER_WAY)
        self._journey, self._times = way, 0
        way.max_nodes = self.abilities.max_nodes or way.max_nodes
        self.last_end = None
        self._happened(EventKind.ACCEPTED, text, way.lift.shelf_id if way.lift else 0)

    def _check_ready(self) -> None:
        if why := self.view.why_not:
            raise RefusedError(why)
        if not self.is_idle:
            raise RefusedError("it is not idle")

    def _check_start(self, start: Point) -> None:
        x, y, _ = self.view.pose
        if max(abs(start[0] - x), abs(start[1] - y)) > NEAR * self._grid.spacing:
            raise RefusedError(
                f"its path begins at {start[0]:g}, {start[1]:g} m,"
                f" and it stands at {x:.2f}, {y:.2f}"
            )

    def _cancel(self) -> None:
        if self._phase is not Phase.UNDER_WAY:
            return
        if self._journey and not self._journey.is_known:
            self._end(EventKind.DONE, "cancelled")  # there is nothing that the vehicle could cancel
            return
        self._go_to(Phase.CANCELLING)
        self._ask_to_cancel()

    def _clear(self) -> None:
        """Has the vehicle forget an order that belongs to no command."""
        self._go_to(Phase.CLEARING)
        self._ask_to_cancel()

    def _ask_to_cancel(self) -> None:
        self._cancel_id = self._instants.ask("cancelOrder")

    @property
    def _is_ending(self) -> bool:
        """Whether the vehicle was asked to cancel its order."""
        return self._phase in (Phase.CANCELLING, Phase.CLEARING)

    def _insist(self) -> None:
        """Asks again to cancel what a vehicle that never answered still drives."""
        drives = self.view.state is not None and self.view.state.nodes
        if self._is_ending and drives and self._instants.is_given_up(self._cancel_id):
            self._ask_to_cancel()

    def _is_cancelled(self, state: VehicleState) -> bool:
        """Returns whether the vehicle was asked to cancel its order, and has done so."""
        has_answered = not self._instants.is_pending(self._cancel_id)
        return self._is_ending and not state.nodes and has_answered

    # --- the order under way

    def _next_id(self) -> str:
        self._count += 1
        return f"{self._run}-{self.robot.number}-{self._count}"

    def _place(self, point: Point) -> tuple[str, Position]:
        cell = self._grid.cell_at(*point)
        x, y = self.robot.frame.to_vehicle(*point)
        map_id = self.robot.map_id or self.view.map_id
        return self.robot.node_id(cell), Position(x, y, map_id=map_id)

    def _due_order(self, now: float) -> VehicleOrder | None:
        """Returns the next order; or the last one again, while the vehicle does not confirm it."""
        way = self._journey
        if way is None or self._phase is not Phase.UNDER_WAY:
            return None
        if way.awaits_answer:
            return self._again(way, now)
        if now < max(self._not_before, self._sent_at + self.abilities.order_interval):
            return None
        if not way.is_known and (why := self.view.why_not):
            self._end(EventKind.BLOCKED, why)
            return None
        order = way.next_order(self._place)
        if order is not None:
            self._sent_at, self._times = now, 0
            if why := too_long(order, self.abilities.lengths):
                self._back_off(now)
                self._give_up(way, f"an order that it can't take: {why}")
                return None
        return order

    def _again(self, way: Journey, now: float) -> VehicleOrder | None:
        """Returns the last order once more, if that is due.

        An update is sent for as long as it takes: the vehicle may have it, and its states be lost.
        """
        if now < self._sent_at + max(RESEND, self.abilities.order_interval):
            return None
        self._sent_at, self._times = now, self._times + 1
        if self._times % ASKS_AFTER == 0:
            self._ask_for_state()
        if way.had or self._times < MOST_TIMES:
            return way.sent
        self._give_up(way, "the vehicle does not confirm the order")
        self._clear()  # it may have it all the same
        return None

    def _ask_for_state(self) -> None:
        if not self._instants.is_pending(self._state_id):
            self._state_id = self._instants.ask("stateRequest")

    def _give_up(self, way: Journey, why: str) -> None:
        """Ends what the vehicle never had; keeps what it has of a path."""
        self._happened(EventKind.REFUSED, why)
        way.refuse()
        if not way.had:
            self._journey = None
            is_cancelling = self._phase is Phase.CANCELLING
            self._go_to(Phase.CLEARING if is_cancelling else Phase.IDLE)

    def _advance(self, way: Journey, state: VehicleState, now: float) -> None:
        if state.order_id == way.order_id and way.confirm(state.order_update):
            self._refusals = 0
        self._note_refusal(way, state, now)
        if self._journey is None or state.order_id != way.order_id:
            if self._is_cancelled(state):
                self._end(EventKind.DONE, "cancelled")
            elif self._journey and way.had:
                self._end(EventKind.BLOCKED, "the vehicle does not know its order any more")
            return
        if not way.lift and state.last_node_sequence <= 2 * (way.had - 1):
            self.reached = max(self.reached, state.last_node_sequence // 2 + 1)
        if not state.nodes and not state.driving:
            self._settle(way, state)

    def _settle(self, way: Journey, state: VehicleState) -> None:
        """Ends the command where nothing of it is left to be done."""
        if self._is_cancelled(state):
            self._end(EventKind.DONE, "cancelled")
            return
        if way.is_cut_short(state.order_update, state.last_node_sequence):
            self._end(EventKind.BLOCKED, f"others ended its order at {state.last_node}")
            return
        mine = {action.id for action in way.actions}
        states = {act.id: act for act in state.actions if act.id in mine}
        failed = [act for act in states.values() if act.status == ActionStatus.FAILED]
        if failed:
            self._end(EventKind.BLOCKED, failed[0].result or f"{failed[0].type} failed")
            return
        is_reported = way.is_whole and all(name in states for name in mine)
        if is_reported and all(act.status.is_over for act in states.values()):
            self._finish(way)

    def _finish(self, way: Journey) -> None:
        lift = way.lift
        if way.straightens and (why := missed(self.view.pose, way.points[0])):
            self._end(EventKind.BLOCKED, why)
            return
        if lift:
            self._happened(EventKind.LIFTED if lift.up else EventKind.DROPPED, "", lift.shelf_id)
        else:
            self.reached = len(way.points)
        self._end(EventKind.DONE, f"done: {'lift' if lift else f'follow path {way.path_id}'}")
        if lift:
            self.load = lift.shelf_id if lift.up else 0

    def _end(self, kind: EventKind, text: str) -> None:
        self._go_to(Phase.IDLE)
        self._journey = None
        if self.view.state:
            self._take_load(self.view.state)  # a lift that was cancelled may be done all the same
        self.last_end = kind
        self._happened(kind, text)

    def _note_refusal(self, way: Journey, state: VehicleState, now: float) -> None:
        """Takes an error that names the order for its refusal, as long as it is not confirmed."""
        if not way.awaits_answer:
            return
        for error in state.errors:
            references = dict(error.references)
            update = references.get("orderUpdateId", str(way.update))
            if references.get("orderId") == way.order_id and update == str(way.update):
                self._back_off(now)
                self._give_up(way, f"{error.type}: {error.description}")
                if self.waits and way.released == len(way.points):
                    self._end(EventKind.BLOCKED, "it refuses that its path ends where it stands")
                    self._clear()
                return

    def _back_off(self, now: float) -> None:
        """Waits longer each time that an order is refused in a row."""
        wait = min(BACK_OFF[0] * 2**self._refusals, BACK_OFF[1])
        self._refusals, self._not_before = self._refusals + 1, now + wait
        self._refused_at = self.view.pose

    # --- what befalls it

    def _take_errors(self) -> None:
        """Reports in the vehicle's own words what needs a person."""
        fatal = frozenset(self.view.fatal)
        for text in sorted(fatal - self._fatal):
            self._happened(EventKind.FAILED, text)
        if self._fatal and not fatal:
            self._happened(EventKind.REPAIRED, "the vehicle reports no fatal error any more")
        self._fatal = fatal

    def _check_place(self, jump: str) -> None:
        """Ends the path of a vehicle that is not on it any more: others may drive where it is."""
        way = self._journey
        if way and way.had and not way.lift and self._phase is Phase.UNDER_WAY:
            within = NEAR * self._grid.spacing
            if off := left_way(self.view.pose, way.points[: way.released], within):
                self._end(EventKind.BLOCKED, jump or off)
                self._clear()
        elif jump and not way:
            self._happened(EventKind.BLOCKED, jump)

    # --- what others did

    def _take_load(self, state: VehicleState) -> None:
        """Adopts the load that the vehicle reports; which unit it is, only if no pick named it."""
        if self.lifts or not self.view.reports_loads:
            return
        if not state.loads:
            self.load = 0
            return
        named = UNIT.fullmatch(state.loads[0].id)
        if named and not self.load:
            self.load = int(named[1])

    def _end_foreign(self, state: VehicleState) -> None:
        """Has an order cancelled that an earlier run or another master left, or that was given up
        and came all the same."""
        if self._phase is Phase.IDLE and state.nodes:
            self._clear()

    def _happened(self, kind: EventKind, text: str, unit: int = 0) -> None:
        self._events.append(Happened(self.robot.number, kind, text, unit))
