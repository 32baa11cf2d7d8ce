# SPDX-License-Identifier: Apache-2.0
"""Instances (.xinst) and settings (.xsett) of RAWSim-O, read as a Site and a demand.

Waypoints become cells: their places are snapped to the rows and columns that they form, whatever
the spacing. A station's lane is its queue, from the far end to the station's own waypoint, and what
follows there. Units and robots are numbered
from 1, in the file's order.
"""

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from warehouse_fleet.kinematics import Kinematics
from warehouse_layout.floor_plan import FloorPlan
from warehouse_layout.stations import PICK, REPLENISH, STEPS, Station
from warehouse_operations.shift import Settings
from warehouse_operations.site import Site

PIECE = 5.0  # mean weight of a piece, in the unit of a pod's capacity
BIN = 100.0  # capacity of a pod that one bin stands for
ON_A_LINE = 0.25  # of the spacing: waypoints this far apart may still be in one row
MOST = 1e9  # of any number in a file
MOST_CELLS = 4_000_000  # of a floor


class InstanceError(Exception):
    """A file that can't be used; the text names file, element and what was expected."""


@dataclass(frozen=True)
class ShiftSettings:
    """What of a settings file matters to a shift; None: as without one."""

    orders: str = "fill"
    policies: dict = field(default_factory=dict)
    duration_s: float = None
    seed: int = None
    level: float = None  # of the stock at first


def read_instance(path):
    """The Site of an .xinst file; raises InstanceError."""
    root = _root(path, "Instance")
    _single_tier(path, root)
    waypoints = _waypoints(path, root)
    grid = _Grid(path, waypoints)
    pods, bots = _children(root, "Pods", "Pod"), _children(root, "Bots", "Bot")
    stations, overrides = _stations(path, root, waypoints, grid)
    plan = _plan(path, waypoints, grid, stations)
    units = {i: grid.cell_at(pod, path) for i, pod in enumerate(pods, 1)}
    for pod, cell in zip(pods, units.values()):
        if not plan.storage.flat[cell]:
            raise InstanceError(f"{path}: Pod {pod.get('ID')} stands on no PodStorageLocation")
    _distinct(path, "Pod", pods, units)
    robots = {i: grid.cell_at(bot, path) for i, bot in enumerate(bots, 1)}
    _distinct(path, "Bot", bots, robots)
    items = [
        (f"item{unit}.{i + 1}", unit)
        for unit, pod in zip(units, pods)
        for i in range(max(1, round(_number(path, pod, "Capacity", 500.0) / BIN)))
    ]
    return Site(
        plan,
        robots,
        units,
        items,
        root.get("Name") or Path(path).stem,
        _kinematics(path, bots),
        Settings(by_station=overrides),
    )


def read_settings(path):
    """The ShiftSettings of an .xsett file; raises InstanceError."""
    root = _root(path, "SettingConfiguration")
    mode = root.findtext(".//OrderMode", "Fill")
    demand = root.find(".//DemandInventoryConfiguration")
    if mode not in ("Fill", "Poisson"):
        raise InstanceError(f"{path}: OrderMode is '{mode}'; Fill or Poisson was expected")
    orders, options = mode.lower(), {}
    if demand is not None:
        if mode == "Fill":
            orders = f"fill:{int(_text(path, demand, 'OrderCount', 200))}"
        options = {
            "begin": _text(path, demand, "InventoryLevelBundleRestartThreshold", 0.65),
            "stop": _text(path, demand, "InventoryLevelBundleStopThreshold", 0.85),
            "waiting": int(_text(path, demand, "BundleCount", 200)),
        }
    seed = _text(path, root, "Seed", None)
    return ShiftSettings(
        orders,
        {"replenishment": {"name": "threshold", **options}} if options else {},
        _text(path, root, "SimulationDuration", None),
        None if seed is None else int(seed),
        _text(path, root, ".//InitialInventory", None),
    )


def _root(path, tag):
    try:
        root = ElementTree.parse(path).getroot()
    except OSError as error:
        raise InstanceError(f"{path}: {error.strerror}") from error
    except ElementTree.ParseError as error:
        raise InstanceError(f"{path}:{error.position[0]}: {error}") from error
    except (LookupError, ValueError) as error:  # an unknown encoding
        raise InstanceError(f"{path}:1: {error}") from error
    if root.tag != tag:
        raise InstanceError(f"{path}: <{root.tag}>; <{tag}> was expected")
    return root


