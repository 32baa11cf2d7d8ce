# SPDX-License-Identifier: Apache-2.0
"""Arrays of poses: (n, 7) rows x y z [m] qx qy qz qw, as the messages lay them out."""

import numpy as np


def rows(flat):
    """(n, 7) from a message's flat list."""
    return np.asarray(flat, float).reshape(-1, 7)


def planar(x, y, yaw):
    """A pose on the floor, heading yaw [rad] about z."""
    return np.array([x, y, 0, 0, 0, np.sin(yaw / 2), np.cos(yaw / 2)], float)


def compose(frame, inner):
    """Poses given in a frame, in that frame's own parent: both (n, 7)."""
    out = np.empty_like(inner)
    out[:, :3] = frame[:, :3] + rotate(frame[:, 3:], inner[:, :3])
    out[:, 3:] = multiply(frame[:, 3:], inner[:, 3:])
    return out


def inverse(frame):
    """Poses of a frame's parent, given in that frame: (n, 7)."""
    out = frame * (-1, -1, -1, -1, -1, -1, 1)
    out[:, :3] = rotate(out[:, 3:], out[:, :3])
    return out


def rotate(q, v):
    """Vectors (n, 3) turned by unit quaternions (n, 4)."""
    twice = 2 * np.cross(q[:, :3], v)
    return v + q[:, 3:] * twice + np.cross(q[:, :3], twice)


def multiply(a, b):
    """Quaternion products a b, all (n, 4)."""
    out = np.empty_like(b)
    out[:, :3] = a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3])
    out[:, 3] = a[:, 3] * b[:, 3] - np.einsum("ij,ij->i", a[:, :3], b[:, :3])
    return out


def yaw(pose):
    """Headings [rad] of poses (n, 7), within -pi … pi."""
    x, y, z, w = pose[:, 3:].T
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def planar_of(messages):
    """(x, y, yaw) of each geometry_msgs/Pose."""
    pairs = [(p.position, p.orientation) for p in messages]
    out = rows([(at.x, at.y, at.z, q.x, q.y, q.z, q.w) for at, q in pairs])
    return np.column_stack([out[:, :2], yaw(out)])
