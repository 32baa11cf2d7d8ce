# SPDX-License-Identifier: Apache-2.0
"""Whether a vehicle can carry out an order's actions, with the parameters that they have."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from warehouse_vda5050.errors import ErrorType, Predefined
from warehouse_vda5050.model import Action, Factsheet, SupportedAction, VehicleOrder
from warehouse_vda5050.validation import MessageError

Reference = tuple[str, str]


def check_actions(order: VehicleOrder, sheet: Factsheet) -> None:
    """Raises MessageError, of type orderError, for actions that the factsheet does not have."""
    known = {supported.type: supported for supported in sheet.actions if "NODE" in supported.scopes}
    for node in order.nodes:
        refer = (("orderId", order.id[:100]), ("nodeId", node.id[:100]))
        if len(node.actions) > sheet.max_actions:
            text = f"{len(node.actions)} actions at node {node.id!r}; at most {sheet.max_actions}"
            _refuse(f"{text} were expected", refer)
        for action in node.actions:
            _check(action, known, sheet, refer)
    for edge in order.edges:
        if edge.actions:
            refer = (("orderId", order.id[:100]), ("edgeId", edge.id[:100]))
            text = f"edge {edge.id!r} has actions; they belong to nodes here"
            _refuse(text, (*refer, _reference(edge.actions[0])))


def unknown_parameters(actions: Iterable[Action], sheet: Factsheet) -> Iterator[str]:
    """Yields the parameters of instant actions that the factsheet does not have: startPause.x. A
    pause or a cancellation is not refused for them."""
    known = {
        supported.type: {name for name, *_ in supported.parameters} for supported in sheet.actions
    }
    for action in actions:
        for name, _ in action.parameters:
            if name not in known.get(action.type, {name}):
                yield f"{action.type}.{name[:60]}"


def _check(
    action: Action,
    known: dict[str, SupportedAction],
    sheet: Factsheet,
    refer: tuple[Reference, ...],
) -> None:
    refer = (*refer, _reference(action))
    if action.type not in known:
        names = ", ".join(sorted(known))
        _refuse(f"action {action.type!r} is unknown; one of {names} expected", refer)
    allowed = [key for key, *_ in known[action.type].parameters]
    for name, value in action.parameters:
        why = _fault(name, value, allowed, sheet)
        if why:
            text = f"{action.type} {action.id[:60]!r}: {name[:60]} is {str(value)[:60]!r}; {why}"
            _refuse(text, (*refer, ("field", name[:100])))


def _fault(name: str, value: Any, names: list[str], sheet: Factsheet) -> str:
    """Returns why a parameter can't be honoured, '' if it is."""
    if name not in names:
        return f"parameters are {', '.join(names) or 'none'}"
    return CHECKS[name](value, sheet) if name in CHECKS else ""


def _is_zero(value: Any, sheet: Factsheet) -> str:
    try:
        return "" if float(value) == 0 else "the robot lifts from the floor: 0 was expected"
    except (TypeError, ValueError):
        return "a number was expected"


def _is_lift(value: Any, sheet: Factsheet) -> str:
    return "" if value in ("", "lift") else "the robot's one load handling device is 'lift'"


def _is_no_side(value: Any, sheet: Factsheet) -> str:
    return "" if value == "" else "the robot lifts from below"


def _is_load_type(value: Any, sheet: Factsheet) -> str:
    return "" if value in ("", sheet.load_type) else f"the robot carries {sheet.load_type!r} alone"


# Parameters of which the robot knows one value.
CHECKS: dict[str, Callable[[Any, Factsheet], str]] = {
    "height": _is_zero,
    "depth": _is_zero,
    "lhd": _is_lift,
    "side": _is_no_side,
    "loadType": _is_load_type,
}


def _reference(action: Action) -> Reference:
    return "actionId", action.id[:100]


def _refuse(text: str, refer: tuple[Reference, ...]) -> None:
    precise = Predefined.INVALID_ORDER_ACTION
    raise MessageError(text, ErrorType.ORDER.value, refer, precise)
