# SPDX-License-Identifier: Apache-2.0
"""Finds models that overlap with a new one."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from warehouse_layout.floor import poses
from warehouse_layout.models.sdf_world import Solid

TOUCHING = 0.001  # depth to which two boxes may reach into each other [m]


@dataclass(frozen=True)
class Boxes:
    """Boxes that stand upright: entry i of everything belongs to box i."""

    names: list[str]  # of their models
    centre: np.ndarray  # (n, 2) x y in `world` [m]
    half: np.ndarray  # (n, 2) half edges along their own x y [m]
    yaw: np.ndarray  # (n,) [rad]
    span: np.ndarray  # (n, 2) lowest and highest z [m]

    @classmethod
    def of_solids(cls, named: Iterable[tuple[str, Solid]]) -> "Boxes":
        """Returns the boxes of solids, each with the name of its model."""
        listed = list(named)
        rectangles = np.array([solid.rectangle() for _, solid in listed]).reshape(-1, 5)
        spans = np.array([solid.span() for _, solid in listed]).reshape(-1, 2)
        names = [name for name, _ in listed]
        return cls(names, rectangles[:, :2], rectangles[:, 2:4], rectangles[:, 4], spans)

    @classmethod
    def of_shapes(
        cls, names: list[str], frame: np.ndarray, shape: np.ndarray, size: np.ndarray
    ) -> "Boxes":
        """Returns the boxes around a shape of many models.

        frame: (n, 7) poses of the models; shape: (7,) in the model; size: (3,) its extent [m].
        """
        solid = Solid(shape, size)
        x, y, half_x, half_y, yaw = solid.rectangle()
        at = poses.compose(frame, np.repeat(poses.planar(x, y, yaw)[None], len(frame), axis=0))
        half = np.tile((half_x, half_y), (len(frame), 1))
        span = frame[:, 2:3] + np.array(solid.span())
        return cls(names, at[:, :2], half, poses.yaw(at), span)

    def __add__(self, other: "Boxes") -> "Boxes":
        pairs = ((getattr(self, f), getattr(other, f)) for f in ("centre", "half", "yaw", "span"))
        return Boxes(self.names + other.names, *map(np.concatenate, pairs))


def first(new: Boxes, standing: Boxes) -> tuple[str, str] | None:
    """Returns the names of a new model and of one that overlaps with it, or None."""
    reach = np.hypot(*standing.half.T)
    for i, name in enumerate(new.names):
        near = np.hypot(*(standing.centre - new.centre[i]).T) < reach + np.hypot(*new.half[i])
        near &= (standing.span[:, 0] < new.span[i, 1] - TOUCHING) & (
            standing.span[:, 1] > new.span[i, 0] + TOUCHING
        )
        for k in np.flatnonzero(near):
            if _overlap(new, i, standing, int(k)):
                return name, standing.names[k]
    return None


def _overlap(a: Boxes, i: int, b: Boxes, k: int) -> bool:
    """Returns whether two rectangles overlap: no edge's normal separates them (Gottschalk,
    Lin, Manocha 1996, in the plane)."""
    between = b.centre[k] - a.centre[i]
    for yaw in (a.yaw[i], b.yaw[k]):
        for axis in (
            np.array([np.cos(yaw), np.sin(yaw)]),
            np.array([-np.sin(yaw), np.cos(yaw)]),
        ):
            reach = _reach(a, i, axis) + _reach(b, k, axis)
            if abs(between @ axis) > reach - TOUCHING:
                return False
    return True


def _reach(boxes: Boxes, i: int, axis: np.ndarray) -> float:
    """Returns a rectangle's half extent along an axis [m]."""
    cos, sin = np.cos(boxes.yaw[i]), np.sin(boxes.yaw[i])
    along, across = abs(axis @ (cos, sin)), abs(axis @ (-sin, cos))
    return float(boxes.half[i] @ (along, across))
