# SPDX-License-Identifier: Apache-2.0
"""The check of a layout file: what robots may do on a drawing, and sentences about its faults."""

import time

import numpy as np
import pytest

from warehouse_layout import Floor, layout_faults
from warehouse_layout.file import drawn_floor
from warehouse_layout.file import layout_file as lf
from warehouse_layout.place import file_check


def drawn(*lines, stations="", more=""):
    floor = "".join(f"  {line}\n" for line in lines)
    text = f"layout: 1\nfloor: |2\n{floor}"
    return lf.parse(text + (f"stations:\n{stations}" if stations else "") + more)


def exits(*lines):
    floor = drawn(*lines).floor
    return drawn_floor.exits(floor, drawn_floor.areas(floor), [])[::-1]


def faults(*lines, **more):
    return file_check.faults(drawn(*lines, **more))


RIGHT, UP, LEFT, DOWN = 1, 2, 4, 8


def test_a_step_against_a_one_way_street_is_a_remark():
    for rows, step in (
        ((">..v", "^ssv", "^<<<"), "[2, 2] to [1, 2]"),
        ((">>>v", "^ssv", "^-<<"), "[0, 0] to [1, 0]"),
    ):
        file = drawn(*rows, more="robots: 0\n")
        assert file_check.faults(file) == []
        (remark,) = file_check.remarks(file)
        assert remark == (
            f"robots with bodies do not drive from {step}: they could only come back the same way"
            " there, against others"
        )
    for rows in ((">>>v", "^ssv", "^<<<"), ("....", ".ss.", "....")):
        assert file_check.remarks(drawn(*rows, more="robots: 0\n")) == []


def test_a_street_that_ends_is_a_fault_and_no_remark():
    file = drawn(">..v.", "^ssv#", "^<<<#", more="robots: 0\n")
    assert file_check.faults(file) and file_check.remarks(file) == []


def test_a_one_way_street_is_left_ahead_alone():
    assert exits(".>.")[0, 1] & (RIGHT | LEFT) == RIGHT
    assert exits(".<.")[0, 1] & (RIGHT | LEFT) == LEFT
    assert exits(".", "^", ".")[1, 0] & (UP | DOWN) == UP
    assert exits(".", "v", ".")[1, 0] & (UP | DOWN) == DOWN


def test_a_street_is_not_entered_against_its_direction():
    ways = exits(".<.")[0]
    assert not ways[0] & RIGHT
    assert ways[2] & LEFT


def test_places_beside_a_one_way_street_are_reached_from_it():
    assert exits("s", ">", "s")[1, 0] & (UP | DOWN) == UP | DOWN


def test_both_ways_along_an_axis_means_that_axis():
    assert exits("...", ".-.", "...")[1, 1] == RIGHT | LEFT
    assert exits("...", ".|.", "...")[1, 1] == UP | DOWN


def test_streets_cross_where_a_row_runs_through_a_column():
    ways = exits(".^.", ">^>", ".^.")
    assert ways[1, 1] & (RIGHT | UP) == RIGHT | UP
    assert not ways[1, 1] & (LEFT | DOWN)


def test_a_fleet_works_on_blocks_with_streets_around():
    assert faults(".....", ".sss.", ".....", more="robots: 1\n") == []


def test_no_street_is_a_fault():
    (fault,) = faults("ss", "ss", more="storage_units: 0\n")
    assert fault.text.startswith("there is no street for a loaded robot")


def test_a_blind_alley_is_named_with_its_cells():
    (fault,) = faults("....", "....", "#.##", "#.##")
    assert "can't pass each other" in fault.text
    assert set(fault.cells) == {(1, 0), (1, 1)}  # those to be closed
    assert "[1, 0]" in fault.text


def test_a_place_without_a_street_is_named():
    sentences = faults(".....", ".sss.", ".sss.", ".sss.", ".....")
    assert [fault.cells for fault in sentences] == [((2, 2),)]
    assert "storage places at [2, 2]" in sentences[0].text


def test_streets_that_only_lead_in_are_named():
    sentences = faults("...>..", "...>..")
    assert "can't get from the streets at [3, 0], [4, 0], [5, 0]" in sentences[0].text


def test_a_lane_that_does_not_join_is_named():
    lane = "  A: {name: pick1, queue: [[1, 1]], exit: [[4, 1]]}\n"
    sentences = faults(".....", "..A..", ".....", stations=lane)
    assert "the lane of station pick1: cells in a row, each but once" in sentences[0].text
    assert (4, 1) in sentences[0].cells


def test_two_stations_in_one_cell_are_named():
    lanes = (
        "  A: {name: pick1, queue: [[1, 1]], exit: [[3, 1]]}\n"
        "  B: {name: pick2, queue: [[3, 1], [3, 2]], exit: [[5, 2]]}\n"
    )
    sentences = faults(".......", "....B..", "..A....", ".......", stations=lanes)
    assert any("pick2 and pick1 share the cell [3, 1]" in fault.text for fault in sentences)


def test_a_station_without_room_says_so():
    sentences = faults("....", ".A..", "....", stations="  A: {name: pick1}\n")
    assert "station pick1 at [1, 1] has no room for a lane" in sentences[0].text


def test_a_station_without_a_drawn_lane_gets_one():
    rows = ["." * 14] * 9 + ["......A......."] + ["." * 14] * 4
    assert faults(*rows, stations="  A: {name: pick1}\n") == []


