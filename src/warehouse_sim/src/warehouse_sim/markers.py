# SPDX-License-Identifier: Apache-2.0
"""The warehouse as RViz shows it. Sizes as in worlds/models [m]."""

import numpy as np

from warehouse_msgs.msg import KivaStatus
from warehouse_sim import items, shapes

# Idle, busy, blocked: from the palette of Okabe and Ito (2008), told apart by everyone.
STATUS_COLOURS = np.zeros((3, 4))
STATUS_COLOURS[KivaStatus.STATUS_IDLE] = (0.00, 0.45, 0.70, 1)
STATUS_COLOURS[KivaStatus.STATUS_BUSY] = (0.94, 0.89, 0.26, 1)
STATUS_COLOURS[KivaStatus.STATUS_BLOCKED] = (0.84, 0.37, 0.00, 1)

FLOOR = (0.82, 0.83, 0.84, 1)
GRID = (0.70, 0.71, 0.73, 1)
POST = (0.36, 0.42, 0.50, 1)
BOARD = (0.87, 0.76, 0.52, 1)
ITEM = (0.62, 0.44, 0.26, 1)
DARK = (0.18, 0.18, 0.20, 1)
METAL = (0.60, 0.61, 0.63, 1)
WHITE = (0.97, 0.97, 0.97, 1)
BELT = (0.13, 0.13, 0.14, 1)
FRAME = (0.20, 0.35, 0.55, 1)
OTHER = (0.80, 0.47, 0.65, 1)

TOWER_LIFT = 0.10
BOARD_SIZE, BOARD_DEPTH = (0.79, 0.79, 0.03), 0.015
POST_SIZE, CORNERS = (0.04, 0.04, 1.80), (-0.38, 0.38)
ITEM_SIZE, ACROSS_SIZE = (0.20, 0.15, 0.12), (0.15, 0.20, 0.12)
ARROW = np.array([(0.33, 0, 0.366), (0.10, 0.20, 0.366), (0.10, -0.20, 0.366)])


def floor(bounds):
    """A slab and the borders of the cells; bounds are min_x, max_x, min_y, max_y."""
    x0, x1, y0, y1 = bounds
    slab = ((0, 0, -0.03), (x1 - x0, y1 - y0, 0.05), FLOOR)
    centre = np.array([[(x0 + x1) / 2, (y0 + y1) / 2, 0, 0]])
    xs, ys = np.arange(x0, x1 + 0.5), np.arange(y0, y1 + 0.5)
    along_y = [(x, y, 0.0) for x in xs for y in (y0, y1)]
    along_x = [(x, y, 0.0) for y in ys for x in (x0, x1)]
    return [_solid("floor", centre, [slab]), shapes.lines("grid", along_y + along_x, 0.02, GRID)]


def _solid(name, poses, boxes):
    """One marker of things at `poses` (n, 4), all made of the same boxes (centre, size, colour)."""
    return _joined(name, [(shapes.boxes(poses, at, size), colour) for at, size, colour in boxes])


def _joined(name, parts):
    """One marker from parts: triangles (n, m, 3), and a colour for all or for each of the n."""
    points = [p.reshape(-1, 3) for p, _ in parts]
    colours = [np.repeat(np.broadcast_to(c, (len(p), 4)), p.shape[1], axis=0) for p, c in parts]
    return shapes.triangles(name, np.concatenate(points), np.concatenate(colours))


def robots(poses, status, loaded):
    """(n, 3) x y yaw, KivaStatus.status and whether it carries, of each robot."""
    at = np.insert(poses, 2, 0.0, axis=1)
    tower = at + np.outer(loaded, (0, 0, TOWER_LIFT, 0))
    parts = [
        (shapes.boxes(at, (0, 0, 0.11), (0.76, 0.64, 0.16)), DARK),
        (shapes.boxes(at, (0, 0, 0.27), (0.76, 0.64, 0.18)), STATUS_COLOURS[status]),
        (shapes.boxes(tower, (-0.08, 0, 0.37), (0.36, 0.36, 0.06)), METAL),
        (shapes.placed(at, ARROW), WHITE),
    ]
    return [_joined("robots", parts)]


def straight_units(poses):
    """(n, 4) x y z yaw, of units in line with the axes: their footprint is a square."""
    at = poses[:, None, :3]
    boards = at + [(0, 0, z - BOARD_DEPTH) for z in items.BOARDS]
    posts = at + [(x, y, 0.9) for x in CORNERS for y in CORNERS]
    return [
        shapes.cubes("boards", boards.reshape(-1, 3), BOARD_SIZE, BOARD),
        shapes.cubes("posts", posts.reshape(-1, 3), POST_SIZE, POST),
    ]


def turned_units(poses):
    """(n, 4) x y z yaw, of units at any angle."""
    boards = [((0, 0, z - BOARD_DEPTH), BOARD_SIZE, BOARD) for z in items.BOARDS]
    posts = [((x, y, 0.9), POST_SIZE, POST) for x in CORNERS for y in CORNERS]
    return [_solid("turned units", poses, boards + posts)]


def straight_items(poses):
    """(n, 4) x y z yaw, of items in line with the axes."""
    centres = poses[:, :3] + (0, 0, ITEM_SIZE[2] / 2)
    across = np.abs(np.sin(poses[:, 3])) > 0.7
    return [
        shapes.cubes("items", centres[~across], ITEM_SIZE, ITEM),
        shapes.cubes("items across", centres[across], ACROSS_SIZE, ITEM),
    ]


def turned_items(poses):
    """(n, 4) x y z yaw, of items at any angle."""
    return [_solid("turned items", poses, [((0, 0, ITEM_SIZE[2] / 2), ITEM_SIZE, ITEM)])]


def belts(poses):
    """(n, 3) x y yaw."""
    boxes = [
        ((0, 0, 0.25), (1.5, 0.5, 0.5), FRAME),
        ((0, 0, 0.55), (1.8, 0.7, 0.06), BELT),
        ((0, 0.38, 0.53), (1.8, 0.04, 0.14), METAL),
        ((0, -0.38, 0.53), (1.8, 0.04, 0.14), METAL),
    ]
    return [_solid("belts", np.insert(poses, 2, 0.0, axis=1), boxes)]


def others(models):
    """Walls and persons, and a small cube for whatever else there is: {name: (x, y, yaw)}."""
    boxes = {"wall": (1.0, 0.2, 1.5), "person": (0.4, 0.4, 1.75), "other": (0.4, 0.4, 0.4)}
    out = []
    for kind, (length, width, height) in boxes.items():
        at = [(x, y, 0, yaw) for name, (x, y, yaw) in models.items() if _kind(name) == kind]
        box = ((0, 0, height / 2), (length, width, height), OTHER)
        out.append(_solid(kind, np.reshape(at, (-1, 4)), [box]))
    return out


def _kind(name):
    kind = name.rstrip("0123456789")
    return kind if kind in ("wall", "person") else "other"
