# SPDX-License-Identifier: Apache-2.0
"""Layout files: what is read is what was written, and errors name file, line and column."""

from dataclasses import fields

import numpy as np
import pytest

from warehouse_layout.file import layout_file as lf
from warehouse_layout.place import file_check

TEXT = """layout: 1
name: north hall
floor: |
  #####
  #pA.#
  #s..#
  #####
stations:
  A: {name: pick1, kind: pick, queue: [[1, 1]], exit: [[3, 2]]}
storage_units: 1
robots: 1
"""


def same(first, other):
    names = [f.name for f in fields(first) if f.name not in ("floor", "path")]
    equal = all(getattr(first, n) == getattr(other, n) for n in names)
    return equal and np.array_equal(first.floor, other.floor)


def test_columns_count_from_the_left_and_rows_from_the_bottom():
    file = lf.parse(TEXT)
    assert file.shape == (4, 5)
    assert (file.floor[1, 1], file.floor[2, 1], file.floor[2, 2]) == ("s", "p", "A")
    (station,) = file.stations
    assert (station.service, station.queue, station.exit) == ((2, 2), ((1, 1),), ((3, 2),))


def test_what_is_left_out_has_a_default():
    file = lf.parse("layout: 1\nfloor: |\n  ..\n")
    assert (file.spacing, file.storage_units, file.robots, file.items) == (1.0, 0.85, 0, 0)
    assert (file.stations, file.policies, file.stock) == ((), {}, "")


# The text is replaced once; the error begins with file, line and column.
WRONG = {
    "an unknown key": ("robots: 1", "robotz: 1", "11:1: 'robotz' is not a key of a layout file"),
    "a ragged line": ("  #s..#", "  #s.#", "6:7: this line of the drawing has 4 cells, the first"),
    "an unknown character": ("#s..#", "#s?.#", "6:5: '?' is not a cell of a drawing"),
    "a station not drawn": ("#pA.#", "#p..#", "9:3: station 'A' is not drawn"),
    "a station not told": ("  A: {", "  B: {", "9:3: station 'B' is not drawn"),
    "a letter without a station": ("#s..#", "#sB.#", "6:5: 'B' is drawn, but 'stations' has no"),
    "a letter drawn twice": ("#s..#", "#sA.#", "5:5: 'A' is drawn twice"),
    "a key twice": ("robots: 1", "name: x", "11:1: 'name' is there twice"),
    "a cell off the drawing": ("[[3, 2]]", "[[9, 2]]", "9:56: station 'A': exit: [9, 2] is off"),
    "a cell twice": ("[[3, 2]]", "[[3, 2], [3, 2]]", "9:64: station 'A': exit: [3, 2] is there"),
    "no cell": ("[[3, 2]]", "[[3]]", "9:56: station 'A': exit: a cell [column, row] was expected"),
    "an unknown kind": ("kind: pick", "kind: pack", "9:26: station 'A': kind is 'pack'; known:"),
    "an unknown key of a station": ("kind:", "kid:", "9:20: 'kid' is not a key of a station; did"),
    "another version": ("layout: 1", "layout: 2", "1:9: layout is 2; this reads version 1"),
    "a count below 0": ("robots: 1", "robots: -1", "11:9: robots is -1; a whole number"),
    "a share above 1": ("units: 1", "units: 1.5", "10:16: storage_units (a share) is 1.5"),
    "no YAML": ("robots: 1", "robots: [1", "12:1: is not YAML"),
}


@pytest.mark.parametrize("what", WRONG)
def test_an_error_names_file_line_and_column(what):
    before, after, message = WRONG[what]
    assert before in TEXT
    with pytest.raises(lf.LayoutFileError) as error:
        lf.parse(TEXT.replace(before, after, 1), "north.layout.yaml")
    text = str(error.value)
    assert text.startswith(f"north.layout.yaml:{message}")
    assert "\n" not in text


