# SPDX-License-Identifier: Apache-2.0
"""Markings painted on the floor of a warehouse: a static model that nothing collides with.

Each of its links is a kind of marking, each visual a rectangle of whole cells:

    storage              storage places
    parking              where idle robots stand
    charging             the same, and batteries are charged there
    keep_out             where no robot drives
    exits+x-y            cells that may be left towards +x and -y alone
    PICK/NAME/queue      a station's lane: a cell a visual, in driving order, from its entry
    PICK/NAME/service    ... where a unit is served
    PICK/NAME/exit       ... and on to where it joins a street; REPLENISH likewise
    PICK/NAME/short_cut+x  cells that lead farther ahead in its queue, towards +x
    elevator/NAME/SECONDS  the cells of an elevator, one a tier: elevator_marks.py

Thus a world holds its floor plan, be it a file, in a process or sent as messages. Markings that are
moved or turned by quarters mark the cells that lie beneath them then.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from warehouse_layout._core import FloorError
from warehouse_layout.floor import elevator_marks, palette
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.interfaces import Look, Scenery
from warehouse_layout.floor.outlines import SQUARE, Rectangle, rectangles
from warehouse_layout.floor.stations import (
    PICK,
    QUEUE,
    REPLENISH,
    SERVICE,
    Station,
    cell_steps,
    check_lane,
    lane_mask,
    with_lanes,
)

NAME = "floor_markings"
HEADINGS = ("+x", "+y", "-x", "-y")
SHORT_CUT = "short_cut"  # a part of a lane, with a heading

_NAMED = re.compile(rf"{NAME}\d*")
_GAP = {"street": 0.0}  # between a marking and the border of its cells, of a cell
_THICK = 0.004  # of paint [m]
MOST_MARKS = 20_000  # in a model: 4 MB of text

Point = Sequence[float]  # x, y [m]


def is_name(model: str) -> bool:
    """Returns whether a model of that name is markings."""
    return bool(_NAMED.fullmatch(model))


@dataclass(frozen=True)
class Mark:
    """A rectangle on the floor, its centre and edges along the axes of `world` [m]."""

    label: str
    x: float
    y: float
    size_x: float
    size_y: float
    model: str = ""  # that it is a part of

    @property
    def kind(self) -> str:
        """A kind of cell in the palette, or any other name."""
        return _kind(self.label)

    @property
    def station(self) -> str:
        """The name of the station whose lane it marks; "" if it marks none."""
        return self.label.split("/")[1] if _is_of_lane(self.label) else ""


# The cells of each lane, by model and label.
Lanes = dict[tuple[str, str], list[tuple[Mark, tuple[slice, slice]]]]


def _is_of_lane(label: str) -> bool:
    return label.count("/") == 2 and not elevator_marks.is_label(label)


def _kind(label: str) -> str:
    if elevator_marks.is_label(label):
        return elevator_marks.ELEVATOR
    kind = label.rpartition("/")[2]
    return QUEUE if kind.startswith(SHORT_CUT) else "street" if kind.startswith("exits") else kind


def heading_of_short_cut(label: str) -> str:
    """Returns the one of HEADINGS by which the cells of a label lead into a queue; "" for labels of
    other kinds."""
    part = label.rpartition("/")[2]
    return part.removeprefix(SHORT_CUT) if part.startswith(SHORT_CUT) else ""


# --- painting


def sdf(plan: FloorPlan, name: str = f"{NAME}1") -> str:
    """Returns the SDF text of the model that marks a FloorPlan on the floor."""
    return _model(name, plan, _painted(plan))


def models_of(plan: FloorPlan) -> Iterator[tuple[str, str]]:
    """Yields name and SDF text of the models that together mark a FloorPlan: one, or several of a
    large floor, since the world reads no text beyond a size."""
    part: list[tuple[str, list[Rectangle]]] = []
    room, numbers = MOST_MARKS, count(1)
    for label, cells in _painted(plan):
        is_lane = _is_of_lane(label)
        for piece in [cells] if is_lane else _pieces(cells):
            # All parts of a lane are of one model.
            if len(piece) > room and not (is_lane and part and not label.endswith(QUEUE)):
                yield (name := f"{NAME}{next(numbers)}"), _model(name, plan, part)
                part, room = [], MOST_MARKS
            part.append((label, piece))
            room -= len(piece)
    if part:
        yield (name := f"{NAME}{next(numbers)}"), _model(name, plan, part)


def _pieces(cells: list[Rectangle]) -> Iterator[list[Rectangle]]:
    for begin in range(0, len(cells), MOST_MARKS):
        yield cells[begin : begin + MOST_MARKS]


def _model(name: str, plan: FloorPlan, painted: Iterable[tuple[str, list[Rectangle]]]) -> str:
    links = "".join(_link(label, plan, cells) for label, cells in painted)
    return f'<model name="{name}"><static>true</static>{links}</model>'


def _painted(plan: FloorPlan) -> Iterator[tuple[str, list[Rectangle]]]:
    """Yields each label with its rectangles."""
    # Obstacles show in a map of the world as well; the marking holds without them too.
    yield "keep_out", rectangles(~plan.passable)
    yield "storage", rectangles(plan.storage)
    charging = np.zeros(plan.shape, bool)
    charging.flat[list(plan.charging)] = True
    yield "parking", rectangles(plan.parking & ~charging)
    yield "charging", rectangles(charging)
    free = with_lanes(np.full(plan.shape, 15, np.uint8), plan.passable, plan.stations)
    ruled = (plan.exits != free) & ~lane_mask(plan.stations, plan.shape)
    for mask in np.unique(plan.exits[ruled]):
        label = "exits" + "".join(h for i, h in enumerate(HEADINGS) if mask >> i & 1)
        yield label, rectangles(ruled & (plan.exits == mask))
    for station in plan.stations:
        for part, cells in station.parts.items():
            y, x = np.divmod(cells, plan.width)
            yield f"{station.kind}/{station.name}/{part}", np.column_stack([x, y, x, y]).tolist()
        yield from _painted_short_cuts(plan, station)
    for elevator in plan.elevators:
        y, x = np.divmod(elevator.cells, plan.width)
        yield elevator_marks.label_of(elevator), np.column_stack([x, y, x, y]).tolist()


def _painted_short_cuts(plan: FloorPlan, station: Station) -> Iterator[tuple[str, list[Rectangle]]]:
    for step, heading in zip(cell_steps(plan.width), HEADINGS):
        cells = np.array([a for a, b in station.short_cuts if b - a == step], int)
        y, x = np.divmod(cells, plan.width)
        rows = np.column_stack([x, y, x, y]).tolist()
        yield f"{station.kind}/{station.name}/{SHORT_CUT}{heading}", rows


def _link(label: str, plan: FloorPlan, cells: Iterable[Rectangle]) -> str:
    visuals = "".join(_visual(i, label, plan, row) for i, row in enumerate(cells))
    return f"<link name={quoteattr(label)}>{visuals}</link>" if visuals else ""


def _visual(i: int, label: str, plan: FloorPlan, rectangle: Rectangle) -> str:
    kind = _kind(label)
    low, high = np.reshape(rectangle, (2, 2))
    x, y = np.array(plan.origin) + plan.spacing * (low + high) / 2
    width, height = plan.spacing * (high - low + 1 - _GAP.get(kind, 0.1))
    z = _THICK / 2
    colour = "{:.3g} {:.3g} {:.3g} 1".format(*palette.rgb(kind))
    return (
        f'<visual name="{i}"><pose>{x:.6g} {y:.6g} {z:g} 0 0 0</pose><geometry><box>'
        f"<size>{width:.6g} {height:.6g} {2 * z:g}</size></box></geometry>"
        f"<material><diffuse>{colour}</diffuse></material></visual>"
    )


# --- reading


def of_scenery(scenery: Scenery) -> list[Mark]:
    """Returns the Marks in a Scenery. Raises FloorError as read() does."""
    marks: list[Mark] = []
    for name, look, pose in zip(
        scenery.models, scenery.model_look, np.reshape(scenery.pose, (-1, 7))
    ):
        if is_name(name):
            marks += read(_of_look(scenery.looks[look]), pose, name)
    return marks


def readable(scenery: Scenery) -> list[Mark]:
    """Returns the Marks in a Scenery; none where they can't be read."""
    try:
        return of_scenery(scenery)
    except FloorError:
        return []


