# SPDX-License-Identifier: Apache-2.0
"""Instant actions: what a vehicle does at once, whatever its order says."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Protocol

from warehouse_vda5050.driver import Driver, Report
from warehouse_vda5050.errors import Error, ErrorType
from warehouse_vda5050.model import MAP_ID, Action, ActionState, ActionStatus
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.vehicle.hands import Hands
from warehouse_vda5050.vehicle.journal import Journal
from warehouse_vda5050.vehicle.progress import OrderProgress
from warehouse_vda5050.vehicle.zone_guard import ZoneGuard

Begin = Callable[["Commanded", Action, float], "str | None"]
KEPT = 50  # states of instant actions that are over since COPY
MOST = 1000  # states of all
COPY = 5.0  # after an action, the time within which the same actionId is a copy [s]


class ActionError(Exception):
    """An instant action that cannot be carried out; the message says why."""


class Commanded(Protocol):
    """What instant actions do to a vehicle."""

    driver: Driver
    hands: Hands
    journal: Journal
    instant: InstantDesk
    zones: ZoneGuard | None  # None: it takes no zone sets
    report: Report | None
    order: OrderProgress | None  # under way, or the last one

    def begin_cancel(self, now: float) -> bool:
        """Begins to cancel the order. Returns False if there is none."""
        ...

    def set_paused(self, paused: bool) -> None:
        """Pauses or resumes the robot."""
        ...

    def request_state(self) -> None:
        """Lets the next state be sent in any case."""
        ...

    def request_factsheet(self) -> None:
        """Lets the factsheet be sent."""
        ...

    def note(self, error: Error) -> None:
        """Reports an error of a message."""
        ...


class InstantDesk:
    """Begins instant actions of one vehicle, and reports the progress of each.

    Masters repeat what they don't find in the state, so an actionId that is known is not done
    again; others name all their pauses "pause", so some time later it is.
    """

    def __init__(self, vehicle: Commanded) -> None:
        self._vehicle = vehicle
        self._states: dict[str, ActionState] = {}
        self._begun: dict[str, float] = {}

    def begin(self, action: Action, now: float) -> None:
        """Begins an action, unless it is known."""
        known, begun = self._states.get(action.id), self._begun.get(action.id, -math.inf)
        if (known and not known.status.is_over) or now - begun <= COPY:
            return
        self._trim(now)
        self._begun[action.id] = now
        try:
            begin = ACTIONS.get(action.type)
            if begin is None:
                raise ActionError(f"{action.type!r} is not an instant action of this vehicle")
            result = begin(self._vehicle, action, now)
        except ActionError as failure:
            self._set(action, ActionStatus.FAILED, str(failure))
            self._vehicle.note(_error(action, str(failure)))
        else:
            over = result is not RUNS
            self._set(action, ActionStatus.FINISHED if over else ActionStatus.RUNNING, result or "")

    def clear(self) -> None:
        """Forgets the states of actions that are over; late copies of them are known all the
        same."""
        self._states = {id: s for id, s in self._states.items() if not s.status.is_over}

    def end(self, type: str) -> None:
        """Ends all running actions of a type."""
        for state in [*self._states.values()]:
            if state.type == type and not state.status.is_over:
                ended = ActionState(state.id, type, ActionStatus.FINISHED, instant=True)
                self._states[state.id] = ended

    def states(self) -> tuple[ActionState, ...]:
        """Returns the states of all."""
        return tuple(self._states.values())

    def _set(self, action: Action, status: ActionStatus, result: str = "") -> None:
        state = ActionState(action.id, action.type, status, result[:500], instant=True)
        self._states[action.id] = state

    def _trim(self, now: float) -> None:
        for id in [id for id, at in self._begun.items() if now - at > COPY]:
            if id not in self._states:
                del self._begun[id]
        crowded = len(self._states) >= MOST
        over = [
            id
            for id, state in self._states.items()
            if state.status.is_over and (crowded or now - self._begun[id] > COPY)
        ]
        for id in over[: max(0, len(self._states) - KEPT + 1)]:
            del self._states[id], self._begun[id]


def _error(action: Action, text: str) -> Error:
    kind = ErrorType.INSTANT_ACTION
    if action.type == "cancelOrder":
        kind = ErrorType.NO_ORDER_TO_CANCEL
    refer = (("topic", Kind.INSTANT_ACTIONS.value), ("actionId", action.id[:100]))
    return Error(kind.value, description=text, references=refer)


RUNS = None  # what the beginning of an action returns that is not over at once


def _cancel(vehicle: Commanded, action: Action, now: float) -> str | None:
    meant, order = str(action.parameter("orderId") or ""), vehicle.order
    if meant and order and meant != order.id:
        raise ActionError(f"order {meant[:60]!r} is not the active one, {order.id[:60]!r}")
    if not vehicle.begin_cancel(now):
        raise ActionError("there is no order to cancel")
    return RUNS


def _pause(vehicle: Commanded, action: Action, now: float) -> str | None:
    vehicle.set_paused(True)
    return RUNS  # until it stands


def _go_on(vehicle: Commanded, action: Action, now: float) -> str | None:
    vehicle.set_paused(False)
    return ""


def _charge(on: bool) -> Begin:
    def begin(vehicle: Commanded, action: Action, now: float) -> str | None:
        return _refuse_if(vehicle.driver.charge(on))

    return begin


def _init_position(vehicle: Commanded, action: Action, now: float) -> str | None:
    x, y, theta = (_number(action, key) for key in ("x", "y", "theta"))
    map_id = str(action.parameter("mapId") or "")
    if map_id not in ("", MAP_ID):
        raise ActionError(f"mapId is {map_id[:60]!r}; {MAP_ID!r} was expected")
    return _refuse_if(vehicle.driver.init_position(x, y, theta))


def _trigger(vehicle: Commanded, action: Action, now: float) -> str | None:
    return _refuse_if("" if vehicle.hands.trigger() else "no action waits for a trigger")


def _request_state(vehicle: Commanded, action: Action, now: float) -> str | None:
    vehicle.request_state()
    return ""


def _request_factsheet(vehicle: Commanded, action: Action, now: float) -> str | None:
    vehicle.request_factsheet()
    return ""


def _retry(vehicle: Commanded, action: Action, now: float) -> str | None:
    meant, report = str(action.parameter("actionId") or ""), vehicle.report
    known = report is not None and vehicle.hands.retry(meant, report, now)
    return _refuse_if("" if known else f"action {meant[:60]!r} does not wait for a retry")


def _skip_retry(vehicle: Commanded, action: Action, now: float) -> str | None:
    meant = str(action.parameter("actionId") or "")
    known = vehicle.hands.skip(meant)
    return _refuse_if("" if known else f"action {meant[:60]!r} does not wait for a retry")


def _clear(vehicle: Commanded, action: Action, now: float) -> str | None:
    vehicle.instant.clear()
    return ""


def _zones_of(vehicle: Commanded, action: Action) -> ZoneGuard:
    if vehicle.zones is None:
        raise ActionError(f"{action.type!r} is not an instant action of this vehicle")
    return vehicle.zones


def _enable_zones(vehicle: Commanded, action: Action, now: float) -> str | None:
    zones = _zones_of(vehicle, action)
    return _refuse_if(zones.enable(str(action.parameter("zoneSetId") or "")))


def _delete_zones(vehicle: Commanded, action: Action, now: float) -> str | None:
    zones = _zones_of(vehicle, action)
    return _refuse_if(zones.store.delete(str(action.parameter("zoneSetId") or "")))


def _report_log(vehicle: Commanded, action: Action, now: float) -> str | None:
    try:
        return vehicle.journal.store(str(action.parameter("reason", "")))
    except OSError as error:
        raise ActionError(f"the report is not stored: {error}") from None


def _refuse_if(reason: str) -> str:
    if reason:
        raise ActionError(reason)
    return ""


def _number(action: Action, key: str) -> float:
    value: Any = action.parameter(key)
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ActionError(f"{key} is {str(value)[:60]!r}; a number was expected") from None
    if not math.isfinite(number):
        raise ActionError(f"{key} is {number}; a finite number was expected")
    return number


# Each returns its result if it ends at once, else RUNS. Raises ActionError.
ACTIONS: dict[str, Begin] = {
    "cancelOrder": _cancel,
    "startPause": _pause,
    "stopPause": _go_on,
    "startCharging": _charge(True),
    "stopCharging": _charge(False),
    "initPosition": _init_position,
    "stateRequest": _request_state,
    "factsheetRequest": _request_factsheet,
    "logReport": _report_log,
    "clearInstantActions": _clear,
    "retry": _retry,
    "skipRetry": _skip_retry,
    "trigger": _trigger,
    "enableZoneSet": _enable_zones,
    "deleteZoneSet": _delete_zones,
}
