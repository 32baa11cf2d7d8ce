# SPDX-License-Identifier: Apache-2.0
"""A connection that is lost (6.2, 6.14). The vehicle has to be connected by conform's proxy."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("recovery")
case = chapter.case
WILL, BACK = 30.0, 30.0  # patience for the will, and for a new connection [s]


def _heard(probe: Probe, state: str, seconds: float, mark: int) -> None:
    end = probe.now() + seconds
    while probe.now() < end:
        values = probe.log.values(Kind.CONNECTION, mark)
        if any(value.get("connectionState") == state for value in values):
            return
        probe.poll()
    demand(False, f"{state} did not come within {seconds:.0f} s")


def _lost(probe: Probe) -> int:
    """Cuts the connection; returns the number of the next message."""
    if not probe.wire.cuts:
        raise Untestable("the vehicle is not connected by --proxy")
    mark = len(probe.log.entries)
    probe.wire.cut()
    try:
        _heard(probe, "CONNECTIONBROKEN", WILL, mark)
    except Exception:
        probe.wire.restore()
        raise
    return mark


def _back(probe: Probe) -> int:
    mark = len(probe.log.entries)
    probe.wire.restore()
    _heard(probe, "ONLINE", BACK, mark)
    return mark


@case("will", "6.14")
def will(probe: Probe) -> None:
    """If the connection breaks, the broker says CONNECTIONBROKEN for the vehicle."""
    _lost(probe)
    _back(probe)


@case("will_retained", "6.14")
def will_retained(probe: Probe) -> None:
    """The last will is retained."""
    _lost(probe)
    mark = len(probe.log.entries)
    probe.wire.subscribe(probe.topics.of(probe.vehicle, Kind.CONNECTION))
    probe.wait(1.0)
    kept = [e.value for e in probe.log.heard(Kind.CONNECTION, mark) if e.retained]
    _back(probe)
    demand(kept, "the broker has retained nothing")
    said = (kept[-1] or {}).get("connectionState")
    demand(said == "CONNECTIONBROKEN", f"what is retained says {said}")


@case("online", "6.14")
def online(probe: Probe) -> None:
    """A vehicle that connects again says ONLINE, and sends a state."""
    _lost(probe)
    mark = _back(probe)
    probe.wait(2.0)
    demand(probe.log.values(Kind.STATE, mark), "no state came")


@case("hears", "6.2")
def hears(probe: Probe) -> None:
    """A vehicle that connects again hears orders and instant actions."""
    _lost(probe)
    _back(probe)
    probe.finished(probe.instant("stateRequest"))


@case("base_driven", "6.2", edges=2)
def base_driven(probe: Probe) -> None:
    """An order is driven to its last released node without a connection, too."""
    order = _lost_under_way(probe)
    state = probe.finish(order)
    demand(state.get("lastNodeSequenceId") == 4, "it is not at the last released node")


@case("order_kept", "6.2", edges=2)
def order_kept(probe: Probe) -> None:
    """An order is kept while there is no connection."""
    order = _lost_under_way(probe)
    demand(view.has(probe.state, order), "the state has another order")
    probe.finish(order)


def _lost_under_way(probe: Probe) -> Json:
    order = probe.new_order(probe.way(2))
    probe.accept(order)
    probe.driving()
    _lost(probe)
    mark = _back(probe)
    while not probe.log.values(Kind.STATE, mark):
        probe.poll()
    return order
