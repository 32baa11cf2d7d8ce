# SPDX-License-Identifier: Apache-2.0
"""One vehicle: takes orders and instant actions, drives by a Driver, tells its state.

vehicle = Vehicle(driver, grid)
vehicle.on_order(order, now)       # as they come; now is any clock that goes on [s]
vehicle.update(now)                # ten times a second
state = vehicle.take_state(now)    # to be sent, None if there is nothing new
"""

from collections import deque
from dataclasses import dataclass, replace

from warehouse_vda5050.driver import Driver, Report
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.model import (
    ActionState,
    Error,
    ErrorLevel,
    ErrorType,
    Factsheet,
    InstantActions,
    OperatingMode,
    Order,
    State,
    Visualization,
)
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.orders import cells_of, check_abilities, check_form
from warehouse_vda5050.vehicle.abilities import completed
from warehouse_vda5050.vehicle.actions import AT_NODES, ActionQueue
from warehouse_vda5050.vehicle.hands import Hands
from warehouse_vda5050.vehicle.instant import InstantDesk
from warehouse_vda5050.vehicle.progress import OrderProgress
from warehouse_vda5050.vehicle.telling import Teller
from warehouse_vda5050.vehicle.wheels import Wheels

TAKING_ORDERS = (OperatingMode.AUTOMATIC, OperatingMode.SEMIAUTOMATIC)
REMEMBERED = 1000  # ids of orders that were carried out, against late copies
KEPT_ERRORS = 10


@dataclass(frozen=True)
class VehicleSettings:
    """interval: at the latest so long after the last state comes the next [s]; moving: the same
    while it drives; visualization: between two positions of a robot that moves [s], 0: none.
    linger: so long after an order the robot is given back [s]. first_path: the number of its first
    path."""

    interval: float = 30.0
    moving: float = 1.0
    visualization: float = 1.0
    linger: float = 3.0
    first_path: int = 1


