# SPDX-License-Identifier: Apache-2.0
"""Optional fields of an order that a robot has to act by: whether this one does.

field_rules says in words what becomes of each field. A check returns why the robot can't act by
the value of a field, '' if it does.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from warehouse_vda5050.errors import ErrorType, Predefined
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import LEAST_SPEED, Edge, Factsheet, Node, VehicleOrder
from warehouse_vda5050.validation import MessageError


@dataclass(frozen=True)
class Robot:
    """What an order is checked against. yaw: its heading where the order begins [rad], None for an
    update, whose first node was checked before. is_loaded: whether it carries something."""

    sheet: Factsheet
    grid: Grid
    yaw: float | None = None
    is_loaded: bool = False


@dataclass(frozen=True)
class Stretch:
    """An edge as it is driven: heading [rad], length [m], and whether with a load."""

    robot: Robot
    heading: float
    length: float
    is_loaded: bool
    demands: dict[str, Any]


def check_demands(order: VehicleOrder, cells: list[Cell], robot: Robot) -> None:
    """Raises MessageError, of type orderError, that names the first field which can't be met."""
    if order.zone_set:
        _refuse(order, "zoneSetId", f"{order.zone_set[:60]!r}; no zones are known")
    heading, is_loaded = robot.yaw, robot.is_loaded
    for k, node in enumerate(order.nodes):
        if k > 0:
            heading = _heading(cells[k - 1], cells[k])
            _check_edge(order, k - 1, _stretch(order, cells, k, heading, is_loaded, robot))
        _check_node(order, node, heading, robot)
        is_loaded = loaded_after(node, is_loaded)


def _stretch(
    order: VehicleOrder, cells: list[Cell], k: int, heading: float, is_loaded: bool, robot: Robot
) -> Stretch:
    (x, y), (to_x, to_y) = robot.grid.position(cells[k - 1]), robot.grid.position(cells[k])
    length = abs(to_x - x) + abs(to_y - y)
    return Stretch(robot, heading, length, is_loaded, dict(order.edges[k - 1].demands))


def _heading(a: Cell, b: Cell) -> float:
    return math.atan2(b[1] - a[1], b[0] - a[0])


def loaded_after(node: Node, is_loaded: bool) -> bool:
    """Returns whether a robot has a load after the actions of a node."""
    for action in node.actions:
        is_loaded = {"pick": True, "drop": False}.get(action.type, is_loaded)
    return is_loaded


# --- edges


def _check_edge(order: VehicleOrder, index: int, stretch: Stretch) -> None:
    edge = order.edges[index]
    for name, value in stretch.demands.items():
        check = EDGE_CHECKS.get(name)
        if check and (why := check(value, stretch)):
            _refuse(order, name, f"{_text(value)}; {why}", edge)


def _max_speed(value: float, on: Stretch) -> str:
    if not LEAST_SPEED <= value < math.inf:
        return f"the robot drives at {LEAST_SPEED:g} m/s or more"
    top = on.robot.sheet.max_speed
    if value >= top or on.robot.sheet.keeps_speeds:
        return ""
    return f"the robot drives at up to {top:g} m/s on every edge"


def _max_height(value: float, on: Stretch) -> str:
    sheet = on.robot.sheet
    height = sheet.height_loaded if on.is_loaded else sheet.height
    return "" if value >= height else f"the robot is {height:g} m high there"


def _min_height(value: float, on: Stretch) -> str:
    return "" if value <= 0 else "the lift is moved at nodes alone"


def _orientation(value: float, on: Stretch) -> str:
    is_global = on.demands.get("orientationType", "").upper() == "GLOBAL"
    heading = value if is_global else on.heading + value
    if _apart(heading, on.heading) <= on.robot.sheet.heading_precision:
        return ""
    return "the robot drives forwards along its edges"


def _orientation_type(value: str, on: Stretch) -> str:
    return "" if value.upper() in ("GLOBAL", "TANGENTIAL") else "GLOBAL or TANGENTIAL was expected"


def _direction(value: str, on: Stretch) -> str:
    return "the robot follows no lines" if value else ""


