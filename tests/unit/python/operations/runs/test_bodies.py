# SPDX-License-Identifier: Apache-2.0
"""Instances whose streets lead where a robot with a body could only come back against others."""

import xml.etree.ElementTree as ElementTree

import pytest
from instance_file import write_instance
from operations_site import stock_faults

from warehouse_operations.runs.rawsim import InstanceError, read_instance
from warehouse_operations.runs.simulation import Description, open_operations, remarks


def instance(folder, *steps):
    """Returns an instance with paths added, each between columns and rows of its plan."""
    path = write_instance(folder / "a.xinst", bots=8)
    plan, tree = read_instance(path).plan, ElementTree.parse(path)
    waypoints = {
        plan.cell_of(float(w.get("X")), float(w.get("Y"))): w
        for w in tree.getroot().iter("Waypoint")
        if w.get("X")
    }
    for (x, y), (to_x, to_y) in steps:
        start, end = waypoints[y * plan.width + x], waypoints[to_y * plan.width + to_x]
        ElementTree.SubElement(start.find("Paths"), "Waypoint").text = end.get("ID")
    tree.write(path)
    return path


def corner(path):
    """Returns the cell (column, row) in which the lowest street ends: all robots go on upwards."""
    plan = read_instance(path).plan
    streets = plan.passable & ~plan.storage & ~plan.lane
    return int(streets[0].nonzero()[0].max()), 0


def test_a_step_against_a_street_is_left_out(tmp_path):
    """A quarter of an hour with bodies: no contact, no robot stuck, the stock balances."""
    x, y = corner(write_instance(tmp_path / "a.xinst"))
    path = instance(tmp_path, ((x, y + 1), (x, y)))
    description = Description(instance=str(path), seed=3)
    (remark,) = [text for text in remarks(description) if "with bodies" in text]
    assert f"do not drive from ({x}.5, {y + 1}.5) to ({x}.5, {y}.5): they could only" in remark
    with open_operations(description, str(tmp_path / "a.db")) as ops:
        assert not ops.site.plan.exits[y + 1, x] & 8
        ops.run(minutes=15)
        assert stock_faults(ops) == []
        figures = ops.kpis()
        assert [figures[name] for name in ("collisions", "blocked", "watchdog")] == [0, 0, 0]
        assert ops.fleet.stuck == 0 and figures["items_picked"] > 100
    with open_operations(Description(instance=str(path), physics=False)) as ops:
        assert ops.site.plan.exits[y + 1, x] & 8, "ideal robots pass through each other"
    assert remarks(Description(instance=str(path), physics=False)) == []


def test_a_street_for_both_directions_that_ends_is_refused(tmp_path):
    """Ideal robots work there."""
    path = write_instance(tmp_path / "a.xinst", bots=8)
    tree = ElementTree.parse(path)
    x, y = corner(path)
    waypoints = tree.getroot().find("Waypoints")
    (end,) = (w for w in waypoints if (w.get("X"), w.get("Y")) == (f"{x}.5000", f"{y}.5000"))
    number = str(len(waypoints))
    beyond = ElementTree.SubElement(waypoints, "Waypoint", end.attrib | {"ID": number})
    beyond.set("Y", f"{y - 0.5:.4f}")
    for start, to in ((end, number), (beyond, end.get("ID"))):
        paths = start.find("Paths")
        paths = ElementTree.SubElement(start, "Paths") if paths is None else paths
        ElementTree.SubElement(paths, "Waypoint").text = to
    tree.write(path)
    with pytest.raises(InstanceError, match="not pass each other.*; simulate without physics"):
        open_operations(Description(instance=str(path)))
    (remark,) = remarks(Description(instance=str(path), physics=False))
    assert remark.endswith("ideal robots, which pass through each other, work there")
