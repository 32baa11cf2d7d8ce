# SPDX-License-Identifier: Apache-2.0
"""Instant actions: what a vehicle does at once, whatever its order says."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from warehouse_vda5050.model import Action, ActionState, ActionStatus, Error, ErrorType
from warehouse_vda5050.topics import Kind

if TYPE_CHECKING:
    from warehouse_vda5050.vehicle.vehicle import Vehicle

KEPT = 50  # states of instant actions that are over
COPY = 5.0  # so long after an action the same actionId is a copy, and not another request [s]


class ActionError(Exception):
    """An instant action that cannot be carried out; the message says why."""


class InstantDesk:
    """Begins instant actions of one vehicle, and tells how far each has come.

    Masters repeat what they don't find in the state, so an actionId that is known is not done
    again; others name all their pauses "pause", so some time later it is.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._states: dict[str, ActionState] = {}
        self._begun: dict[str, float] = {}

    def begin(self, action: Action, now: float) -> None:
        """Begins an action, unless it is known."""
        known = self._states.get(action.id)
        if known and not (known.status.is_over and now - self._begun[action.id] > COPY):
            return
        self._trim()
        self._begun[action.id] = now
        try:
            begin = ACTIONS.get(action.type)
            if begin is None:
                raise ActionError(f"{action.type!r} is not an instant action of this vehicle")
            over = begin(self._vehicle, action, now)
        except ActionError as failure:
            self._set(action, ActionStatus.FAILED, str(failure))
            self._vehicle.note(_error(action, str(failure)))
        else:
            self._set(action, ActionStatus.FINISHED if over else ActionStatus.RUNNING)

    def end(self, type: str) -> None:
        """Ends all running actions of a type."""
        for state in [*self._states.values()]:
            if state.type == type and not state.status.is_over:
                ended = ActionState(state.id, type, ActionStatus.FINISHED, instant=True)
                self._states[state.id] = ended

    def states(self) -> tuple[ActionState, ...]:
        """Returns how far all have come."""
        return tuple(self._states.values())

    def _set(self, action: Action, status: ActionStatus, result: str = "") -> None:
        state = ActionState(action.id, action.type, status, result[:500], instant=True)
        self._states[action.id] = state

    def _trim(self) -> None:
        over = [id for id, state in self._states.items() if state.status.is_over]
        for id in over[: max(0, len(self._states) - KEPT + 1)]:
            del self._states[id], self._begun[id]


def _error(action: Action, text: str) -> Error:
    kind = ErrorType.INSTANT_ACTION
    if action.type == "cancelOrder":
        kind = ErrorType.NO_ORDER_TO_CANCEL
    refer = (("topic", Kind.INSTANT_ACTIONS.value), ("actionId", action.id[:100]))
    return Error(kind.value, description=text, references=refer)


def _cancel(vehicle: Vehicle, action: Action, now: float) -> bool:
    if not vehicle.begin_cancel(now):
        raise ActionError("there is no order to cancel")
    return False


def _pause(vehicle: Vehicle, action: Action, now: float) -> bool:
    vehicle.set_paused(True)
    return False  # until it stands


def _go_on(vehicle: Vehicle, action: Action, now: float) -> bool:
    vehicle.set_paused(False)
    return True


def _charge(on: bool) -> Callable[[Vehicle, Action, float], bool]:
    def begin(vehicle: Vehicle, action: Action, now: float) -> bool:
        return _unless(vehicle.driver.charge(on))

    return begin


def _init_position(vehicle: Vehicle, action: Action, now: float) -> bool:
    x, y, theta = (_number(action, key) for key in ("x", "y", "theta"))
    return _unless(vehicle.driver.init_position(x, y, theta))


def _trigger(vehicle: Vehicle, action: Action, now: float) -> bool:
    return _unless("" if vehicle.hands.trigger() else "no action waits for a trigger")


def _tell_state(vehicle: Vehicle, action: Action, now: float) -> bool:
    vehicle.request_state()
    return True


def _tell_factsheet(vehicle: Vehicle, action: Action, now: float) -> bool:
    vehicle.request_factsheet()
    return True


def _report_log(vehicle: Vehicle, action: Action, now: float) -> bool:
    vehicle.request_log(str(action.parameter("reason", "")))
    return True


def _unless(reason: str) -> bool:
    if reason:
        raise ActionError(reason)
    return True


def _number(action: Action, key: str) -> float:
    value: Any = action.parameter(key)
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ActionError(f"{key} is {str(value)[:60]!r}; a number was expected") from None
    if not math.isfinite(number):
        raise ActionError(f"{key} is {number}; a finite number was expected")
    return number


# Each returns whether it is over at once. Raises ActionError.
ACTIONS: dict[str, Callable[[Vehicle, Action, float], bool]] = {
    "cancelOrder": _cancel,
    "startPause": _pause,
    "stopPause": _go_on,
    "startCharging": _charge(True),
    "stopCharging": _charge(False),
    "initPosition": _init_position,
    "stateRequest": _tell_state,
    "factsheetRequest": _tell_factsheet,
    "logReport": _report_log,
    "trigger": _trigger,
}
