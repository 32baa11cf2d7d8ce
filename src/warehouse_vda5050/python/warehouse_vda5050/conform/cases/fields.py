# SPDX-License-Identifier: Apache-2.0
"""Optional fields of an order (6.1.1): honoured, or the order is refused; never ignored."""

import math
from collections.abc import Callable

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Unsupported, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("fields")
case = chapter.case
Honoured = Callable[[Json, list[Json]], str]  # what in the states contradicts the field, or ''
SLOW = 0.2  # [m/s]
TOLERANCE = 0.15  # [rad]


def _honoured_or_refused(
    probe: Probe, order: Json, names: tuple[str, ...], judge: Honoured
) -> None:
    """Sends an order with an optional field; demands an error that names the field, or that the
    states show it. Raises Differs."""
    before = str(probe.state.get("errors"))
    mark = len(probe.log.entries)
    probe.order(order)
    state = probe.until(
        lambda s: view.has(s, order) or order["orderId"] in str(s.get("errors")),
        "the order or an error in a state",
    )
    errors = str(state.get("errors"))
    if not view.has(state, order) and errors != before:
        demand(any(name in errors for name in names), f"no error names {names[0]}: {errors:.200}")
        return
    probe.finish(order)
    contradiction = judge(order, probe.log.values(Kind.STATE, mark))
    demand(not contradiction, f"{names[0]} is ignored: {contradiction}")


def _with_edge(probe: Probe, **fields: object) -> Json:
    order = probe.new_order(probe.way(1))
    order["edges"][0].update(fields)
    return order


def _ignored(_order: Json, _states: list[Json]) -> str:
    return "the order was driven, and there is no error"


def _slow(order: Json, states: list[Json]) -> str:
    """Judges the speed on the one edge of an order that has a limit."""
    limited = [k for k, edge in enumerate(order["edges"]) if "maxSpeed" in edge]
    fastest = view.fastest_on(states, order, limited[0])
    return "" if fastest <= SLOW * 1.1 else f"it drove at {fastest:.2f} m/s"


@case("max_speed", "6.1.1", edges=1)
def max_speed(probe: Probe) -> None:
    """maxSpeed of an edge is kept, or the order refused."""
    _honoured_or_refused(
        probe, _with_edge(probe, maxSpeed=SLOW), ("maxSpeed", "maximumSpeed"), _slow
    )


@case("max_speed_ahead", "6.1.1", edges=3)
def max_speed_ahead(probe: Probe) -> None:
    """maxSpeed of an edge ahead is kept from the node on where it begins, or the order refused."""
    order = probe.new_order(probe.way(3))
    order["edges"][1]["maxSpeed"] = SLOW
    _honoured_or_refused(probe, order, ("maxSpeed", "maximumSpeed"), _slow)


@case("max_height", "6.1.1", edges=1)
def max_height(probe: Probe) -> None:
    """A maxHeight below the vehicle's height is refused."""
    names = ("maxHeight", "maximumMobileRobotHeight")
    _honoured_or_refused(probe, _with_edge(probe, maxHeight=0.01), names, _ignored)


@case("min_height", "6.1.1", edges=1)
def min_height(probe: Probe) -> None:
    """A minHeight that the load handling device can't keep is refused."""
    names = ("minHeight", "minimumLoadHandlingDeviceHeight")
    _honoured_or_refused(probe, _with_edge(probe, minHeight=99.0), names, _ignored)


@case("orientation", "6.1.1", edges=1)
def orientation(probe: Probe) -> None:
    """orientation of an edge, across, is driven so, or refused."""
    order = probe.new_order(probe.way(1))
    a, b = (node["nodePosition"] for node in order["nodes"])
    across = math.remainder(math.atan2(b["y"] - a["y"], b["x"] - a["x"]) + math.pi / 2, math.tau)
    order["edges"][0].update(orientation=across, orientationType="GLOBAL")

    def judge(_order: Json, states: list[Json]) -> str:
        moving = [s for s in states if s.get("driving") and s.get("agvPosition")]
        off = [abs(math.remainder(s["agvPosition"]["theta"] - across, math.tau)) for s in moving]
        return "" if off and min(off) < TOLERANCE else "it drove with another heading"

    _honoured_or_refused(probe, order, ("orientation",), judge)


@case("orientation_tangential", "6.1.1", edges=1)
def orientation_tangential(probe: Probe) -> None:
    """A tangential orientation, backwards, is driven, or refused."""
    order = probe.new_order(probe.way(1))
    a, b = (node["nodePosition"] for node in order["nodes"])
    back = math.atan2(a["y"] - b["y"], a["x"] - b["x"])
    order["edges"][0].update(orientation=math.pi, orientationType="TANGENTIAL")

    def judge(_order: Json, states: list[Json]) -> str:
        theta = states[-1]["agvPosition"]["theta"]
        off = abs(math.remainder(theta - back, math.tau))
        return "" if off < TOLERANCE else f"theta is {theta:.2f} at the end"

    _honoured_or_refused(probe, order, ("orientation",), judge)