def _children(root, group, tag):
    return root.findall(f"{group}/{tag}")


def _number(path, element, name, default=None):
    text = element.get(name)
    if text is None and default is not None:
        return default
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = float("nan")
    if not abs(value) <= MOST:
        what = f"{element.tag} {element.get('ID')}"
        raise InstanceError(f"{path}: {what}: {name} is {text!r}; a number was expected")
    return value


def _text(path, root, name, default):
    text = root.findtext(name)
    if text is None:
        return default
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0 <= value <= MOST:
        name = name.rpartition("/")[2]
        raise InstanceError(f"{path}: {name} is '{text}'; a number from 0 to {MOST:g} was expected")
    return value


def _id(path, element):
    return int(_number(path, element, "ID")) + 1


def _single_tier(path, root):
    tiers = {element.get("Tier") for element in root.iter() if element.get("Tier") is not None}
    if len(tiers) > 1:
        raise InstanceError(f"{path}: {len(tiers)} tiers; robots here drive on one floor")


@dataclass
class _Waypoint:
    number: str
    x: float
    y: float
    storage: bool
    queue: bool
    paths: list
    station: tuple = None  # ("OutputStation" or "InputStation", its ID)


def _waypoints(path, root):
    result = {}
    for element in _children(root, "Waypoints", "Waypoint"):
        number = element.get("ID")
        if number in result:
            raise InstanceError(f"{path}: there are two Waypoints {number}")
        kinds = ("OutputStation", "InputStation")
        station = next(((k, element.get(k)) for k in kinds if element.get(k, "-1") != "-1"), None)
        result[number] = _Waypoint(
            number,
            _number(path, element, "X"),
            _number(path, element, "Y"),
            element.get("PodStorageLocation", "").lower() == "true",
            element.get("IsQueueWaypoint", "").lower() == "true",
            [(other.text or "").strip() for other in element.findall("Paths/Waypoint")],
            station,
        )
    if not result:
        raise InstanceError(f"{path}: there is no Waypoint")
    for one in result.values():
        for other in one.paths:
            if other not in result:
                raise InstanceError(
                    f"{path}: Waypoint {one.number} has a path to {other}, which is not there"
                )
    return result


class _Grid:
    """Rows and columns of the waypoints."""

    def __init__(self, path, waypoints):
        self.columns, self.step_x = _lines(sorted({one.x for one in waypoints.values()}))
        self.rows, self.step_y = _lines(sorted({one.y for one in waypoints.values()}))
        if not self.step_x and not self.step_y:
            raise InstanceError(f"{path}: two waypoints or more were expected")
        self.step_x, self.step_y = self.step_x or self.step_y, self.step_y or self.step_x
        self.width = max(self.columns.values()) + 1
        self.height = max(self.rows.values()) + 1
        if self.width * self.height > MOST_CELLS:
            raise InstanceError(
                f"{path}: waypoints make a floor of {self.width} by {self.height} cells; "
                f"{MOST_CELLS} cells at most were expected"
            )
        self.cell = {n: self._cell(one.x, one.y) for n, one in waypoints.items()}
        taken = {}
        for number, cell in self.cell.items():
            if cell in taken:
                raise InstanceError(
                    f"{path}: Waypoints {taken[cell]} and {number} fall into one cell"
                )
            taken[cell] = number

    @property
    def origin(self):
        return min(self.columns), min(self.rows)

    @property
    def spacing(self):
        """Of the cells [m]: the mean of both axes."""
        return (self.step_x + self.step_y) / 2

    def cell_at(self, element, path):
        """The cell of a bot or pod, the nearest waypoint's."""
        x, y = _number(path, element, "X"), _number(path, element, "Y")
        return self._cell(
            min(self.columns, key=lambda one: abs(one - x)),
            min(self.rows, key=lambda one: abs(one - y)),
        )

    def _cell(self, x, y):
        return self.rows[y] * self.width + self.columns[x]


def _lines(values):
    """The index of each coordinate's row, and the spacing; 0 if there is but one row."""
    gaps = np.diff(values)
    wide = gaps[gaps > ON_A_LINE * gaps.max()] if len(gaps) else gaps
    if not len(wide):
        return {values[0]: 0}, 0.0
    step = float(np.median(wide))
    index, result, last = 0, {values[0]: 0}, values[0]
    for value in values[1:]:
        if value - last > ON_A_LINE * step:
            index += max(1, round((value - last) / step))
            last = value
        result[value] = index
    return result, step