def served(marks: Iterable[Mark]) -> list[Mark]:
    """Returns the Marks at which units are served."""
    return [m for m in marks if m.kind == SERVICE]


def outlines(marks: Iterable[Mark]) -> np.ndarray:
    """Returns the corners of Marks in `world` [m], (n, 4, 2)."""
    rows = np.reshape([(m.x, m.y, m.size_x, m.size_y) for m in marks], (-1, 1, 4))
    return rows[..., :2] + SQUARE * rows[..., 2:] / 2


def _of_look(look: Look) -> list[Any]:
    """Returns the visuals of a Look as World.visuals() does: (link, pose (7,), size (3,)) each."""
    poses = np.reshape(look.shape_pose, (-1, 7))
    sizes = np.reshape(look.shape_size, (-1, 3))
    return [(look.links[link], *row) for link, *row in zip(look.shape_link, poses, sizes)]


def read(visuals: Iterable[Any], pose: np.ndarray, model: str = "") -> list[Mark]:
    """Returns the Marks of a model at a pose x y z [m] qx qy qz qw in `world`.

    Each visual is (link, pose (7,), size (3,) [m]). Raises FloorError unless the model is turned by
    a whole number of quarters.
    """
    x, y, _, qx, qy, qz, qw = pose
    yaw = np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
    quarters = round(yaw / (np.pi / 2))
    if abs(yaw - quarters * np.pi / 2) > 1e-3:
        raise FloorError(
            f"floor markings are turned by {yaw:g} rad, not a whole number of quarters"
        )
    c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters % 4]
    marks = []
    for link, place, size in visuals:
        wide, deep = size[:2] if s == 0 else size[1::-1]
        at_x, at_y = x + c * place[0] - s * place[1], y + s * place[0] + c * place[1]
        rectangle = float(at_x), float(at_y), float(wide), float(deep)
        marks.append(Mark(_turned(link, quarters % 4), *rectangle, model))
    return marks


