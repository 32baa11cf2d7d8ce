# SPDX-License-Identifier: Apache-2.0
"""The appearance of models by the world's Scenery: shapes, sizes, triangles."""

from dataclasses import dataclass

import numpy as np

from warehouse_layout.floor import poses
from warehouse_msgs.msg import FleetState, Look, Scenery, UnitStates
from warehouse_viewer.drawing import shapes

MARGIN = 2.5  # of a floor of unknown size, around what stands on it [m]
SMALL = 0.05  # of the largest shape's volume: less is not seen from afar


@dataclass(frozen=True)
class Part:
    """One shape of a look: pose (7,) in the model, full extents (3,) [m], colour (4,) in 0…1."""

    link: str
    kind: int
    pose: np.ndarray
    size: np.ndarray
    colour: np.ndarray

    @property
    def volume(self) -> float:
        """The volume of the box around it [m³]."""
        return float(np.prod(self.size))

    def corners(self) -> np.ndarray:
        """Returns the corners of the box around it, (8, 3) [m] in the model's frame."""
        return _moved(self.pose, shapes.CORNERS * self.size)

    def triangles(self) -> np.ndarray:
        """Returns the corners of its triangles, (3 n, 3) [m] in the model's frame."""
        return _moved(self.pose, _SOLIDS.get(self.kind, shapes.box)() * self.size)


def _moved(pose: np.ndarray, points: np.ndarray) -> np.ndarray:
    turn = np.broadcast_to(pose[3:], (len(points), 4))
    return poses.rotate(turn, points) + pose[:3]


# Each with extents of one metre. A capsule counts as the cylinder around it.
_SOLIDS = {
    Look.SPHERE: shapes.ball,
    Look.ELLIPSOID: shapes.ball,
    Look.CYLINDER: shapes.cylinder,
    Look.CAPSULE: shapes.cylinder,
}


def parts(look: Look, small: float = SMALL) -> list[Part]:
    """Returns a Look's Parts, the largest first, without those below `small` of its volume."""
    link = poses.rows(look.link_pose)[list(look.shape_link)]
    at = poses.compose(link, poses.rows(look.shape_pose))
    size = np.reshape(look.shape_size, (-1, 3))
    colour = np.reshape(look.shape_colour, (-1, 4))
    links = [look.links[i] for i in look.shape_link]
    kinds = bytes(look.shape_kind)  # rospy reads uint8[] as bytes
    shapes = [Part(*row) for row in zip(links, kinds, at, size, colour)]
    shapes.sort(key=lambda part: -part.volume)
    return [part for part in shapes if part.volume >= small * shapes[0].volume]


def extent(look: Look) -> tuple[np.ndarray, np.ndarray]:
    """Returns (low, high), each (3,) [m]: the box around a Look in the model's frame."""
    corners = [part.corners() for part in parts(look, 0)] or [np.zeros((1, 3))]
    points = np.concatenate(corners)
    return points.min(0), points.max(0)


def hull(look: Look) -> Part:
    """Returns one Part for a whole Look: the box around it, in the colour of its largest part."""
    low, high = extent(look)
    centre = np.array([*(low + high) / 2, 0, 0, 0, 1])
    return Part("", Look.BOX, centre, high - low, parts(look)[0].colour)


def named(scenery: Scenery | None, kind: str) -> Look | None:
    """Returns the Look of every "kiva", "storage_unit" or "item" in a Scenery; None if unknown."""
    if scenery is None:
        return None
    index = getattr(scenery, f"{kind}_look")
    return scenery.looks[index] if index >= 0 else None


def floor(scenery: Scenery | None, fleet: FleetState, states: UnitStates) -> tuple[float, ...]:
    """Returns min_x, max_x, min_y, max_y [m] of the floor, or around the models if unknown."""
    if scenery and scenery.floor[0] < scenery.floor[1]:
        return tuple(scenery.floor)
    at = [*zip(fleet.x, fleet.y), *poses.rows(states.pose)[:, :2]] or [(0, 0)]
    low, high = np.min(at, 0) - MARGIN, np.max(at, 0) + MARGIN
    return low[0], high[0], low[1], high[1]
