# SPDX-License-Identifier: Apache-2.0
"""Headers of all messages of the run (6.4), and their form (6.10.6, 6.13)."""

import re
from collections.abc import Iterator

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.form import faults
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("messages")
case = chapter.case
STAMP = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z")
OWN = (Kind.STATE, Kind.VISUALIZATION, Kind.FACTSHEET)  # connection has wills, which are older


def _live(probe: Probe, *kinds: Kind) -> Iterator[Entry]:
    for entry in probe.log.entries:
        if not entry.sent and entry.kind in kinds and not entry.retained:
            yield entry


def _form(probe: Probe, kind: Kind) -> None:
    entries = [*_live(probe, kind)]
    if not entries:
        raise Untestable(f"nothing came on {kind.value}")
    for entry in entries:
        wrong = faults(kind, entry.value)
        demand(not wrong, "; ".join(wrong[:3]))


@case("state_form", "6.10.6", audit=True)
def state_form(probe: Probe) -> None:
    """Each state has its fields, of the right types."""
    _form(probe, Kind.STATE)


@case("visualization_form", "6.13", audit=True)
def visualization_form(probe: Probe) -> None:
    """Each visualization has its fields, of the right types."""
    _form(probe, Kind.VISUALIZATION)


@case("connection_form", "6.14", audit=True)
def connection_form(probe: Probe) -> None:
    """Each connection has its fields, of the right types."""
    for entry in probe.log.heard(Kind.CONNECTION):
        wrong = faults(Kind.CONNECTION, entry.value)
        demand(not wrong, "; ".join(wrong[:3]))


@case("ids", "6.4", audit=True)
def ids(probe: Probe) -> None:
    """headerId counts up by one a topic."""
    for kind in OWN:
        numbers = [(e.value or {}).get("headerId") for e in _live(probe, kind)]
        for before, after in zip(numbers, numbers[1:]):
            follows = after == ((before or 0) + 1) % (1 << 32)
            demand(follows, f"{kind.value}: headerId {after} follows {before}")


@case("stamps", "6.4", audit=True)
def stamps(probe: Probe) -> None:
    """timestamp is ISO 8601 in UTC."""
    for entry in _live(probe, *OWN, Kind.CONNECTION):
        value = (entry.value or {}).get("timestamp")
        demand(STAMP.fullmatch(str(value)), f"{entry.kind.value}: timestamp is {value!r}")


@case("rising", "6.4", audit=True)
def rising(probe: Probe) -> None:
    """timestamp never goes back."""
    for kind in OWN:
        times = [entry.stamp for entry in _live(probe, kind)]
        for before, after in zip(times, times[1:]):
            demand(before <= after, f"{kind.value}: {after} follows {before}")


@case("clock", "6.4", audit=True)
def clock(probe: Probe) -> None:
    """timestamp advances as the clock does."""
    entries = [*_live(probe, Kind.STATE)]
    if len(entries) < 2 or entries[-1].time - entries[0].time < 20.0:
        raise Untestable("the run was too short")
    passed = (entries[-1].stamp - entries[0].stamp).total_seconds()
    real = entries[-1].time - entries[0].time
    demand(abs(passed - real) < 0.1 * real, f"{passed:.0f} s passed in {real:.0f} s")


@case("version", "6.4", audit=True)
def version(probe: Probe) -> None:
    """version is that which is tried."""
    ours = probe.codec.version.rpartition(".")[0]
    for entry in _live(probe, *OWN):
        value = str((entry.value or {}).get("version"))
        demand(value.startswith(ours), f"{entry.kind.value}: version is {value}")


@case("identity", "6.4", audit=True)
def identity(probe: Probe) -> None:
    """manufacturer and serialNumber are those of the topic."""
    for entry in _live(probe, *OWN, Kind.CONNECTION):
        value = entry.value or {}
        name = f"{value.get('manufacturer')}/{value.get('serialNumber')}"
        ours = f"{probe.vehicle.manufacturer}/{probe.vehicle.serial}"
        demand(name == ours, f"{entry.kind.value} is of {name}")
