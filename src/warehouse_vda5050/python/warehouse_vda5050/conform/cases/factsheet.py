# SPDX-License-Identifier: Apache-2.0
"""What a vehicle says that it is and can (6.15)."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.form import faults
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("factsheet")
case = chapter.case
# Instant actions that every vehicle has (6.8.1): whatever else it can.
COMMON = ("stateRequest", "cancelOrder", "startPause", "stopPause", "factsheetRequest")


def _sheet(probe: Probe) -> Json:
    demand(probe.sheet, "there is no factsheet")
    return probe.sheet


@case("request", "6.15")
def request(probe: Probe) -> None:
    """factsheetRequest is answered by a factsheet, and ends FINISHED."""
    mark = len(probe.log.entries)
    id = probe.instant("factsheetRequest")
    probe.finished(id)
    probe.wait(0.5)
    demand(probe.log.values(Kind.FACTSHEET, mark), "no factsheet came")


@case("form", "6.15.1")
def form(probe: Probe) -> None:
    """A factsheet has its objects, with the right types."""
    wrong = faults(Kind.FACTSHEET, _sheet(probe))
    demand(not wrong, "; ".join(wrong[:3]))


@case("actions", "6.15.1")
def actions(probe: Probe) -> None:
    """protocolFeatures lists the instant actions of every vehicle."""
    _sheet(probe)
    missing = [name for name in COMMON if not probe.supports(name, "INSTANT")]
    demand(not missing, f"without {', '.join(missing)}")


@case("scopes", "6.15.1")
def scopes(probe: Probe) -> None:
    """Each action has a scope: INSTANT, NODE, EDGE (3.0: ZONE)."""
    for row in view.rows(_sheet(probe).get("protocolFeatures"), "agvActions"):
        known = set(row.get("actionScopes") or ())
        text = f"{row.get('actionType')} has the scopes {sorted(known)}"
        demand(known and known <= {"INSTANT", "NODE", "EDGE", "ZONE"}, text)


@case("measures", "6.15.1")
def measures(probe: Probe) -> None:
    """Length, width, height and speed are above 0; least is not above most."""
    body = _sheet(probe).get("physicalParameters", {})
    for name in ("length", "width", "speedMax", "heightMax"):
        demand(body.get(name, 0) > 0, f"{name} is {body.get(name)}")
    for low, high in (("speedMin", "speedMax"), ("heightMin", "heightMax")):
        both = body.get(low, 0), body[high]
        demand(both[0] <= both[1], f"{low} {both[0]} is above {high} {both[1]}")


@case("limits", "6.15.1")
def limits(probe: Probe) -> None:
    """Array and string lengths, and times, are not negative."""
    groups = _sheet(probe).get("protocolLimits", {})
    for group in ("maxStringLens", "maxArrayLens", "timing"):
        for name, value in (groups.get(group) or {}).items():
            if isinstance(value, (int, float)):
                demand(value >= 0, f"{group}.{name} is {value}")
