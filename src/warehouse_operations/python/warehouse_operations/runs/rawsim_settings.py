# SPDX-License-Identifier: Apache-2.0
"""Reads settings (.xsett) of RAWSim-O: those that a shift follows, and a remark on each other
one."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.xml_fields import InstanceError, read_root, text_of
from warehouse_operations.goods.kinds import Kinds
from warehouse_operations.goods.order_sizes import OrderSizes, Spread
from warehouse_operations.runs import rawsim_skus

# Elements that describe the sizes of orders.
SIZES = {
    f"{prefix}PositionCount{bound}"
    for prefix in ("", "Order")
    for bound in ("Mean", "StdDev", "Min", "Max")
} | {"DueTimePriorityOrderProbability", "DueTimePriorityOrder", "DueTimeOrdinaryOrder"}
# Elements that a shift follows, and those without effect on figures: names, logs, drawing.
FOLLOWED = {
    "SimulationDuration",
    "Seed",
    "InventoryConfiguration/OrderMode",
    "InventoryConfiguration/InitialInventory",
    *(f"InventoryConfiguration/{name}" for name in SIZES),
    "InventoryConfiguration/ItemWeightMin",
    "InventoryConfiguration/ItemWeightMax",
    "InventoryConfiguration/BundleSizeMin",
    "InventoryConfiguration/BundleSizeMax",
    "InventoryConfiguration/DemandInventoryConfiguration/OrderCount",
    "InventoryConfiguration/DemandInventoryConfiguration/BundleCount",
    "InventoryConfiguration/DemandInventoryConfiguration/InventoryLevelBundleStopThreshold",
    "InventoryConfiguration/DemandInventoryConfiguration/InventoryLevelBundleRestartThreshold",
}
WITHOUT_EFFECT = {
    "Name",
    "UseAcceleration",  # of robots of another kind than RAWSim-O's instances have
    "UseTurnDelay",
    "LogLevel",
    "LogFileLevel",
    "DebugMode",
    "MonitorWellSortedness",
    "RotatePods",
    "CorrelativeFrequencyTracking",
    "IntenseLocationPolling",
    "StationShutdownThresholdTime",
    "Tolerance",
    "CommentTag1",
    "CommentTag2",
    "CommentTag3",
    "InventoryConfiguration/WarmupOrderCount",
    # They count where DueTimePriorityMode is false, which is named.
    "InventoryConfiguration/DueTimeOffsetMean",
    "InventoryConfiguration/DueTimeOffsetStdDev",
    "InventoryConfiguration/DueTimeOffsetMin",
    "InventoryConfiguration/DueTimeOffsetMax",
}
# Values of the only behaviour that a shift has.
DONE: dict[str, str | float] = {
    "SimulationWarmupTime": 0,
    "QueueHandlingEnabled": "true",
    "InventoryConfiguration/ItemType": "SimpleItem",
    "InventoryConfiguration/SubmitBatches": "false",
    "InventoryConfiguration/IgnoreCapacityForBundleGeneration": "false",
    "InventoryConfiguration/ReturnOrderProbability": 0,
    "InventoryConfiguration/DueTimePriorityMode": "true",
    "InventoryConfiguration/DemandInventoryConfiguration/InventoryLevelDrivenBundleGeneration": (
        "true"
    ),
}


@dataclass(frozen=True)
class ShiftSettings:
    """The part of a settings file that a shift uses, and its `Name`; None: not in the file."""

    name: str = ""
    orders: str = "fill"
    policies: dict[str, Any] = field(default_factory=dict)
    duration_s: float | None = None
    seed: int | None = None
    level: float | None = None  # of the first stock, over its room
    sizes: OrderSizes | None = None  # of drawn orders
    kinds: Kinds | None = None  # the SKUs of a file named there, or those of its ranges
    not_followed: tuple[str, ...] = ()  # sentences about other settings of the file


def read_settings(path: PathName) -> ShiftSettings:
    """Returns the ShiftSettings of an .xsett file. Raises InstanceError."""
    root = read_root(path, "SettingConfiguration")
    mode = root.findtext(".//OrderMode", "Fill")
    demand = root.find(".//DemandInventoryConfiguration")
    if mode not in ("Fill", "Poisson"):
        raise InstanceError(f"{path}: OrderMode is '{mode}'; Fill or Poisson was expected")
    orders = mode.lower()
    options: dict[str, Any] = {}
    if demand is not None:
        if mode == "Fill":
            orders = f"fill:{int(text_of(path, demand, 'OrderCount', 200))}"
        options = {
            "begin": text_of(path, demand, "InventoryLevelBundleRestartThreshold", 0.65),
            "stop": text_of(path, demand, "InventoryLevelBundleStopThreshold", 0.85),
            "waiting": int(text_of(path, demand, "BundleCount", 200)),
        }
    seed = text_of(path, root, "Seed", None)
    return ShiftSettings(
        root.findtext("Name", ""),
        orders,
        {"replenishment": {"name": "threshold", **options}} if options else {},
        text_of(path, root, "SimulationDuration", None),
        None if seed is None else int(seed),
        text_of(path, root, ".//InitialInventory", None),
        _sizes(path, root),
        rawsim_skus.of_settings(path, root),
        tuple(_not_followed(path, root)),
    )


def _sizes(path: PathName, root: Element) -> OrderSizes | None:
    """Returns the sizes of orders; None where the file names none of SIZES."""
    inventory = root.find("InventoryConfiguration")
    if inventory is None or not any(inventory.find(name) is not None for name in SIZES):
        return None
    usual = OrderSizes()
    return OrderSizes(
        _spread(path, inventory, "OrderPositionCount", usual.lines),
        _spread(path, inventory, "PositionCount", usual.pieces),
        text_of(path, inventory, "DueTimePriorityOrder", usual.due_soon),
        text_of(path, inventory, "DueTimePriorityOrderProbability", usual.share_soon),
        text_of(path, inventory, "DueTimeOrdinaryOrder", usual.due_later),
    )


def _spread(path: PathName, inventory: Element, name: str, usual: Spread) -> Spread:
    try:
        return Spread(
            text_of(path, inventory, f"{name}Mean", usual.mean),
            text_of(path, inventory, f"{name}StdDev", usual.deviation),
            int(text_of(path, inventory, f"{name}Min", usual.least)),
            int(text_of(path, inventory, f"{name}Max", usual.most)),
        )
    except ValueError as error:
        if isinstance(error, InstanceError):
            raise
        raise InstanceError(f"{path}: {name}Min and {name}Max are {error}") from error


def _not_followed(path: PathName, root: Element) -> Iterator[str]:
    """Yields a sentence for each element with a setting that a shift does not follow."""
    for name, text in _leaves(root):
        if name in FOLLOWED or name in WITHOUT_EFFECT or _is_done(name, text):
            continue
        if name == rawsim_skus.FILE:
            yield from rawsim_skus.remarks(path, text)
            continue
        instead = f"; it is {DONE[name]} here" if name in DONE else ""
        yield f"{path}: {name} {text} is not followed{instead}"


def _leaves(element: Element, above: str = "") -> Iterator[tuple[str, str]]:
    """Yields the path and the text of each element without children that has a text."""
    for child in element:
        if not isinstance(child.tag, str):
            continue  # a comment
        name = f"{above}/{child.tag}" if above else child.tag
        text = " ".join((child.text or "").split())
        if len(child):
            yield from _leaves(child, name)
        elif text:
            yield name, text


def _is_done(name: str, text: str) -> bool:
    done = DONE.get(name)
    if done is None or isinstance(done, str):
        return done is not None and text.lower() == done.lower()
    try:
        return float(text) == done
    except ValueError:
        return False