def _turned(label: str, quarters: int) -> str:
    """Returns the label with its headings turned, as the markings are."""
    begin = label[:-2] if heading_of_short_cut(label) else "exits"
    if not quarters or not label.startswith(begin):
        return label
    headings = [HEADINGS.index(label[i : i + 2]) for i in range(len(begin), len(label), 2)]
    return begin + "".join(HEADINGS[(h + quarters) % 4] for h in headings)


def applied(blank: FloorPlan, marks: Iterable[Mark], belts: Mapping[str, Point]) -> FloorPlan:
    """Returns the FloorPlan of an unmarked floor with Marks on it.

    `belts` is {name: (x, y)} [m]. Raises FloorError where markings are unknown, off the floor or
    contradict each other.
    """
    storage, parking, charging, keep_out = (np.zeros(blank.shape, bool) for _ in range(4))
    exits = np.full(blank.shape, 15, np.uint8)
    marked = np.zeros(blank.shape, bool)
    areas = {"storage": storage, "parking": parking, "charging": charging, "keep_out": keep_out}
    lanes: Lanes = {}
    landings: dict[tuple[str, str], list[int]] = {}  # of each elevator, by model and label
    for mark in marks:
        where = _cells(blank, mark)
        marked[where] = True
        if mark.label in areas:
            areas[mark.label][where] = True
        elif mark.label.startswith("exits"):
            exits[where] = sum(1 << i for i, h in enumerate(HEADINGS) if h in mark.label)
        elif elevator_marks.is_label(mark.label):
            landings.setdefault((mark.model, mark.label), []).append(_number(blank, where))
        else:
            lane = (mark.model, mark.label.rpartition("/")[0])
            lanes.setdefault(lane, []).append((mark, where))
    # A marked cell is floor, even if an obstacle is there now.
    passable = (blank.passable | marked) & ~keep_out
    return FloorPlan.laid_out(
        origin=blank.origin,
        spacing=blank.spacing,
        passable=passable,
        storage=storage,
        parking=parking,
        exits=exits,
        stations=_stations(blank, lanes, passable, belts),
        obstructed=~blank.passable,
        charging=charging,
        elevators=[elevator_marks.elevator_of(label, at) for (_, label), at in landings.items()],
    )