@case("theta", "6.1.1", edges=1)
def theta(probe: Probe) -> None:
    """theta with allowedDeviationTheta is taken at the node, or refused."""
    order = probe.new_order(probe.way(1))
    a, b = (node["nodePosition"] for node in order["nodes"])
    across = math.remainder(math.atan2(b["y"] - a["y"], b["x"] - a["x"]) + math.pi / 2, math.tau)
    b.update(theta=across, allowedDeviationTheta=0.05)

    def judge(_order: Json, states: list[Json]) -> str:
        theta = states[-1]["agvPosition"]["theta"]
        off = abs(math.remainder(theta - across, math.tau))
        return "" if off < TOLERANCE else f"theta is {theta:.2f} at the end; {across:.2f} was asked"

    _honoured_or_refused(probe, order, ("theta", "Theta"), judge)


@case("deviation", "6.1.1", edges=1)
def deviation(probe: Probe) -> None:
    """An allowedDeviationXY of 1 micrometre is refused, or kept."""
    order = probe.new_order(probe.way(1))
    order["nodes"][1]["nodePosition"]["allowedDeviationXY"] = 1e-6

    def judge(_order: Json, states: list[Json]) -> str:
        goal, position = order["nodes"][1]["nodePosition"], view.at(states[-1])
        assert position
        far = math.dist(position, (goal["x"], goal["y"]))
        return "" if far <= 1e-5 else f"it stands {far:.3g} m off"

    _honoured_or_refused(probe, order, ("allowedDeviationXY", "allowedDeviationXy"), judge)


@case("theta_start", "6.1.1", edges=1)
def theta_start(probe: Probe) -> None:
    """theta of the node where the vehicle stands is taken, or refused."""
    order = probe.new_order(probe.way(0))
    here = (probe.state.get("agvPosition") or {}).get("theta", 0.0)
    across = math.remainder(here + math.pi / 2, math.tau)
    order["nodes"][0]["nodePosition"].update(theta=across, allowedDeviationTheta=0.05)

    def judge(_order: Json, states: list[Json]) -> str:
        theta = states[-1]["agvPosition"]["theta"]
        off = abs(math.remainder(theta - across, math.tau))
        return "" if off < TOLERANCE else f"theta is {theta:.2f}; {across:.2f} was asked"

    _honoured_or_refused(probe, order, ("theta", "Theta"), judge)


@case("zone_set", "6.6.6", edges=1)
def zone_set(probe: Probe) -> None:
    """A zoneSetId that the vehicle does not have is refused."""
    order = {**probe.new_order(probe.way(1)), "zoneSetId": "conform_no_such_zones"}
    _honoured_or_refused(probe, order, ("zoneSetId", "zoneSet"), _ignored)


@case("trajectory", "6.6.4.2", edges=1)
def trajectory(probe: Probe) -> None:
    """A trajectory is driven, or the order refused."""
    order = probe.new_order(probe.way(1))
    a, b = (node["nodePosition"] for node in order["nodes"])
    points = [{"x": p["x"], "y": p["y"], "weight": 1.0} for p in (a, b)]
    knots = [0.0, 0.0, 1.0, 1.0]
    order["edges"][0]["trajectory"] = {
        "degree": 1,
        "knotVector": knots,
        "controlPoints": points,
    }
    if _is_listed(probe, "trajectory"):
        probe.drive(order)
    else:
        _honoured_or_refused(probe, order, ("trajectory",), _ignored)


@case("corridor", "6.6.5", edges=1)
def corridor(probe: Probe) -> None:
    """A corridor is used, or the order refused."""
    width = {"leftWidth": 0.0, "rightWidth": 0.0, "corridorRefPoint": "KINEMATICCENTER"}
    order = _with_edge(probe, corridor=width)
    if _is_listed(probe, "corridor"):
        probe.drive(order)
    else:
        _honoured_or_refused(probe, order, ("corridor",), _ignored)


def _is_listed(probe: Probe, name: str) -> bool:
    features = probe.sheet.get("protocolFeatures")
    return any(
        str(row.get("parameter", "")).endswith(name)
        for row in view.rows(features, "optionalParameters")
    )


@case("direction", "6.1.1", edges=1)
def direction(probe: Probe) -> None:
    """direction, of line guided vehicles, is followed, or refused."""
    guided = (probe.sheet.get("typeSpecification") or {}).get("navigationTypes") or []
    if "PHYSICAL_LINE_GUIDED" in guided or "PHYSICAL_LINDE_GUIDED" in guided:
        raise Unsupported("the vehicle follows lines")
    _honoured_or_refused(probe, _with_edge(probe, direction="left"), ("direction",), _ignored)


@case("length", "6.6.6", edges=1, strict=True)
def length(probe: Probe) -> None:
    """A length that contradicts the positions is refused."""
    _honoured_or_refused(probe, _with_edge(probe, length=777.0), ("length",), _ignored)


@case("harmless", "6.1.1", edges=1)
def harmless(probe: Probe) -> None:
    """Fields that ask for nothing are taken: descriptions, a generous maxSpeed."""
    order = _with_edge(probe, maxSpeed=100.0, edgeDescription="of conform")
    order["nodes"][1]["nodeDescription"] = "of conform"
    probe.drive(order)