def _stations(path, root, waypoints, grid):
    """The Stations, and what their own times are, by name."""
    result, overrides = [], {}
    for group, tag, kind in (
        ("OutputStations", "OutputStation", PICK),
        ("InputStations", "InputStation", REPLENISH),
    ):
        for element in _children(root, group, tag):
            number = _id(path, element)
            name = f"{'pick' if kind == PICK else 'replenish'}{number}"
            lane, service = _lane(path, element, waypoints)
            cells = np.array([grid.cell[one] for one in lane], np.int32)
            result.append(Station(name, kind, cells, service))
            overrides[name] = _times(path, element, kind)
    return result, overrides


def _times(path, element, kind):
    if kind == REPLENISH:
        return {"bundle_s": _number(path, element, "ItemBundleTransferTime", 10.0)}
    piece = _number(path, element, "ItemTransferTime", 10.0)
    return {
        "piece_s": piece,
        "pick_s": min(_number(path, element, "ItemPickTime", Settings.pick_s), piece),
        "slots": int(_number(path, element, "Capacity", Settings.slots)),
    }


def _lane(path, element, waypoints):
    """The waypoints of a station's lane in driving order, and the index of the station's own."""
    key = element.tag, element.get("ID")
    own = next((one for one in waypoints.values() if one.station == key), None)
    what = f"{element.tag} {element.get('ID')}"
    if own is None:
        raise InstanceError(f"{path}: {what} has no Waypoint")
    listed = [(one.text or "").strip() for one in element.findall("Queues/Queues")]
    listed += [(one.text or "").strip() for one in element.findall("Queue/Queue")]
    lane = [own.number]
    for text in listed:
        number = text.rpartition("/")[2]
        if number not in waypoints:
            raise InstanceError(f"{path}: {what}: its queue names Waypoint {number}: not there")
        if number in lane:
            continue
        if lane[0] not in waypoints[number].paths or waypoints[number].storage:
            break  # from here on the queue is no single lane
        lane.insert(0, number)
    service = len(lane) - 1
    while True:
        after = [n for n in waypoints[lane[-1]].paths if waypoints[n].queue and n not in lane]
        onward = [n for n in waypoints[lane[-1]].paths if n not in lane]
        if len(after) != 1 or len(onward) != 1:
            return lane, service
        lane.append(after[0])


def _plan(path, waypoints, grid, stations):
    shape = grid.height, grid.width
    passable, storage = np.zeros(shape, bool), np.zeros(shape, bool)
    exits = np.zeros(shape, np.uint8)
    headings = {dx + dy * grid.width: heading for heading, (dx, dy) in enumerate(STEPS)}
    for number, one in waypoints.items():
        cell = grid.cell[number]
        passable.flat[cell], storage.flat[cell] = True, one.storage
        for other in one.paths:
            heading = headings.get(grid.cell[other] - cell)
            if heading is None:
                raise InstanceError(
                    f"{path}: Waypoints {number} and {other} are no neighbours on a grid"
                )
            exits.flat[cell] |= 1 << heading
    return FloorPlan.laid_out(
        origin=grid.origin,
        spacing=grid.spacing,
        passable=passable,
        storage=storage,
        parking=np.zeros(shape, bool),
        exits=exits,
        stations=stations,
    )


def _kinematics(path, bots):
    if not bots:
        raise InstanceError(f"{path}: there is no Bot")
    names = ("MaxVelocity", "MaxAcceleration", "TurnSpeed", "PodTransferTime")
    defaults = (1.5, 1.0, 2.5, 2.2)
    kinds = {
        tuple(_number(path, bot, name, value) for name, value in zip(names, defaults))
        for bot in bots
    }
    if len(kinds) > 1:
        raise InstanceError(f"{path}: bots of {len(kinds)} kinds; all alike was expected")
    speed, acceleration, full_turn, lift = kinds.pop()
    if min(speed, acceleration) <= 0 or min(full_turn, lift) < 0:
        raise InstanceError(f"{path}: MaxVelocity and MaxAcceleration above 0 were expected")
    return replace(
        Kinematics(),
        speed=speed,
        acceleration=acceleration,
        quarter_turn=full_turn / 4,
        lift=lift,
    )


def _distinct(path, what, elements, cells):
    first = {}
    for element, cell in zip(elements, cells.values()):
        if cell in first:
            raise InstanceError(
                f"{path}: {what} {element.get('ID')} stands where {first[cell]} does"
            )
        first[cell] = element.get("ID")
