# SPDX-License-Identifier: Apache-2.0
"""Reads settings (.xsett) of RAWSim-O: those that a shift follows, and a remark on each other
one."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.xml_fields import InstanceError, read_root, text_of

# Elements that a shift follows, and those without effect on figures: names, logs, drawing.
FOLLOWED = {
    "SimulationDuration",
    "Seed",
    "InventoryConfiguration/OrderMode",
    "InventoryConfiguration/InitialInventory",
    "InventoryConfiguration/DemandInventoryConfiguration/OrderCount",
    "InventoryConfiguration/DemandInventoryConfiguration/BundleCount",
    "InventoryConfiguration/DemandInventoryConfiguration/InventoryLevelBundleStopThreshold",
    "InventoryConfiguration/DemandInventoryConfiguration/InventoryLevelBundleRestartThreshold",
}
WITHOUT_EFFECT = {
    "Name",
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
}
# Values of the only behaviour that a shift has.
DONE: dict[str, str | float] = {
    "SimulationWarmupTime": 0,
    "UseAcceleration": "true",
    "UseTurnDelay": "true",
    "QueueHandlingEnabled": "true",
    "InventoryConfiguration/ItemType": "SimpleItem",
    "InventoryConfiguration/SubmitBatches": "false",
    "InventoryConfiguration/IgnoreCapacityForBundleGeneration": "false",
    "InventoryConfiguration/BundleSizeMin": 4,
    "InventoryConfiguration/BundleSizeMax": 12,
    "InventoryConfiguration/ReturnOrderProbability": 0,
    "InventoryConfiguration/PositionCountMean": 1,
    "InventoryConfiguration/PositionCountStdDev": 0.3,
    "InventoryConfiguration/PositionCountMin": 1,
    "InventoryConfiguration/PositionCountMax": 3,
    "InventoryConfiguration/OrderPositionCountMean": 1,
    "InventoryConfiguration/OrderPositionCountStdDev": 1,
    "InventoryConfiguration/OrderPositionCountMin": 1,
    "InventoryConfiguration/OrderPositionCountMax": 4,
    "InventoryConfiguration/DueTimePriorityMode": "true",
    "InventoryConfiguration/DueTimePriorityOrderProbability": 0.2,
    "InventoryConfiguration/DueTimePriorityOrder": 1800,
    "InventoryConfiguration/DueTimeOrdinaryOrder": 7200,
    "InventoryConfiguration/DemandInventoryConfiguration/InventoryLevelDrivenBundleGeneration": (
        "true"
    ),
}


@dataclass(frozen=True)
class ShiftSettings:
    """The part of a settings file that a shift uses; None: not in the file."""

    orders: str = "fill"
    policies: dict[str, Any] = field(default_factory=dict)
    duration_s: float | None = None
    seed: int | None = None
    level: float | None = None  # of the first stock, over its room
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
        orders,
        {"replenishment": {"name": "threshold", **options}} if options else {},
        text_of(path, root, "SimulationDuration", None),
        None if seed is None else int(seed),
        text_of(path, root, ".//InitialInventory", None),
        tuple(_not_followed(path, root)),
    )


def _not_followed(path: PathName, root: Element) -> Iterator[str]:
    """Yields a sentence for each element with a setting that a shift does not follow."""
    for name, text in _leaves(root):
        if name in FOLLOWED or name in WITHOUT_EFFECT or _is_done(name, text):
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
