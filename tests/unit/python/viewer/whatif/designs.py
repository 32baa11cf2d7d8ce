# SPDX-License-Identifier: Apache-2.0
"""A small building, day and costs, for searches that take seconds."""

import numpy as np

BUILDING = "36x26"
COSTS = "robot: {price: 20000}\nstation: {price: 40000}\nperson_hour: 28\ncurrency: EUR\n"
SETTINGS = {
    "building": BUILDING,
    "demand": "day.csv",
    "late": 0.05,
    "cpu_hours": 0.0002,
    "seed": 1,
    "physics_hours": 0.0,
}


def orders():
    """The text of a file of forty orders within an hour."""
    rng = np.random.default_rng(1)
    rows = [f"o{i},part-{rng.integers(12)},1,{rng.integers(3600)}," for i in range(40)]
    return "reference,sku,quantity,at,due\n" + "\n".join(rows) + "\n"
