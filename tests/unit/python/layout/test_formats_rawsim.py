# SPDX-License-Identifier: Apache-2.0
"""Instances and layout configurations of RAWSim-O become layout files."""

import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from instance_file import (
    write_configuration,
    write_hall_instance,
    write_instance,
    write_tiers_instance,
)

from warehouse_layout import convert as formats
from warehouse_layout.convert import FormatError
from warehouse_layout.convert.rawsim.instance import read_floor
from warehouse_layout.file import drawn_floor, layout_file, station_lanes
from warehouse_layout.place import file_check
from warehouse_layout.place.placement import plan_of


def key(station):
    return station.name, station.kind, station.service, station.cells.tolist(), station.short_cuts


def plan(file):
    drawn = drawn_floor.areas(file.floor)
    return plan_of(file, drawn, station_lanes.of_file(file, drawn)[0])


@pytest.mark.parametrize(
    "write, notes",
    [
        (write_instance, []),
        (lambda path: write_instance(path, spacing=1.04, old=True), []),
        (
            write_hall_instance,
            ["a layout does not say how robots move: MaxAcceleration 0.5, PodTransferTime 3"],
        ),
    ],
)
def test_an_instance(tmp_path, write, notes):
    """The drawing says for every cell by which headings it may be left, as the file does."""
    path = write(tmp_path / "a.xinst")
    instance = read_floor(path)
    layout = tmp_path / "a.layout.yaml"
    assert formats.convert(path, layout) == notes
    file = layout_file.read(layout)
    before, after = instance.plan, plan(file)
    for name in ("passable", "storage", "lane"):
        assert (getattr(before, name) == getattr(after, name)).all()
    assert (before.exits[~before.storage] == after.exits[~before.storage]).all()
    assert file_check.faults(file) == []
    assert file.spacing == pytest.approx(before.spacing, abs=1e-3)
    assert len(file.storage_units) == len(instance.units) and len(file.robots) == 16
    assert [key(s) for s in before.stations] == [key(s) for s in after.stations]
    pick = file.stations[0]
    assert pick.settings == {"capacity": 12, "seconds_a_piece": 10.0, "pick_seconds": 3.0}
    assert file.items == 5 * len(instance.units)


def test_tiers_and_elevators(tmp_path):
    """They lie side by side in a layout, which says where elevators lead, and survive a world."""
    layout, world = tmp_path / "a.layout.yaml", tmp_path / "a.sdf"
    assert formats.convert(write_tiers_instance(tmp_path / "a.xinst", tiers=3), layout) == []
    file = layout_file.read(layout)
    (elevator,) = file.elevators
    columns, rows = zip(*elevator.cells)
    assert elevator.seconds == 10 and columns == (6, 36, 66) and set(rows) == {22}
    drawn = plan(file)
    assert [int((drawn.tier == tier).sum()) for tier in range(-1, 3)][1:] == [455] * 3
    assert (drawn.tier[:, 27:30] == -1).all()
    assert file_check.faults(file) == []
    assert formats.convert(layout, world) == []
    assert formats.read(world)[0].elevators == file.elevators
    painted = re.sub(r"<(\w+:)?drawing.*?</(\w+:)?drawing>", "", world.read_text(), flags=re.S)
    assert len(painted) < len(world.read_text()) - 1000
    (tmp_path / "b.sdf").write_text(painted)
    assert formats.read(tmp_path / "b.sdf")[0].elevators == file.elevators
    (note,) = [n for n in formats.convert(layout, tmp_path / "a.map") if "elevator" in n]
    assert note == "elevators are left out, and tiers lie beside each other: elevator0"


def test_short_cuts_of_queues_are_kept(tmp_path):
    """A queue's last row is entered from the hall and from the deep end of the row before, in the
    plan of an instance, in its layout, and in a world made of that."""
    path, layout, world = (tmp_path / name for name in ("a.xinst", "a.layout.yaml", "a.sdf"))
    of_file = read_floor(write_hall_instance(path)).plan
    for station in of_file.stations:
        cells = station.cells.tolist()
        (_, first), (deep, last) = sorted(station.short_cuts, key=lambda cut: cut[0] in cells)
        assert [cells.index(cell) for cell in (first, deep, last)] == [8, 4, 11]
    formats.convert(path, layout)
    assert formats.convert(layout, world) == []
    read = formats.read(world)[0]
    file = layout_file.read(layout)
    assert [s.short_cuts for s in read.stations] == [s.short_cuts for s in file.stations]
    assert (plan(read).exits == plan(file).exits).all()