@pytest.mark.parametrize("what", ["floor", "layout"])
def test_what_every_file_needs_is_named(what):
    lines = TEXT.splitlines(keepends=True)
    text = "".join(lines[1:]) if what == "layout" else "".join(lines[:2] + lines[9:])
    with pytest.raises(lf.LayoutFileError, match=f"'{what}.*' is missing"):
        lf.parse(text)


@pytest.mark.parametrize("text", ["", "[]", "layout: 1\nfloor: 3\n", "layout: 1\nfloor: [a]\n"])
def test_what_is_no_layout_is_refused_in_one_sentence(text):
    with pytest.raises(lf.LayoutFileError) as error:
        lf.parse(text, "x.layout.yaml")
    assert str(error.value).startswith("x.layout.yaml")
    assert "\n" not in str(error.value)


RIDES = """layout: 1
floor: |
  #s.. ..s#
  #>.> ...A
stations:
  A: {name: pick1}
elevators:
  lift: {cells: [[2, 0], [6, 0]], seconds: 12}
  other lift: {cells: [[2, 1], [6, 1]], seconds: [[0, 9], [8, 0]]}
"""


def test_elevators():
    first, second = lf.parse(RIDES).elevators
    assert first == lf.ElevatorEntry("lift", ((2, 0), (6, 0)), 12.0)
    assert second.seconds == ((0, 9), (8, 0))
    assert lf.parse(lf.text_of(lf.parse(RIDES))).elevators == (first, second)
    assert list(first.of_plan(9).rides()) == [(2, 6, 12), (6, 2, 12)]
    assert list(second.of_plan(9).rides()) == [(11, 15, 9), (15, 11, 8)]
    for entry in (first, second):
        assert lf.ElevatorEntry.of_elevator(entry.of_plan(9), 9) == entry


@pytest.mark.parametrize(
    "before, after, message",
    [
        ("seconds: 12", "second: 12", "8:35: 'second' is not a key of an elevator; did you mean"),
        (", seconds: 12", "", "8:9: elevator 'lift': 'seconds' is missing"),
        ("seconds: 12", "seconds: -1", "8:44: elevator 'lift': seconds is -1; a number from 0 to"),
        ("[[0, 9], [8, 0]]", "[[0, 9]]", "9:50: elevator 'other lift': seconds: a number, or a"),
        ("[[0, 9], [8, 0]]", "[[0, 9], 8]", "9:50: elevator 'other lift': seconds: a number, or"),
        ("[[2, 0], [6, 0]]", "[[2, 0]]", "8:17: elevator 'lift': a cell on each of two tiers or"),
        ("[[2, 0], [6, 0]]", "[[2, 0], [4, 0]]", "8:17: elevator 'lift': [4, 0] is ' ', not a st"),
        ("[[2, 0], [6, 0]]", "[[1, 1], [6, 0]]", "8:17: elevator 'lift': [1, 1] is 's', not a st"),
        ("[[2, 1], [6, 1]]", "[[2, 1], [6, 0]]", "9:23: elevator 'other lift': [6, 0] is a cell"),
        ("other lift", "lift", "9:3: elevator 'lift' is there twice"),
    ],
)
def test_a_wrong_elevator_is_named(before, after, message):
    with pytest.raises(lf.LayoutFileError) as error:
        lf.parse(RIDES.replace(before, after, 1), "a.layout.yaml")
    assert str(error.value).startswith(f"a.layout.yaml:{message}")


CUTS = """layout: 1
floor: |
  ....#
  >..s.
  #.A..
stations:
  A: {name: pick1, queue: [[0, 1], [0, 2], [1, 2], [1, 1], [2, 1]], exit: [[3, 0]]}
"""
PAIRS = "short_cuts: [[[0, 1], [1, 1]], [[1, 0], [1, 1]], [[1, 0], [2, 0]]]"


def with_cuts(text):
    return CUTS.replace("exit: ", f"{text}, exit: ")


