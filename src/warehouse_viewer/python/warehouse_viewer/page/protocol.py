# SPDX-License-Identifier: Apache-2.0
"""What goes to the page in binary: little-endian, every number at a multiple of its size.

    u32 kind   1 = update
    u32 tick           of this update
    f64 stamp          simulated time [s]
    u32 revision       of the scene whose indices are used
    u32 n, m, k, s     rows of: robots, storage units, loose items, scenery
    rows               as ROBOT, BODY, BODY, BODY below; each begins with its u32 index

    u32 kind   2 = scan
    u32 kiva_id
    f32 angle_min, angle_increment [rad]
    f32 x, y, z [m], yaw [rad] of the laser on its robot
    f32 ranges [m]     to the end; infinity = no return

    u32 kind   3 = ways
    u32 n              rows of WAY below
    f32 x, y [m]       of the points of all in a row: released ones, planned ones, robot after robot

web/js/base/protocol.js reads it.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorPaths

VERSION = 4
UPDATE, SCAN, WAYS = 1, 2, 3

# x y [m] and yaw [rad] in world; the carried unit's number, 0 = none; activity as
# activities.activity() has it, state as in KivaStatus; charge in percent; failures as in
# FleetState, and its load_limit; 0 = none.
ROBOT = np.dtype(
    [
        ("index", "<u4"),
        ("x", "<f4"),
        ("y", "<f4"),
        ("yaw", "<f4"),
        ("shelf", "<i4"),
        ("activity", "u1"),
        ("state", "u1"),
        ("charge", "u1"),
        ("failures", "u1"),
        ("load_limit", "<f4"),
    ]
)
# x y z [m] qx qy qz qw in world; or, where a robot carries it, in that robot's frame.
BODY = np.dtype([("index", "<u4"), ("pose", "<f4", 7), ("carrier", "<i4")])
# Rows as in CoordinatorPaths; the goal is NaN where there is none.
WAY = np.dtype(
    [
        ("kiva_id", "<i4"),
        ("waits_for", "<i4"),
        ("released", "<u4"),
        ("planned", "<u4"),
        ("goal", "<f4", 2),
    ]
)

_UPDATE_HEAD = struct.Struct("<IIdIIIII4x")
_SCAN_HEAD = struct.Struct("<II2f4f")
_WAYS_HEAD = struct.Struct("<II")


def update(tick: int, stamp: float, revision: int, tables: Sequence[np.ndarray]) -> bytes:
    """Encodes an update; `tables` are four arrays of rows in the order above."""
    head = _UPDATE_HEAD.pack(UPDATE, tick, stamp, revision, *map(len, tables))
    return b"".join([head, *(rows.tobytes() for rows in tables)])


def scan(
    kiva_id: int,
    mount: Sequence[float],
    angle_min: float,
    angle_increment: float,
    ranges: Sequence[float],
) -> bytes:
    """Encodes a robot's scan; `mount` is (x, y, z [m], yaw [rad]) of the laser on it."""
    head = _SCAN_HEAD.pack(SCAN, kiva_id, angle_min, angle_increment, *mount)
    return head + np.asarray(ranges, "<f4").tobytes()


def ways(message: CoordinatorPaths, robots: Collection[int] | None = None) -> bytes:
    """Encodes a CoordinatorPaths of numpy arrays: all its robots, or those of the ids `wanted`."""
    ids = message.kiva_id
    kept = np.ones(len(ids), bool) if robots is None else np.isin(ids, list(robots))
    rows = np.zeros(np.count_nonzero(kept), WAY)
    for name in ("kiva_id", "waits_for", "released", "planned"):
        rows[name] = getattr(message, name)[kept]
    rows["goal"] = np.column_stack([message.goal_x, message.goal_y])[kept]
    points = np.repeat(kept, message.released + message.planned)
    xy = np.column_stack([message.x, message.y])[points].astype("<f4")
    return _WAYS_HEAD.pack(WAYS, len(rows)) + rows.tobytes() + xy.tobytes()
