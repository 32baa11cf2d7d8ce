# SPDX-License-Identifier: Apache-2.0
"""Whether a vehicle is there: the topic connection (6.14), and quality of service (6.2)."""

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.form import faults
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("connection")
case = chapter.case


def _newest(probe: Probe) -> Entry:
    entries = [*probe.log.heard(Kind.CONNECTION)]
    demand(entries, "nothing came on the topic connection")
    return entries[-1]


def _retained(probe: Probe, kind: Kind) -> Entry:
    """Returns what the broker keeps of a topic. Raises Differs."""
    mark = len(probe.log.entries)
    probe.wire.subscribe(probe.topics.of(probe.vehicle, kind))
    probe.wait(1.0)
    kept = [entry for entry in probe.log.heard(kind, mark) if entry.retained]
    demand(kept, f"the broker has retained nothing on {kind.value}")
    return kept[-1]


@case("online", "6.14")
def online(probe: Probe) -> None:
    """A vehicle that is there has said ONLINE."""
    state = (_newest(probe).value or {}).get("connectionState")
    demand(state == "ONLINE", f"connectionState is {state}")


@case("retained", "6.14")
def retained(probe: Probe) -> None:
    """All messages on connection are retained."""
    state = (_retained(probe, Kind.CONNECTION).value or {}).get("connectionState")
    demand(state == "ONLINE", f"what is retained says {state}")


@case("qos", "6.2")
def qos(probe: Probe) -> None:
    """connection has quality of service 1."""
    demand(_newest(probe).qos == 1, f"it came with quality of service {_newest(probe).qos}")


@case("qos_others", "6.2")
def qos_others(probe: Probe) -> None:
    """state and factsheet have quality of service 0."""
    probe.instant("stateRequest")
    probe.answer()
    for kind in (Kind.STATE, Kind.FACTSHEET, Kind.VISUALIZATION):
        for entry in probe.log.heard(kind):
            demand(entry.qos == 0, f"{kind.value} came with quality of service {entry.qos}")


@case("form", "6.14")
def form(probe: Probe) -> None:
    """connection has a header and connectionState, of the right types."""
    wrong = faults(Kind.CONNECTION, _newest(probe).value)
    demand(not wrong, "; ".join(wrong[:3]))


@case("offline", "6.14")
def offline(_probe: Probe) -> None:
    """A vehicle that disconnects in good order says OFFLINE before."""
    raise Untestable("the vehicle has to be switched off for that")


@case("factsheet_retained", "6.15")
def factsheet_retained(probe: Probe) -> None:
    """All messages on factsheet are retained."""
    _retained(probe, Kind.FACTSHEET)