def test_short_cuts_of_a_queue():
    file = lf.parse(with_cuts(PAIRS))
    (station,) = file.stations
    assert station.short_cuts == (((0, 1), (1, 1)), ((1, 0), (1, 1)), ((1, 0), (2, 0)))
    assert lf.parse(lf.text_of(file)).stations == file.stations


@pytest.mark.parametrize(
    "after, message",
    [
        ("3", "a list of pairs of cells was expected"),
        ("[[[0, 1]]]", "two cells [column, row] beside each other were expected"),
        ("[[[0, 1], [2, 1]]]", "two cells [column, row] beside each other were expected"),
        ("[[[0, 1], [0, 2]]]", "from [0, 1] to [0, 2]; from a street, or a cell of the queue, to"),
        ("[[[2, 1], [1, 1]]]", "from [2, 1] to [1, 1]; from a street, or a cell of the queue, to"),
        ("[[[0, 0], [0, 1]]]", "from [0, 0] to [0, 1]; from a street, or a cell of the queue, to"),
        ("[[[3, 1], [2, 1]]]", "from [3, 1] to [2, 1]; from a street, or a cell of the queue, to"),
        ("[[[2, 0], [3, 0]]]", "from [2, 0] to [3, 0]; from a street, or a cell of the queue, to"),
    ],
)
def test_a_wrong_short_cut_is_named(after, message):
    with pytest.raises(lf.LayoutFileError) as error:
        lf.parse(with_cuts(f"short_cuts: {after}"), "a.layout.yaml")
    assert str(error.value).startswith("a.layout.yaml:7:")
    assert f"station 'A': short_cuts: {message}" in str(error.value)


FOUR = RIDES.replace("..s#", "..s# .. ..").replace("...A", "...A .. ..")


@pytest.mark.parametrize(
    "text, message",
    [
        (RIDES.replace("[6, 0]", "[3, 0]"), "elevator lift has two cells on one tier, [2, 0], [3"),
        (FOUR.replace("[[2, 1], [6, 1]]", "[[10, 0], [13, 0]]"), "elevators do not lead from each"),
    ],
)
def test_tiers_that_are_not_joined_are_faults(text, message):
    texts = [fault.text for fault in file_check.faults(lf.parse(text))]
    assert any(each.startswith(message) for each in texts)


def test_a_file_that_is_none_is_refused(tmp_path):
    with pytest.raises(lf.LayoutFileError, match="No such file"):
        lf.read(tmp_path / "no.layout.yaml")
    path = tmp_path / "binary.layout.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(lf.LayoutFileError, match="UTF-8"):
        lf.read(path)


@pytest.mark.parametrize("seed", range(20))
def test_what_was_written_is_read(tmp_path, seed):
    file = random_file(np.random.default_rng(seed))
    lf.write(file, tmp_path / "a.layout.yaml")
    assert same(file, lf.read(tmp_path / "a.layout.yaml"))


def random_file(rng):
    height, width = rng.integers(1, 12, 2)
    characters = [c for c in lf.CHARACTERS if c not in lf.SERVICE]
    floor = rng.choice(characters, (height, width)).astype("<U1")
    cells = [(int(c), int(r)) for r, c in rng.permutation(np.argwhere(floor != "?"))]
    stations = []
    for key, service in zip(("A", "B", "dock 1"), cells):
        if len(key) == 1:
            floor[service[1], service[0]] = key
        stations.append(lf.StationEntry(key, service, f"{key}: no. 1", queue=tuple(cells[3:5])))
    return lf.LayoutFile(
        floor=floor,
        name=str(rng.choice(["", "a: b", "1", "'#", "true"])),
        spacing=float(rng.choice([1.0, 0.5, 1.25])),
        stations=tuple(stations),
        storage_units=(0.25, 1.0, 3, tuple(cells[:4]))[rng.integers(4)],
        robots=(0, 4, tuple(cells[:2]))[rng.integers(3)],
        items=int(rng.integers(9)),
        policies={"batching": {"kind": "x", "most": 3}} if rng.random() < 0.5 else {},
        at=(1.0, -2.5) if rng.random() < 0.5 else None,
    )
