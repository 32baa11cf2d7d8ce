# SPDX-License-Identifier: Apache-2.0
"""Streets to which only a lane leads, or that lead only into one, are as sound as the lane."""

from operations_site import stock_faults

from warehouse_layout.file import layout_file
from warehouse_layout.place import file_check, placement
from warehouse_operations.runs.simulation import Description, open_operations

LAYOUT = """layout: 1
floor: |2
  ...............
  ..ssss..ssss...
  ..ssss..ssss...
  ...............
  ...............
  ..xxxxx..xxxx..
  ...A.>>..>.B...
stations:
  A: {name: pick1, queue: [[2, 0]], exit: [[4, 0]]}
  B: {name: refill, kind: replenish, queue: [[10, 0]], exit: [[12, 0]]}
storage_units: 14
robots: 5
items: 200
"""
AFTER, BEFORE = [(5, 0), (6, 0)], [(9, 0)]


def faults(text):
    return file_check.faults(layout_file.parse(text))


def ways(text):
    """Returns the cells of lanes that are not of a station, (column, row)."""
    plan = placement.place(layout_file.parse(text)).plan
    of_stations = {(c % plan.width, c // plan.width) for s in plan.stations for c in s.cells}
    cells = {(x, y) for y, row in enumerate(plan.lane) for x, lane in enumerate(row) if lane}
    return sorted(cells - of_stations)


def test_they_belong_to_the_lane():
    assert faults(LAYOUT) == []
    assert ways(LAYOUT) == [*AFTER, *BEFORE]


def test_a_place_there_is_cut_off():
    """No robot drives through the lane to bring a unit."""
    with_place = LAYOUT.replace("..xxxxx..xxxx..", "..xxxsx..xxxx..")
    assert any("the streets at [5, 0], [6, 0]" in fault.text for fault in faults(with_place))


def test_a_street_from_lane_to_lane_is_none():
    """Robots would drive through the next station."""
    joined = LAYOUT.replace("..xxxxx..xxxx..", "..xxxxxxxxxxx..").replace(".>>..>.B", ".>>>>>.B")
    assert any("[6, 0]" in fault.text for fault in faults(joined))


def test_streets_with_another_way_in_or_out_do_not():
    """Robots that go elsewhere drive there, too."""
    assert ways(LAYOUT.replace("..xxxxx..xxxx..", "..xxxx...xxxx..")) == [(5, 0), *BEFORE]
    assert ways(LAYOUT.replace("..xxxxx..xxxx..", "..xxxxx..^xxx..")) == AFTER


def test_a_shift(tmp_path):
    """Twenty minutes with bodies: no contact, no robot stuck, the stock balances."""
    (tmp_path / "a.layout.yaml").write_text(LAYOUT)
    description = Description(layout=str(tmp_path / "a.layout.yaml"), seed=3)
    with open_operations(description, str(tmp_path / "a.db")) as ops:
        ops.run(minutes=20)
        assert stock_faults(ops) == []
        figures = ops.kpis()
        assert [figures[name] for name in ("collisions", "blocked", "watchdog")] == [0, 0, 0]
        assert ops.fleet.stuck == 0 and ops.fleet.refusals == []
    assert figures["items_picked"] > 80 and figures["bundles_stored"] > 40
