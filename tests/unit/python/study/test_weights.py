# SPDX-License-Identifier: Apache-2.0
"""Storage units weigh what lies on them, by the SKU master that a layout file names."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from kiva_plugin_cpp import World
from warehouse_layout.file import layout_file
from warehouse_layout.file.item_weights import EMPTY_KG
from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.generate import layout_choice
from warehouse_layout.models import world_export
from warehouse_layout.place import placement
from warehouse_operations.fleets import availability
from warehouse_operations.fleets.consumption import ITEM, UNIT
from warehouse_operations.fleets.loads import ITEM_KG
from warehouse_operations.runs.simulation import Description, open_operations

UNITS, BINS = 24, 12  # storage units of the layout, and bins on each, of SKUs of its own
SKUS = [f"sku-{i}" for i in range(1, UNITS * BINS + 1)]
WEIGHTS = {sku: 0.05 * (i % BINS + 1) for i, sku in enumerate(SKUS)}  # of a piece [kg]


def own_layout(folder, weights=None, pieces=20, robots=4):
    """A layout of `small` with a bin of each SKU; weights: by SKU, None: no master."""
    rows = [f"{sku},{pieces},{i // BINS + 1}" for i, sku in enumerate(SKUS)]
    (folder / "stock.csv").write_text("sku,quantity,storage_unit\n" + "\n".join(rows) + "\n")
    skus = ""
    if weights is not None:
        skus = "skus.csv"
        text = "".join(f"{sku},{weight}\n" for sku, weight in weights.items())
        (folder / skus).write_text(f"sku,weight_kg\n{text}")
    path = folder / "own.layout.yaml"
    small = replace(layout_choice.chosen("small"), storage_units=UNITS, robots=robots)
    layout_file.write(replace(small, items=0, stock="stock.csv", skus=skus), path)
    return path


def stock_masses(path):
    """The mass of the items on each unit by the files alone [kg]."""
    skus, stock = (
        list(csv.DictReader((path.parent / name).read_text().splitlines()))
        for name in ("skus.csv", "stock.csv")
    )
    weights = {row["sku"]: row["weight_kg"] for row in skus}
    masses = dict.fromkeys(range(1, UNITS + 1), 0.0)
    for row in stock:
        weight = weights.get(row["sku"])
        mass = float(weight) * int(row["quantity"]) if weight else ITEM.mass
        masses[int(row["storage_unit"])] += max(mass, EMPTY_KG)
    return masses


def test_the_master_is_named_by_the_layout(tmp_path):
    path = own_layout(tmp_path, WEIGHTS)
    file = layout_file.read(path)
    assert (file.stock, file.skus) == ("stock.csv", "skus.csv")
    assert layout_file.parse(layout_file.text_of(file), "x").skus == "skus.csv"
    assert "items: {stock: stock.csv, skus: skus.csv}" in path.read_text()


@pytest.mark.parametrize(
    ("skus", "fault"),
    [
        ("sku,weight_kg\nsku-1,heavy\n", "skus.csv:2: column weight_kg is 'heavy'"),
        ("sku,weight_kg\nsku-1,-2\n", "skus.csv:2: column weight_kg is '-2'"),
        (None, "skus.csv: "),
    ],
)
def test_a_wrong_master_is_refused_with_its_line(tmp_path, skus, fault):
    path = own_layout(tmp_path, WEIGHTS)
    (tmp_path / "skus.csv").unlink()
    if skus:
        (tmp_path / "skus.csv").write_text(skus)
    with pytest.raises(LayoutFileError) as error:
        placement.place(layout_file.read(path))
    assert fault in str(error.value)


def test_a_master_without_a_stock_is_refused(tmp_path):
    text = own_layout(tmp_path, WEIGHTS).read_text().replace("stock: stock.csv, ", "")
    with pytest.raises(LayoutFileError, match="`stock` was expected beside it"):
        layout_file.parse(text, "x")


def test_the_worlds_units_weigh_the_sum(tmp_path):
    world = World.layout(
        own_layout(tmp_path, {sku: w for sku, w in WEIGHTS.items() if sku != "sku-3"})
    )
    expected = stock_masses(tmp_path / "own.layout.yaml")
    masses = dict(zip(world.storage_units["shelf_id"].tolist(), world.storage_units["mass"]))
    assert masses == pytest.approx({unit: UNIT.mass + kg for unit, kg in expected.items()})
    assert set(np.round(world.items["mass"], 6)) == {
        *(round(20 * weight, 6) for sku, weight in WEIGHTS.items() if sku != "sku-3"),
        ITEM.mass,  # of sku-3, whose weight is unknown
    }
    assert ITEM.mass == ITEM_KG


def test_without_a_master_items_weigh_as_their_model(tmp_path):
    world = World.layout(own_layout(tmp_path))
    assert set(world.items["mass"]) == {ITEM.mass}


def test_an_exported_world_has_the_weights(tmp_path):
    file = layout_file.read(own_layout(tmp_path, WEIGHTS))
    world_export.write(file, tmp_path / "own.sdf")
    world = World(tmp_path / "own.sdf")
    assert world.items["mass"].sum() == pytest.approx(sum(stock_masses(file_path(file)).values()))


def file_path(file):
    return file.beside_file("own.layout.yaml")


def test_mass_changes_by_density():
    world = World.create(robots=1, shelves=1, items=2)
    before = world.storage_units["mass"][0]
    world.set_mass("item1", 40.0)
    assert world.storage_units["mass"][0] == pytest.approx(before + 40.0 - ITEM.mass)
    for name, mass, fault in (("none", 1.0, KeyError), ("item1", -1.0, ValueError)):
        with pytest.raises(fault):
            world.set_mass(name, mass)
    with pytest.raises(ValueError, match="not a model of one link"):
        world.set_mass("kiva1", 3.0)


def test_units_get_lighter_as_pieces_are_picked(tmp_path):
    path = own_layout(tmp_path, WEIGHTS)
    with open_operations(Description(layout=str(path), orders="fill", physics=True)) as ops:
        before = ops.fleet.world.storage_units["mass"].sum()
        ops.run(minutes=6)
        units = ops.fleet.world.storage_units
        expected = {
            unit: UNIT.mass + sum(max(b.quantity * WEIGHTS[b.sku], EMPTY_KG) for b in bins)
            for unit, bins in ops.shift.inventory.of_unit.items()
        }
        assert dict(zip(units["shelf_id"].tolist(), units["mass"])) == pytest.approx(expected)
        assert ops.shift.tally.items_picked > 0 and units["mass"].sum() < before
        assert ops.fleet.collisions == 0


def energy_used(folder, physics, weight):
    """Energy of a robot's motion in ten minutes without charging [Wh]. weight: of a piece [kg]."""
    path = own_layout(folder, dict.fromkeys(SKUS, weight))
    description = Description(
        layout=str(path), orders="fill", physics=physics, realism="typical", seconds=600.0,
        policies={"charging": {"name": "threshold", "low": 0.05, "high": 0.1}},
    )  # fmt: skip
    with open_operations(description) as ops:
        ops.step_until(1.0)
        if physics:
            charges = ops.fleet.robots.charge.copy()
        else:
            charges = np.full(4, 0.9)
            ops.fleet.set_charges(dict(enumerate(charges, start=1)))
        ops.step_until(600.0)
        used = float(np.mean(charges)) - ops.fleet.energy["charge_mean"]
        battery = availability.read("typical").energy
        return (used * battery.joules - 599.0 * battery.electronics) / 3600


@pytest.fixture(name="used", scope="module")
def _used(tmp_path_factory):
    """The energy of ideal and of simulated robots with light and with heavy pieces."""
    folder = tmp_path_factory.mktemp("weights")
    return {
        (physics, weight): energy_used(folder, physics, weight)
        for physics in (True, False)
        for weight in (0.02, 0.5, 1.5)
    }


@pytest.mark.parametrize("physics", [True, False])
def test_heavy_units_take_more_energy(used, physics):
    """360 kg of pieces instead of 5: a loaded robot has 565 kg instead of 210."""
    assert 1.5 * used[physics, 0.02] < used[physics, 1.5] < 2.7 * used[physics, 0.02]


@pytest.mark.parametrize("weight", [0.02, 0.5])
def test_ideal_robots_use_what_simulated_ones_do(used, weight):
    assert used[False, weight] == pytest.approx(used[True, weight], rel=0.07)