class Vehicle:
    """The state machine of one vehicle. Not for more than one thread at a time.

    `report` is what the robot told last; `order` is the order under way or the last one.
    """

    def __init__(self, driver: Driver, grid: Grid, settings: VehicleSettings | None = None) -> None:
        self.driver, self.grid = driver, grid
        self.settings = settings or VehicleSettings()
        self.report: Report | None = None
        self.order: OrderProgress | None = None
        self.actions = ActionQueue()
        self.hands = Hands(driver, self.actions)
        self.wheels = Wheels(driver, grid, self.settings.first_path)
        self.instant = InstantDesk(self)
        self.paused = False
        self.errors: deque[Error] = deque(maxlen=KEPT_ERRORS)  # of messages
        self.log: deque[str] = deque(maxlen=200)  # what happened, for logReport
        self._teller = Teller(self)
        self._done: deque[str] = deque(maxlen=REMEMBERED)
        self._cancelling = False
        self._taken = False
        self._over_since: float | None = None
        self._factsheet_due = True
        self._log_requests: list[str] = []

    # What comes in.

    def on_order(self, order: Order, now: float) -> bool:
        """Takes an order or an update. Returns whether it was accepted; if not, and it is no
        copy of what was, the state says why."""
        try:
            return self._accept(order)
        except MessageError as invalid:
            self.note(_referring(invalid.error, order))
            return False

    def on_instant_actions(self, message: InstantActions, now: float) -> None:
        """Begins instant actions."""
        for action in message.actions:
            self._write(f"{action.type} {action.id}")
            self.instant.begin(action, now)

    def note(self, error: Error) -> None:
        """Tells an error of a message, until the next order or update is accepted."""
        if error not in self.errors:
            self.errors.append(error)
            self._write(f"{error.type}: {error.description}")

    def note_unknown(self, fields: tuple[str, ...]) -> None:
        """Tells fields of a message that no version has; the message counts all the same."""
        if fields:
            names = ", ".join(fields[:5]) + (" …" if len(fields) > 5 else "")
            self.note(Error(ErrorType.UNKNOWN_FIELD.value, description=f"ignored: {names}"))

    # What goes on.

    def update(self, now: float) -> None:
        """Takes in the driver's report and carries on with the order."""
        self.report = self.driver.report()
        if self.report is None or not self.report.heard:
            return
        self._count(self.report, now)
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
            self._write(f"passed {', '.join(node.id for node in nodes)}")

    def _begin_actions(self, report: Report, now: float) -> None:
        standing = self.wheels.rest and not report.busy and not report.moving
        while action := self.actions.next(standing):
            self.hands.begin(action, report, now)

    def _drive(self, report: Report, now: float) -> None:
        order = self.order
        stays = self.actions.holds_driving or self.actions.failed
        if order and not order.is_driven and not stays and not self._cancelling:
            self.wheels.drive(order, report, now)

    def _end_order(self, report: Report, now: float) -> None:
        if self.order and report.mode not in TAKING_ORDERS and not self.is_free:
            self.begin_cancel(now)
        if self._cancelling:
            self.wheels.cancel(now)
            if self.wheels.rest and self.actions.is_over and not report.busy:
                self._end_cancel()
        self._give_back(report, now)

    def _end_cancel(self) -> None:
        assert self.order
        self.order.cancel()
        self._cancelling = False
        self.instant.end("cancelOrder")
        self._write(f"order {self.order.id} is cancelled")

    def _give_back(self, report: Report, now: float) -> None:
        """Gives the robot back some time after its order is over, unless it carries a unit."""
        if not self.is_free or report.load:
            self._over_since = None
        elif self._over_since is None:
            self._over_since = now
        elif self._taken and now - self._over_since >= self.settings.linger:
            self._taken = False
            self.driver.give_back()

    # Orders.

    def _accept(self, order: Order) -> bool:
        check_form(order)
        current = self.order
        if current and current.is_repeated(order):
            return False
        self._check_robot(order)
        check_abilities(order, AT_NODES)
        cells = cells_of(order, self.grid)
        if current and order.id == current.id:
            self._update_order(current, order, cells)
        else:
            self._begin_order(order, cells)
        self.errors.clear()
        self._write(f"order {order.id} update {order.update} is accepted")
        return True

    def _check_robot(self, order: Order) -> None:
        report = self.report
        if report is None:
            self._refuse(order, "the robot has not told where it is")
        elif not report.localized:
            self._refuse(order, "the robot does not know where it is")
        elif report.mode not in TAKING_ORDERS:
            self._refuse(order, f"the operating mode is {report.mode.value}")
        elif self._cancelling and self.order and order.id == self.order.id:
            self._refuse(order, "the order is being cancelled", ErrorType.ORDER_UPDATE)

    def _begin_order(self, order: Order, cells: list[tuple[int, int]]) -> None:
        assert self.report
        if not self.is_free:
            assert self.order
            self._refuse(order, f"order {self.order.id} is under way")
        if order.id in self._done:
            self._refuse(order, f"order {order.id} was carried out already")
        if self.report.busy or self.report.moving:
            self._refuse(order, "the robot carries out a command from elsewhere")
        self._check_start(order, cells[0])
        reason = "" if self._taken else self.driver.take()
        if reason:
            self._refuse(order, reason)
        self._taken = True
        self._start(order, cells)

    def _start(self, order: Order, cells: list[tuple[int, int]]) -> None:
        if self.order:
            self._done.append(self.order.id)
        self.order = OrderProgress(order, cells)
        self.actions = self.hands.actions = ActionQueue()
        self.wheels.begin()
        self.actions.tell(order.nodes)
        self.actions.make_due(order.nodes[:1])

    def _update_order(
        self, current: OrderProgress, order: Order, cells: list[tuple[int, int]]
    ) -> None:
        assert self.report
        if self.is_free and order.update > current.update:
            self._check_start(order, cells[0])
            reason = "" if self._taken or current.cancelled else self.driver.take()
            if reason:
                self._refuse(order, reason)
        self.actions.tell(current.stitch(order, cells))
        self._taken = True
        self.actions.keep_only(current.nodes)

    def _check_start(self, order: Order, cell: tuple[int, int]) -> None:
        """Refuses an order that does not begin where the robot stands."""
        assert self.report
        here = self.grid.cell_at(self.report.x, self.report.y)
        if cell != here:
            text = (
                f"the first node, {order.nodes[0].id}, is not where the robot stands:"
                f" {self.grid.node_id(here)}"
            )
            self._refuse(order, text, ErrorType.NO_ROUTE)

    def _refuse(self, order: Order, text: str, type: ErrorType = ErrorType.ORDER) -> None:
        refer = (("orderId", order.id[:100]), ("orderUpdateId", str(order.update)))
        raise MessageError(text, type.value, refer)

    @property
    def is_taken(self) -> bool:
        """Whether an order has the robot, or had it just now."""
        return self._taken

    @property
    def is_free(self) -> bool:
        """Whether no order is under way: nodes and actions are over, or there never was one."""
        return self.order is None or (
            self.order.is_driven
            and self.actions.is_over
            and self.wheels.rest
            and not self._cancelling
        )

    # What instant actions ask for.

    def begin_cancel(self, now: float) -> bool:
        """Begins to cancel the order. Returns False if there is none."""
        if self.is_free:
            return False
        self._cancelling = True
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
        """Stops the robot, or lets it go on."""
        self.paused = paused
        self.driver.stop(paused)
        if not paused:
            self.instant.end("startPause")

    def request_state(self) -> None:
        """Lets the next take_state() return a state in any case."""
        self._teller.request()

    def request_factsheet(self) -> None:
        """Lets the next take_factsheet() return the factsheet."""
        self._factsheet_due = True

    def request_log(self, reason: str) -> None:
        """Lets the next take_logs() return the reason."""
        self._log_requests.append(reason[:200])

    def _write(self, line: str) -> None:
        self.log.append(line[:300])

    # What goes out.

    @property
    def next_state(self) -> float:
        """When the next state is due, if nothing happens before [s, as `now`]."""
        return self._teller.due

    def take_state(self, now: float) -> State | None:
        """Returns the state if something happened or it is time for one."""
        return self._teller.take(now)

    def take_visualization(self, now: float) -> Visualization | None:
        """Returns position and speed if the robot moved and it is time to tell them."""
        return self._teller.take_visualization(now)

    def state(self) -> State:
        """Returns the state as it is now."""
        return self._teller.state()

    def take_factsheet(self) -> Factsheet | None:
        """Returns the factsheet if it is to be sent: at first, and when it was asked for."""
        due, self._factsheet_due = self._factsheet_due, False
        return completed(self.driver.factsheet()) if due else None

    def take_logs(self) -> list[tuple[str, list[str]]]:
        """Returns (reason, lines) of each logReport since the last call."""
        requests, self._log_requests = self._log_requests, []
        return [(reason, list(self.log)) for reason in requests]

    def told_errors(self) -> tuple[Error, ...]:
        """Returns all errors: of messages, of the order under way, of the robot."""
        errors = [*self.errors, *(self.report.errors if self.report else ())]
        order = self.order
        if order and not self.is_free:
            if self.wheels.fault:
                errors.append(_order_fault(order, self.wheels.fault))
            if not self._cancelling and not order.is_driven:
                errors += [_action_fault(order, state) for state in self.actions.failed]
        return tuple(replace(error, description=error.description[:500]) for error in errors)


HINT = "cancelOrder, then a new order"


def _order_fault(order: OrderProgress, text: str) -> Error:
    return Error(ErrorType.ORDER.value, ErrorLevel.WARNING, text, HINT, _references(order))


def _action_fault(order: OrderProgress, state: ActionState) -> Error:
    text = f"{state.type} failed, and the robot stays where it is: {state.result}"
    refer = (*_references(order), ("actionId", state.id[:100]))
    return Error(ErrorType.ORDER_ACTION.value, ErrorLevel.WARNING, text, HINT, refer)


def _references(order: Order | OrderProgress) -> tuple[tuple[str, str], ...]:
    """Returns what masters find an order's errors by."""
    topic = ("topic", Kind.ORDER.value)
    return topic, ("orderId", order.id[:100]), ("orderUpdateId", str(order.update))


def _referring(error: Error, order: Order) -> Error:
    """Returns the error of an order with all that masters find it by."""
    further = [pair for pair in error.references if pair[0] not in ("orderId", "orderUpdateId")]
    return replace(error, references=(*_references(order), *further))
