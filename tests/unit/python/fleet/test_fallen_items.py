# SPDX-License-Identifier: Apache-2.0
"""Items that fell off their storage units: no robot drives there, and no piece is lost."""

import random

import numpy as np
import pytest
from operations_site import site
from test_failures import Fleet

from kiva_plugin_cpp import EventKind, World
from warehouse_operations import Operations
from warehouse_operations.reports.report import page
from warehouse_operations.runs.run_files import read, write
from warehouse_operations.store import check
from warehouse_operations.store.database import open_engine

FAST = 0.85, 1.0  # [m/s]: a unit that is stopped at once does not tip yet
LOOSE = {"item_friction_least": 0.03, "item_friction_most": 0.03, "pick_up_after": 0}
BAR = """<sdf version="1.9"><model name="bar"><static>true</static><link name="l">
<collision name="c"><pose>0 0 0.2 0 0 0</pose>
<geometry><box><size>0.05 0.9 0.4</size></box></geometry></collision></link></model></sdf>"""


def stop_one_at_once(fleet):
    """Something low stands right before a robot that brings a unit, until it has hit that."""
    robots, before = fleet.world.fleet, 0

    def faster():
        nonlocal before
        speed = np.hypot(robots.vx, robots.vy)
        full = np.isin(robots.shelf_id, fleet.world.items["shelf_id"])
        fits = full & (speed > FAST[0]) & (speed < FAST[1]) & (speed > before)
        before = speed
        return np.flatnonzero(fits).tolist()

    robot = fleet.until(faster)[0]
    ahead = np.array((robots.vx[robot], robots.vy[robot])) / before[robot]
    x, y = np.array((robots.x[robot], robots.y[robot])) + 0.428 * ahead
    fleet.world.spawn(BAR, place=(float(x), float(y), 0, float(robots.yaw[robot])))
    fleet.run(1.5)
    fleet.world.delete("bar")


def cells_of(fleet):
    fallen = fleet.world.fallen_items
    return {int(fleet.driver.plan.cell_of(x, y)) for x, y in zip(fallen["x"], fallen["y"])}


def test_cells_are_closed_while_items_lie_there():
    with Fleet("medium", loads=LOOSE) as fleet:
        fleet.run(20)
        stop_one_at_once(fleet)
        fallen = fleet.world.fallen_items.copy()
        assert len(fallen) >= 1
        fleet.run(3)
        lie = cells_of(fleet)
        assert lie <= set(fleet.traffic.closed.tolist())
        before = fleet.driver.collisions
        assert fleet.run(60) > 0  # the others work on
        assert lie <= set(fleet.traffic.closed.tolist())
        assert cells_of(fleet) == lie  # no robot has touched them
        assert fleet.driver.collisions == before
        for item in fallen["item_id"]:
            fleet.world.pick_up(f"item{item}")
        fleet.run(5)
        assert not len(fleet.world.fallen_items)
        assert not fleet.traffic.wants_map
        standing = set(fleet.traffic.robots.cell.tolist())
        assert not (lie - standing) & set(fleet.traffic.closed.tolist())
        home = dict(zip(fallen["item_id"], fallen["shelf_id"]))
        items = fleet.world.items
        assert {i: s for i, s in zip(items["item_id"], items["shelf_id"]) if i in home} == home


def test_what_can_not_be_picked_up_is_refused():
    world = World.preset("small", realism={"loads": True})
    for item in ("item1", "item999", "kiva1"):
        with pytest.raises(ValueError, match=f"no '{item}' has fallen"):
            world.pick_up(item)
    assert not len(world.fallen_items)
    assert EventKind.FELL == 13 and EventKind.PICKED_UP == 14


def test_pieces_on_the_floor_are_in_nobodys_stock(tmp_path):
    chance = random.Random(1)
    with Operations(site=site(), physics=False, database=tmp_path / "run.db", seed=1) as ops:
        inventory, items = ops.shift.inventory, [name for name, _ in ops.site.items]
        for _ in range(30):
            ops.run(minutes=1)
            ops.fleet.fallen_items = chance.sample(items, 40)
            ops.shift.fallen.update(ops.fleet.fallen_items)
            lie = [slot for slot in inventory.bins.values() if slot.fallen is not None]
            assert {slot.item for slot in lie} == set(ops.fleet.fallen_items)
            assert not any(slot.quantity or slot.reserved or slot.expected for slot in lie)
            assert not any(inventory.takes(slot, slot.sku, 1) for slot in lie)
            lines = [line for order in ops.shift.orders.values() for line in order.lines]
            reserved = sum(slot.reserved for slot in inventory.bins.values())
            assert reserved == sum(line.allotted for line in lines)
        figures = ops.kpis()
        assert figures["items_fallen"] > 40 and figures["items_on_floor"] == 40
        assert figures["pieces_on_floor"] == sum(slot.fallen for slot in lie) > 0
        pieces = inventory.total
        ops.fleet.fallen_items = ()
        ops.run(seconds=1e-3)
        assert inventory.total == pieces + figures["pieces_on_floor"]
        ops.run(minutes=10)
        assert ops.shift.tally.items_picked > 200
    assert check.faults(open_engine(tmp_path / "run.db")) == []


def test_a_shift_goes_on_with_what_lies_on_the_floor(tmp_path):
    def shift(**options):
        return Operations(
            site=site(), physics=False, database=tmp_path / "run.db", orders="none", **options
        )

    with shift() as ops:
        ops.fleet.fallen_items = [slot.item for slot in list(ops.shift.inventory.bins.values())[:9]]
        ops.run(seconds=1)
        pieces = ops.kpis()["pieces_on_floor"]
        total = ops.shift.inventory.total
        assert pieces > 0
    with shift() as ops:
        assert ops.kpis()["items_on_floor"] == 9
        assert (ops.kpis()["pieces_on_floor"], ops.shift.inventory.total) == (pieces, total)
        ops.run(seconds=1)  # nothing lies there any more
        assert ops.shift.inventory.total == total + pieces
    assert check.faults(open_engine(tmp_path / "run.db")) == []


def test_the_report_counts_them(tmp_path):
    with Operations(site=site(), physics=False, database=tmp_path / "run.db") as ops:
        ops.fleet.fallen_items = ["item1", "item2"]
        ops.run(minutes=2)
        write(tmp_path, ops, {"seconds": 120}, 1)
    text = page([read(tmp_path)])
    assert "Items that fell off their storage units" in text
