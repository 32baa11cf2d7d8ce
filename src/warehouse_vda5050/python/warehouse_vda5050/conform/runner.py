# SPDX-License-Identifier: Apache-2.0
"""Tries one case after another, and leaves the vehicle idle after each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.ground import Ground
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.orders import order_of
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.verdict import Differs, Ended, Interrupted, Untestable, Verdict

Json = dict[str, Any]
PATIENCE = 35.0  # timeout of a first state of the vehicle [s]
# What reading a message raises that lacks what every message of its kind has.
MISSHAPEN = (TypeError, ValueError, KeyError, IndexError, AttributeError)


class NoVehicleError(RuntimeError):
    """The vehicle is not there; the message says what of it is missing."""


@dataclass(frozen=True)
class Result:
    """What a case came to; `entries` are the messages of its time."""

    case: Case
    verdict: Verdict
    reason: str = ""
    seconds: float = 0.0
    entries: Sequence[Entry] = field(default=(), repr=False)


def begin(probe: Probe, ground_of: Callable[[Json], Ground]) -> None:
    """Waits for the vehicle, asks for its factsheet, and learns where it may drive. Raises
    NoVehicleError."""
    probe.instant("stateRequest")
    probe.instant("factsheetRequest")
    try:
        probe.until(lambda s: True, "a state", PATIENCE)
    except Differs as missing:
        raise NoVehicleError(f"the vehicle is silent: {missing}") from None
    if not probe.sheet:
        probe.wait(2.0)
    if view.at(probe.state) is None:
        return  # what drives is not testable
    try:
        probe.ground = ground_of(probe.state)
    except MISSHAPEN as error:
        raise NoVehicleError(f"where the vehicle may drive is not known: {error}") from error


class Runner:
    """Tries cases on one vehicle; once interrupted, it ends the case under way and tries no
    more."""

    def __init__(self, probe: Probe) -> None:
        self.probe = probe
        self.results: list[Result] = []
        self._stuck = ""  # since which case the vehicle does not come to rest, and why
        self._silent = False  # whether it does not answer either

    def run(self, cases: Iterable[Case]) -> Iterable[Result]:
        """Yields what the cases come to, one after another."""
        for case in cases:
            if self.probe.interrupted:
                return
            result = self.try_case(case)
            self.results.append(result)
            yield result

    def try_case(self, case: Case) -> Result:
        """Returns what a case comes to, and leaves the vehicle idle."""
        probe, began = self.probe, self.probe.now()
        mark = len(probe.log.entries)
        verdict, reason = Verdict.CONFORMS, ""
        try:
            self._prepare(case)
            case.trial(probe)
        except Ended as ended:
            verdict, reason = ended.verdict, str(ended)
        except MISSHAPEN as error:
            verdict, reason = Verdict.DIFFERS, f"a message without its form: {error!r}"
        except Interrupted:
            verdict, reason = Verdict.UNTESTABLE, "interrupted"
        seconds, entries = probe.now() - began, probe.log.entries[mark:]
        if not (case.audit or self._stuck):
            fault = self.settle(asks=verdict is Verdict.DIFFERS)
            self._stuck = fault and f"the vehicle does not come to rest since {case.id}: {fault}"
            if fault and verdict is Verdict.CONFORMS:
                verdict, reason = Verdict.DIFFERS, f"and afterwards: {fault}"
        return Result(case, verdict, reason, seconds, entries)

    def _prepare(self, case: Case) -> None:
        probe = self.probe
        probe.limit(probe.settings.case)
        for action in case.actions:
            probe.need(action)
        if self._stuck and (case.edges or self._silent) and not case.audit:
            self._recover()
        if case.edges:
            if probe.state.get("operatingMode") not in ("AUTOMATIC", "SEMIAUTOMATIC"):
                raise Untestable(f"operatingMode is {probe.state.get('operatingMode')}")
            probe.here()

    def _recover(self) -> None:
        """Brings the vehicle to rest after all. Raises Untestable."""
        if self.settle(asks=True):
            raise Untestable(self._stuck)
        self._stuck = ""

    def _ask(self) -> None:
        """Demands that the vehicle answers. Raises Differs."""
        self._silent = True
        self.probe.instant("stateRequest")
        self.probe.answer("stateRequest")
        self._silent = False

    def settle(self, asks: bool = False) -> str:
        """Ends whatever a case left; returns what was in the way, '' if nothing. asks: whether the
        vehicle has to answer first."""
        probe = self.probe
        probe.limit(probe.settings.case)
        probe.settling = True
        if probe.wire.cuts:
            probe.wire.restore()
        try:
            if asks:
                self._ask()
            self._settle()
        except Ended as ended:
            return str(ended)
        except MISSHAPEN as error:
            return f"a message without its form: {error!r}"
        finally:
            probe.settling = False
        return ""

    def _settle(self) -> None:
        self._resume()
        self._cancel()
        self._come_back()
        if view.rows(self.probe.state, "errors"):
            self._clear()

    def _resume(self) -> None:
        if self.probe.state.get("paused"):
            self.probe.instant("stopPause")
            self.probe.until(lambda s: not s.get("paused"), "paused false after stopPause")

    def _cancel(self) -> None:
        probe = self.probe
        if is_busy(probe.state):
            probe.instant("cancelOrder")
            seconds = probe.settings.edge + probe.settings.answer
            probe.until(lambda s: not is_busy(s), "an idle vehicle after cancelOrder", seconds)

    def _come_back(self) -> None:
        """Drives to the nearest place, if the vehicle is between two."""
        probe, ground, position = self.probe, self.probe.ground, view.at(self.probe.state)
        if ground is None or position is None or ground.at(*position) is not None:
            return
        here = ground.places[ground.nearest(*position)]
        start = type(here)(probe.new_id("here"), *position, here.map_id)
        probe.drive(probe.new_order([start, here]))

    def _clear(self) -> None:
        """Lets the vehicle forget the errors of refused messages, by an order that it accepts."""
        probe = self.probe
        probe.drive(order_of(probe.new_id(), probe.way(0)))


def is_busy(state: Json) -> bool:
    """Returns whether an order is under way."""
    return bool(
        state.get("nodeStates")
        or state.get("edgeStates")
        or state.get("driving")
        or any(a.get("actionStatus") not in view.OVER for a in view.rows(state, "actionStates"))
    )