def _cells(plan: FloorPlan, mark: Mark) -> tuple[slice, slice]:
    """Returns the cells of a Mark as slices along y and x. FloorError if they are off the floor."""
    low: list[int] = []
    high: list[int] = []
    for at, size, origin in zip((mark.x, mark.y), (mark.size_x, mark.size_y), plan.origin):
        cells = max(1, round(size / plan.spacing))
        low.append(round((at - origin) / plan.spacing - (cells - 1) / 2))
        high.append(low[-1] + cells)
    height, width = plan.shape
    if min(low) < 0 or high[0] > width or high[1] > height:
        raise FloorError(
            f"floor marking '{mark.label}' at ({mark.x:g}, {mark.y:g}) reaches off the floor"
        )
    return slice(low[1], high[1]), slice(low[0], high[0])


def _stations(
    plan: FloorPlan, lanes: Lanes, passable: np.ndarray, belts: Mapping[str, Point]
) -> tuple[Station, ...]:
    stations = []
    for (_, label), parts in lanes.items():
        cells = [(m, where) for m, where in parts if not heading_of_short_cut(m.label)]
        kind, slash, name = label.partition("/")
        service = [m.label.rpartition("/")[2] for m, _ in cells]
        if not slash or kind not in (PICK, REPLENISH) or service.count(SERVICE) != 1:
            raise FloorError(
                f"floor marking '{parts[0][0].label}': storage, parking, keep_out, exits…, or"
                " PICK/NAME/ or REPLENISH/NAME/ with queue, one cell of service, and exit expected"
            )
        numbers = np.array([_number(plan, where) for _, where in cells], np.int32)
        check_lane(f"{kind} station {name}", numbers, passable)
        at = service.index(SERVICE)
        belt = _belt_at(plan, int(numbers[at]), belts) if kind == PICK else ""
        cuts = tuple(_short_cuts(plan, parts))
        stations.append(Station(name, kind, numbers, at, belt, cuts))
    return _renamed(stations)


def _number(plan: FloorPlan, where: tuple[slice, slice]) -> int:
    rows, columns = where
    return int(rows.start) * plan.width + int(columns.start)


def _short_cuts(
    plan: FloorPlan, parts: Iterable[tuple[Mark, tuple[slice, slice]]]
) -> Iterator[tuple[int, int]]:
    """Yields the short cuts among the parts of a lane. Raises FloorError where one has another
    heading than expected, or leads off the floor."""
    for mark, where in parts:
        heading = heading_of_short_cut(mark.label)
        if not heading:
            continue
        cell = _number(plan, where)
        beside = plan.beside([cell]).tolist()
        to = cell + dict(zip(HEADINGS, cell_steps(plan.width))).get(heading, 0)
        if to == cell or to not in beside:
            raise FloorError(
                f"floor marking '{mark.label}' at ({mark.x:g}, {mark.y:g}): short_cut with one of"
                f" {', '.join(HEADINGS)}, to a cell of the floor, was expected"
            )
        yield cell, to


def _belt_at(plan: FloorPlan, cell: int, belts: Mapping[str, Point]) -> str:
    """Returns the belt nearest to a service cell; "" if its middle is more than two cells away."""
    x, y = plan.point_of(cell)
    far = {name: abs(bx - x) + abs(by - y) for name, (bx, by, *_) in belts.items()}
    nearest = min(far, key=lambda name: far[name], default="")
    return nearest if nearest and far[nearest] <= 2 * plan.spacing else ""


def _renamed(stations: Sequence[Station]) -> tuple[Station, ...]:
    """Renumbers stations whose name is taken, as where a world was added to another."""
    out: list[Station] = []
    used = {station.name for station in stations}
    for station in stations:
        name = station.name
        if name in {other.name for other in out}:
            stem = name.rstrip("0123456789")
            name = next(n for n in map(f"{stem}{{}}".format, count(1)) if n not in used)
            used.add(name)
        out.append(replace(station, name=name))
    return tuple(out)