def test_ways_out_amid_a_lane_are_reported(tmp_path):
    path = write_hall_instance(tmp_path / "a.xinst")
    root = ElementTree.parse(path).getroot()
    waypoints = root.find("Waypoints")
    service = next(w for w in waypoints if w.get("OutputStation") == "0")
    behind = next(w for w in waypoints if service.get("ID") in [p.text for p in w.find("Paths")])
    ElementTree.SubElement(service.find("Paths"), "Waypoint").text = behind.get("ID")
    ElementTree.ElementTree(root).write(path)
    notes = formats.convert(path, tmp_path / "a.layout.yaml")
    assert any("a lane has one way out, and ways in from streets" in text for text in notes)


def test_a_station_without_a_queue_is_reported(tmp_path):
    path = write_instance(tmp_path / "a.xinst")
    text = re.sub(r"<Queues>\d+/\d+</Queues>", "", path.read_text())
    path.write_text(text.replace('IsQueueWaypoint="true"', 'IsQueueWaypoint="false"'))
    file, notes = formats.read(path)
    assert "station pick2 has no queue and no exit of its own" in notes
    assert [s.queue + s.exit for s in file.stations] == [()] * 4


@pytest.fixture
def write(tmp_path):
    return lambda **values: write_configuration(tmp_path / "a.xlayo", **values)


def test_a_configuration(write, tmp_path):
    """It makes the floor that an instance of those parameters has: with halls and buffers."""
    file, _ = formats.read(write())
    instance, _ = formats.read(write_hall_instance(tmp_path / "a.xinst"))
    assert (plan(file).exits == plan(instance).exits).all()
    lanes = [
        {(s.kind, s.queue, s.service, s.exit, frozenset(s.short_cuts)) for s in each.stations}
        for each in (file, instance)
    ]
    assert lanes[0] == lanes[1]
    assert (file.name, file.robots, file.storage_units) == ("1-2-2-8-0.85", 8, 170)
    assert file.stations[0].settings["capacity"] == 18


@pytest.mark.parametrize("counter_clockwise", ["true", "false"])
@pytest.mark.parametrize("kind", ["Tim", "HighwayHallway"])
@pytest.mark.parametrize("single", ["true", "false"])
@pytest.mark.parametrize("two_way", ["true", "false"])
def test_all_kinds_of_halls(write, counter_clockwise, kind, single, two_way):
    """A fleet can work in each, with stations on all sides, and all streets say where they lead."""
    path = write(
        AisleLayoutType=kind,
        SingleLane=single,
        AislesTwoDirectional=two_way,
        CounterClockwiseRingwayDirection=counter_clockwise,
        NPickStationNorth=1,
        NReplenishmentStationSouth=2,
    )
    file, notes = formats.read(path)
    if two_way == "false":
        assert notes == []
    assert all(len(s.short_cuts) == 2 for s in file.stations)
    assert len(file.stations) == 7
    # The halls' streets of the kind HighwayHallway and two-way aisles make no good floor there
    # either: they meet head-on.
    if (kind, two_way) != ("HighwayHallway", "true"):
        assert file_check.faults(file) == []
    assert np.count_nonzero(file.floor == "s") == 4 * 2 * 25


@pytest.mark.parametrize(
    "values, message",
    [
        ({"NrHorizontalAisles": 5}, "one-way aisles ask for even numbers"),
        ({"NrHorizontalAisles": "many"}, "NrHorizontalAisles is 'many'; a number from 2 to 10000"),
        ({"NrVerticalAisles": 1e9}, r"NrVerticalAisles is '1000000000.0'; a number"),
        ({"NrVerticalAisles": 9998, "NrHorizontalAisles": 9998}, "1 to 4000000 cells"),
        ({"WidthHall": 3}, "WidthHall is 3; an even number"),
        ({"WidthBuffer": 1}, "WidthBuffer is '1'; a number from 2"),
        ({"WidthBuffer": 2.5}, "WidthBuffer is '2.5'; a whole number"),
        ({"DistanceEntryExitStation": 7}, "an odd number up to 5 was expected"),
        ({"AisleLayoutType": "Star"}, "AisleLayoutType is 'Star'; Tim or HighwayHallway"),
        ({"SingleLane": "maybe"}, "SingleLane is 'maybe'; true or false"),
        ({"NPickStationEast": 3}, "3 stations East; there is room for 2"),
        ({"NPickStationEast": 0}, "a station to pick and one to replenish, or more"),
        ({"TierCount": 2}, "one tier was expected: save the instance"),
        ({"NElevatorsWest": 1}, "one tier was expected: save the instance"),
        ({"PodAmount": "nan"}, "PodAmount is 'nan'"),
    ],
)
def test_a_wrong_configuration_is_reported(write, values, message):
    path = write(**values)
    with pytest.raises(FormatError, match=message) as error:
        formats.read(path)
    assert str(error.value).startswith(str(path))
