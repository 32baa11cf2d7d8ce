# SPDX-License-Identifier: Apache-2.0
"""SKUs that are ordered together lie together, near the stations; what that gains is measured."""

import csv
import subprocess
from collections import Counter

import paths
import pytest

from warehouse_layout.file import sku_master
from warehouse_layout.file.sku_master import Sku, SkuMasterError
from warehouse_operations.slotting.proposal import Lot, Pairs, propose
from warehouse_operations.stock.order_file import OrderDraft

SLOT = paths.ROOT / "src" / "warehouse_operations" / "nodes" / "slot"
HEAD = "sku,weight_kg,length_m,width_m,height_m,pieces_a_bin,class\n"


def orders(*orders_of):
    return [OrderDraft(tuple((sku, 1) for sku in skus.split())) for skus in orders_of]


def units_of(slots):
    return {slot.sku: slot.unit for slot in slots}


def test_what_is_ordered_together_lies_together_and_the_most_ordered_nearest():
    pairs = Pairs.of(orders("a b", "a b", "a b", "c d", "c d", "e"))
    lots = [Lot(sku, 5) for sku in "edcba"]
    where = units_of(propose(lots, {7: 2, 8: 2, 9: 2}, [9, 7, 8], pairs, {}))
    assert where == {"a": 9, "b": 9, "c": 7, "d": 7, "e": 8}


def test_all_lots_have_a_bin_of_their_own():
    pairs = Pairs.of(orders("a b", "a b", "b c"))
    lots = [Lot("a", 3), Lot("a", 4), Lot("b", 1), Lot("c", 1)]
    slots = propose(lots, {1: 2, 2: 2}, [1, 2], pairs, {})
    assert Counter((slot.sku, slot.pieces) for slot in slots) == Counter(lots)
    assert Counter(slot.unit for slot in slots) == {1: 2, 2: 2}
    assert {slot.unit for slot in slots if slot.sku == "a"} == {1, 2}


def test_class_a_comes_first_and_weight_is_kept_within_what_robots_carry():
    skus = {"slow": Sku(class_="A"), "fast": Sku(class_="C"), "iron": Sku(weight=100.0)}
    pairs = Pairs.of(orders("fast", "fast", "slow"))
    where = units_of(propose([Lot("slow", 1), Lot("fast", 1)], {1: 1, 2: 1}, [1, 2], pairs, skus))
    assert where == {"slow": 1, "fast": 2}
    pairs = Pairs.of(orders("iron steel", "iron steel"))
    skus["steel"] = Sku(weight=100.0)
    slots = propose([Lot("iron", 3), Lot("steel", 3)], {1: 2, 2: 2}, [1, 2], pairs, skus)
    assert len(slots) == 2


def test_heavy_skus_are_spread_while_others_fit():
    skus = {name: Sku(weight=100.0) for name in ("iron", "steel")}
    pairs = Pairs.of(orders("iron steel", "iron steel", "tin"))
    lots = [Lot("iron", 3), Lot("steel", 3), Lot("tin", 3)]
    where = units_of(propose(lots, {1: 2, 2: 1}, [1, 2], pairs, skus))
    assert where == {"iron": 1, "tin": 1, "steel": 2}


def test_a_master_file(tmp_path):
    path = tmp_path / "skus.csv"
    path.write_text(f"{HEAD}bolt,0.02,0.1,0.075,0.06,,a\nnut,,,,,24,\n")
    assert sku_master.read(path) == {"bolt": Sku(0.02, 8, "A"), "nut": Sku(0.0, 24, "")}


@pytest.mark.parametrize(
    "row, text",
    [
        (",1,,,,,", "column sku is ''; a SKU of its own"),
        ("a,x,,,,,", "column weight_kg is 'x'; a number above 0"),
        ("a,,,,,1.5,", "column pieces_a_bin is '1.5'; 1 or more"),
        ("a,,,,,,D", "column class is 'D'; A, B or C"),
        ("a,,1,1,1,,", "no piece fits into a bin of 0.2 x 0.15 x 0.12 m"),
    ],
)
def test_a_wrong_master_file_is_refused_with_its_line(tmp_path, row, text):
    path = tmp_path / "skus.csv"
    path.write_text(f"{HEAD}nut,,,,,24,\n{row}\n")
    with pytest.raises(SkuMasterError) as error:
        sku_master.read(path)
    assert str(error.value).startswith(f"{path}:3: ") and text in str(error.value)


@pytest.fixture(scope="module")
def order_file(tmp_path_factory):
    """A catalogue of pairs: each order asks for both SKUs of one."""
    path = tmp_path_factory.mktemp("slot") / "orders.csv"
    rows = [
        f"order{n},{sku},1,{22 * n},{22 * n + 7200}"
        for n in range(160)
        for sku in (f"left{n // 2 % 40}", f"right{n // 2 % 40}")
    ]
    path.write_text("reference,sku,quantity,at,due\n" + "\n".join(rows) + "\n")
    return path


def run(*arguments):
    return subprocess.run(
        ["/usr/bin/python3", SLOT, *map(str, arguments)],
        check=False,
        capture_output=True,
        text=True,
        timeout=300,
    )


def test_the_program_puts_pairs_together_and_goes_on(order_file, tmp_path):
    asked = [order_file, "--layout", "small", "--hours", "1", "--seeds", "3", "--out", tmp_path]
    first = run(*asked)
    assert first.returncode == 0, first.stderr
    rows = list(csv.DictReader((tmp_path / "stock.csv").open()))
    units = {}
    for row in rows:
        units.setdefault(row["sku"], set()).add(row["storage_unit"])
    together = sum(bool(units[f"left{n}"] & units[f"right{n}"]) for n in range(40))
    assert together >= 36
    assert "pieces a unit brought" in first.stdout and " ± " in first.stdout
    kept = (tmp_path / "trials.jsonl").read_text()
    assert run(*asked).stdout == first.stdout and (tmp_path / "trials.jsonl").read_text() == kept


def test_what_can_not_be_is_refused(order_file, tmp_path):
    result = run(order_file, "--layout", "small", "--seeds", "2", "--out", tmp_path)
    assert result.returncode == 2 and "three at least" in result.stderr
    skus = tmp_path / "skus.csv"
    skus.write_text("sku\n")
    result = run(order_file, "--layout", "small", "--skus", skus, "--out", tmp_path)
    assert result.returncode == 1 and "has no SKU" in result.stderr