def _length(value: float, on: Stretch) -> str:
    if abs(value - on.length) <= on.robot.grid.spacing / 2:
        return ""
    return f"its nodes are {on.length:g} m apart"


def _trajectory(value: Any, on: Stretch) -> str:
    return "edges here are straight"


def _corridor(value: Any, on: Stretch) -> str:
    return "the robot does not leave its edges"


EDGE_CHECKS: dict[str, Callable[[Any, Stretch], str]] = {
    "maxSpeed": _max_speed,
    "maxHeight": _max_height,
    "minHeight": _min_height,
    "orientation": _orientation,
    "orientationType": _orientation_type,
    "direction": _direction,
    "length": _length,
    "trajectory": _trajectory,
    "corridor": _corridor,
}


# --- nodes


def _check_node(order: VehicleOrder, node: Node, heading: float | None, robot: Robot) -> None:
    demands = dict(node.demands)
    if node.position and node.position.theta is not None and heading is not None:
        allowed = demands.get("allowedDeviationTheta", 0.0)
        if why := _theta(node.position.theta, allowed, heading, robot.sheet):
            _refuse(order, "theta", f"{node.position.theta:g}; {why}", node)
    if "allowedDeviationXY" in demands:
        value = demands["allowedDeviationXY"]
        if why := _deviation(value, robot.sheet):
            _refuse(order, "allowedDeviationXY", f"{_text(value)}; {why}", node)


def _theta(theta: float, allowed: float, heading: float, sheet: Factsheet) -> str:
    if not 0 <= allowed <= math.pi:
        return f"allowedDeviationTheta is {allowed:g}, and 0 to pi was expected"
    if _apart(theta, heading) <= max(allowed, sheet.heading_precision):
        return ""
    return f"the robot is there with a heading of {math.remainder(heading, math.tau):.4g}"


def _deviation(value: Any, sheet: Factsheet) -> str:
    """A radius [m], or the axes of an ellipse; 0 is whatever the robot keeps."""
    least = radius(value)
    if least is None:
        return "a radius, or an ellipse of a and b, was expected"
    if least == 0 or least >= sheet.precision:
        return ""
    return f"the robot keeps {sheet.precision:g} m"


def radius(value: Any) -> float | None:
    """Returns the smallest radius of an allowed deviation [m]; None for an invalid value."""
    axes: list[Any] = [value.get("a"), value.get("b")] if isinstance(value, dict) else [value]
    for axis in axes:
        if isinstance(axis, bool) or not isinstance(axis, (int, float)) or axis < 0:
            return None
    return float(min(axes))


def _apart(a: float, b: float) -> float:
    return abs(math.remainder(a - b, math.tau))


# --- maps


def check_maps(order: VehicleOrder, map_id: str) -> None:
    """Raises MessageError, of type orderError, for nodes of another map than `map_id`."""
    for node in order.nodes:
        node_map = node.position.map_id if node.position else ""
        if node_map not in ("", map_id):
            text = f"{node_map[:60]!r}; {map_id!r} was expected"
            _refuse(order, "mapId", text, node, Predefined.UNKNOWN_MAP_ID)


def _refuse(
    order: VehicleOrder,
    field: str,
    text: str,
    part: Node | Edge | None = None,
    precise: Predefined = Predefined.UNSUPPORTED_PARAMETER,
) -> None:
    raise MessageError(
        f"{_where(part)}{field} is {text}",
        ErrorType.ORDER.value,
        (("orderId", order.id[:100]), *_references(part), ("field", field)),
        precise,
    )


def _where(part: Node | Edge | None) -> str:
    if part is None:
        return ""
    return f"{'node' if isinstance(part, Node) else 'edge'} {part.id[:60]!r}: "


def _references(part: Node | Edge | None) -> Iterator[tuple[str, str]]:
    if part is not None:
        yield ("nodeId" if isinstance(part, Node) else "edgeId"), part.id[:100]


def _text(value: Any) -> str:
    text = f"{value:g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= 60 else "there"