def test_more_robots_than_there_is_room_for_are_a_fault():
    (fault,) = faults("....", ".p..", "....", more="robots: 2\nstorage_units: 0\n")
    assert "2 robots, but there is room for 1" in fault.text


@pytest.mark.parametrize("kind", ["ring in a ring", "one way back and forth"])
def test_a_million_cells_are_checked_within_seconds(kind):
    size = 1000
    if kind == "ring in a ring":
        passable = np.ones((size, size), bool)
        passable[1:-1:2, 1:-1] = False
    else:  # the longest way there is, without a way round
        passable = np.zeros((size, size), bool)
        passable[::2] = passable[1::4, -1] = passable[3::4, 0] = True
    begin = time.monotonic()
    sentences = layout_faults(Floor(passable))
    assert time.monotonic() - begin < 10  # a search for each edge would take hours
    assert [name for name, _ in sentences] == (["dead end"] if "back" in kind else [])


def ways_round(passable, exits):
    """Yields each edge (from, to) between passable cells without another way back."""
    height, width = passable.shape
    steps = ((0, 1), (1, 0), (0, -1), (-1, 0))

    def after(cell):
        for heading, (dy, dx) in enumerate(steps):
            y, x = cell[0] + dy, cell[1] + dx
            inside = 0 <= y < height and 0 <= x < width
            if inside and passable[y, x] and exits[cell] >> heading & 1:
                yield y, x

    for start in map(tuple, np.argwhere(passable).tolist()):
        for end in after(start):
            reached = [end]
            for cell in reached:  # grows meanwhile
                reached += [
                    to for to in after(cell) if to not in reached and (cell, to) != (end, start)
                ]
            if start not in reached:
                yield start[0] * width + start[1], end[0] * width + end[1]


@pytest.mark.parametrize("seed", range(60))
def test_dead_ends_are_the_edges_without_another_way_back(seed):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 7, 2))
    passable = rng.random(shape) < 0.85
    exits = (rng.integers(0, 16, shape) | rng.integers(0, 16, shape)).astype(np.uint8)
    sentences = dict(layout_faults(Floor(passable, exits=exits))).get("dead end", [])
    pairs = set(zip(sentences[::2], sentences[1::2]))
    assert pairs == set(ways_round(passable, exits))


PARKING = """layout: 1
floor: |
  ................
  .pppp..ss.ss.ss.
  .pppp..ss.ss.ss.
  .pppp..ss.ss.ss.
  ................
  ................
  ....A...........
  ................
stations: {A: {queue: [[8, 1], [7, 1], [6, 1], [5, 1]], exit: [[3, 1]]}}
robots: 12
"""


def test_parking_may_be_several_deep_for_no_loaded_robot_goes_there():
    assert file_check.faults(lf.parse(PARKING)) == []


def test_parking_that_no_robot_reaches_is_reported():
    lines = PARKING.replace("  .pppp.", "  #pppp#").splitlines()
    lines[2] = lines[6] = "  ######.........."
    (fault,) = file_check.faults(lf.parse("\n".join(lines)))
    assert "parking" in fault.text and (2, 5) in fault.cells


POCKET = (
    ".......",
    ".sss.s.",
    ".sss.s.",
    ".......",
    "###..##",
    "###..##",
)


def test_streets_without_an_errand_are_named_to_be_closed():
    # Two cells deep, two wide: fine. One wide: loads that meet there can't pass each other.
    more = "storage_units: 4\nrobots: 1\n"
    assert faults(*POCKET, more=more) == []
    narrow = [line.replace("###..##", "###.###") for line in POCKET]
    (fault,) = faults(*narrow, more=more)
    assert fault.cells == ((3, 0), (3, 1))
    assert fault.text.endswith(
        "no storage place or station is served from there: draw 'x' in these"
    )
    closed = [line.replace("###.###", "###x###") for line in narrow]
    assert faults(*closed, more=more) == []
    # A storage place is served from there: closing it is no way out.
    narrow[-1] = "###s###"
    (fault,) = faults(*narrow, more=more)
    assert "join them into a ring" in fault.text


def test_stations_without_room_are_told_quickly_on_a_large_floor():
    """Streets a cell wide between blocks: every lane would cut others off."""
    floor = np.full((199, 401), "#")
    floor[::3, :] = floor[:, ::3] = "."
    services = [(column, row) for row in range(99, 120, 6) for column in range(100, 280, 12)]
    entries = "".join(
        f"  S{i}: {{name: S{i}, kind: pick, service: [{x}, {y}]}}\n"
        for i, (x, y) in enumerate(services)
    )
    lines = ["".join(line) for line in floor[::-1]]
    began = time.process_time()
    faults(*lines, more="storage_units: 0\n")
    once = time.process_time() - began
    sentences = faults(*lines, stations=entries, more="storage_units: 0\n")
    # Each station has some forty lanes to be tried: they are not checked on the whole floor each.
    assert time.process_time() - began < 50 * once
    assert (
        sum("has no room for a lane: a lane enters" in sentence.text for sentence in sentences)
        == 60
    )


def test_what_has_no_room_is_told_in_english():
    (fault, *_) = faults(
        ".....", ".....", "###A#", more="storage_units: 0\n",
        stations="  A: {name: pick1, kind: pick, queue: [[3, 1]]}\n",
    )  # fmt: skip
    assert "has no room for an exit" in fault.text
