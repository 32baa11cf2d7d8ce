# SPDX-License-Identifier: Apache-2.0
"""Reads controllers (.xconf) of RAWSim-O: policies with a counterpart here, and names of the
others."""

from collections.abc import Iterator
from typing import Any
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.xml_fields import read_root

SUFFIX = ".xconf"
TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
# The elements that choose a method: our role, and our policies by theirs.
CHOSEN: dict[str, tuple[str, dict[str, str]]] = {
    "TaskAllocationConfig": ("robots", {"Balanced": "balanced"}),
    "ItemStorageConfig": (
        "bins",
        {"Random": "random", "Emptiest": "emptiest", "Turnover": "turnover"},
    ),
    "PodStorageConfig": (
        "storage",
        {
            "Random": "random",
            "Nearest": "nearest",
            "Fixed": "fixed",
            "Turnover": "turnover classes",
            "Cache": "cache",
        },
    ),
    "OrderBatchingConfig": ("orders", {"Random": "random", "PodMatching": "pile-on"}),
    "ReplenishmentBatchingConfig": ("batches", {"Random": "at once", "SamePod": "together"}),
}
# Options of `Default` order batching, and of the pods of a balanced allocation.
RULES = {"FCFS": "first come", "DueTime": "due date", "Random": "random"}
PODS = {"Nearest": "nearest", "WorkAmount": "most work", "WorkAmountSameTier": "most work"}
# Elements that describe the behaviour of any shift.
DONE = {
    "StationActivationConfig": "ActivateAll",
    "RepositioningConfig": "Dummy",
    "MethodManagementConfig": "NoChange",
}
OTHERS = ("PathPlanningConfig",)


def is_controller(path: PathName) -> bool:
    """Returns whether a file's name is that of a controller."""
    return str(path).lower().endswith(SUFFIX)


def read(path: PathName) -> tuple[dict[str, Any], list[str]]:
    """Returns the policies of a controller by role, and sentences about its ignored parts.

    Raises InstanceError.
    """
    root = read_root(path, "ControlConfiguration")
    chosen: dict[str, Any] = {}
    for tag, (role, names) in CHOSEN.items():
        method, element = _method(root, tag)
        if tag == "OrderBatchingConfig" and method == "Default":
            policy = RULES.get(element.findtext("OrderSelectionRule", "") if element else "")
        else:
            policy = names.get(method)
        if policy:
            chosen[role] = policy
    method, element = _method(root, "TaskAllocationConfig")
    if element is not None and (pods := PODS.get(element.findtext("OutputPodOrderType", ""))):
        chosen["units"] = pods
    return chosen, list(_not_followed(path, root, chosen))


def remarks(path: PathName) -> list[str]:
    """Returns sentences about the ignored parts of a file of policies. Raises InstanceError."""
    return read(path)[1] if is_controller(path) else []


def _method(root: Element, tag: str) -> tuple[str, Element | None]:
    """Returns the method that an element chooses, `Balanced` of BalancedTaskAllocation…."""
    element = root.find(tag)
    if element is None:
        return "", None
    kind = element.get(TYPE, "").removesuffix("uration").removesuffix("Config")
    return kind.removesuffix(tag.removesuffix("Config")), element


def _not_followed(path: PathName, root: Element, chosen: dict[str, Any]) -> Iterator[str]:
    for tag in (*CHOSEN, *DONE, *OTHERS):
        method, element = _method(root, tag)
        role = CHOSEN[tag][0] if tag in CHOSEN else ""
        if element is None or role in chosen or DONE.get(tag) == method:
            continue
        yield f"{path}: {tag} {method} is not followed"
