# SPDX-License-Identifier: Apache-2.0
"""Arrays of poses: (n, 7) rows x y z [m] qx qy qz qw, as the messages lay them out."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike


def rows(flat: ArrayLike) -> np.ndarray:
    """Returns a message's flat list of poses as rows, (n, 7)."""
    return np.asarray(flat, float).reshape(-1, 7)


def planar(x: float, y: float, yaw: float) -> np.ndarray:
    """Returns the pose (7,) of a place x, y [m] on the floor, turned by yaw [rad] about z."""
    return np.array([x, y, 0, 0, 0, np.sin(yaw / 2), np.cos(yaw / 2)], float)


def compose(frame: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """Returns poses `inner`, given in frames, in the parent of those frames; all (n, 7)."""
    out = np.empty_like(inner)
    out[:, :3] = frame[:, :3] + rotate(frame[:, 3:], inner[:, :3])
    out[:, 3:] = multiply(frame[:, 3:], inner[:, 3:])
    return out


def inverse(frame: np.ndarray) -> np.ndarray:
    """Returns the pose of each frame's parent in that frame; both (n, 7)."""
    out = frame * (-1, -1, -1, -1, -1, -1, 1)
    out[:, :3] = rotate(out[:, 3:], out[:, :3])
    return out


def rotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Returns vectors v (n, 3) turned by unit quaternions q (n, 4)."""
    twice = 2 * np.cross(q[:, :3], v)
    return v + q[:, 3:] * twice + np.cross(q[:, :3], twice)


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Returns the quaternion products a b, all (n, 4)."""
    out = np.empty_like(b)
    out[:, :3] = a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3])
    out[:, 3] = a[:, 3] * b[:, 3] - np.einsum("ij,ij->i", a[:, :3], b[:, :3])
    return out


def yaw(pose: np.ndarray) -> np.ndarray:
    """Returns the headings [rad] of poses (n, 7), within -pi … pi."""
    x, y, z, w = pose[:, 3:].T
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def planar_of(messages: Iterable[Any]) -> np.ndarray:
    """Returns x y [m] yaw [rad] of each geometry_msgs/Pose, (n, 3)."""
    pairs = [(p.position, p.orientation) for p in messages]
    out = rows([(at.x, at.y, at.z, q.x, q.y, q.z, q.w) for at, q in pairs])
    return np.column_stack([out[:, :2], yaw(out)])
