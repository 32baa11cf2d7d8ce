# SPDX-License-Identifier: Apache-2.0
"""Grid maps, and what all formats share: names of files, errors, and what broken files lead to."""

import re
import time

import numpy as np
import pytest

from warehouse_layout import convert as formats
from warehouse_layout.convert import FormatError
from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import lines_of

LEAGUE = """type octile
height 8
width 12
map
@@@@@@@@@@@@
@..........@
@.SSS.SSS.E@
@S@@@S@@@S.@
@S@@@S@TTS.@
@.SSS.SSS.E@
@..........@
@@@@@@@@@@@@
"""


@pytest.fixture
def write(tmp_path):
    def _write(text, name="a.map"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return _write


def test_a_map_of_the_league(write):
    file, notes = formats.read(write(LEAGUE))
    assert notes == [] and lines_of(file.floor) == [
        "############",
        "#..........#",
        "#.........B#",
        "#.sss.sss..#",
        "#.sss.sss..#",
        "#.........A#",
        "#..........#",
        "############",
    ]
    assert [(s.name, s.kind) for s in file.stations] == [("E1", "pick"), ("E2", "pick")]


def test_a_map_of_a_game(write):
    path = write("type octile\r\nheight 2\r\nwidth 7\r\nmap\r\n.G@OTSW\r\n.......\r\n")
    file, notes = formats.read(path)
    assert lines_of(file.floor) == ["..# #.x", "......."]
    assert notes == [
        "1 cell of swamp 'S' became floor",
        "1 cell of water 'W' became keep-out 'x'",
    ]


LAYOUT = """layout: 1
spacing: 1.2
floor: |
  #######
  #>>ss.#
  #.A=xp#
  #######
stations:
  A: {name: pick1}
robots: 1
"""


def test_a_map_is_written(write, tmp_path):
    notes = formats.convert(write(LAYOUT, "a.layout.yaml"), tmp_path / "b.map")
    assert (tmp_path / "b.map").read_text().splitlines() == [
        "type octile",
        "height 4",
        "width 7",
        "map",
        "@@@@@@@",
        "@..SS.@",
        "@.ETT.@",
        "@@@@@@@",
    ]
    assert notes == [
        "conveyor belt became obstacles at [3, 1]",
        "keep-out area became obstacles at [4, 1]",
        "parking became floor at [5, 1]",
        "directions of streets are lost at [1, 2], [2, 2]",
        "station pick1: its cell is an E; name, kind, lane and times are lost",
        "a map has no size: the spacing of 1.2 m is lost",
        "a map holds none of: robots, storage units",
    ]


def test_a_thousand_cells_square_take_seconds(write, tmp_path):
    rng = np.random.default_rng(1)
    grid = rng.choice(list(".@TSE"), p=[0.7, 0.1, 0.1, 0.0999, 0.0001], size=(1000, 1000))
    lines = "\n".join("".join(row) for row in grid)
    path = write(f"type octile\nheight 1000\nwidth 1000\nmap\n{lines}\n")
    begin = time.monotonic()
    formats.convert(path, tmp_path / "b.layout.yaml")
    formats.convert(tmp_path / "b.layout.yaml", tmp_path / "c.map")
    assert time.monotonic() - begin < 20
    there, _ = formats.read(tmp_path / "b.layout.yaml")
    back, _ = formats.read(tmp_path / "c.map")
    assert (there.floor == back.floor).mean() > 0.99


@pytest.mark.parametrize(
    "text, message",
    [
        (LEAGUE.replace("height 8", "height 9"), "8 lines of map; height says 9"),
        (LEAGUE.replace("height 8", "height 7"), ":12: a line after the map's 7"),
        (LEAGUE.replace("width 12", "width x"), "width is 'x'; a whole number above 0"),
        (LEAGUE.replace("width 12", "width -3"), "width is '-3'"),
        (LEAGUE.replace("width 12", "width 9999999"), "4000000 at most were expected"),
        (LEAGUE.replace("width 12\n", ""), "width is ''"),
        (LEAGUE.replace("map\n", ""), ":4: '@@@@@@@@@@@@'; type, height, width, map were expected"),
        (LEAGUE.replace(".E@", "E@", 1), ":7: 11 cells; width says 12"),
        (LEAGUE.replace("TT", "T?"), r":9:9: '\?' is not a cell of a map"),
        ("", ":1: no map"),
        (b"\xff\xfe\x00", "byte 0 is not text in UTF-8"),
    ],
)
def test_a_wrong_map_is_reported(write, text, message):
    path = write(text)
    with pytest.raises(FormatError, match=message) as error:
        formats.read(path)
    assert str(error.value).startswith(str(path))


def test_names_of_files_tell_the_format(write, tmp_path):
    path = write(LAYOUT, "a.layout.yaml")
    with pytest.raises(FormatError, match="no format that can be written: known are .layout.yaml"):
        formats.convert(path, tmp_path / "a.dxf")
    with pytest.raises(FormatError, match="no format that can be read: known are .layout.yaml, "):
        formats.convert(write("<svg/>", "a.svg"), tmp_path / "b.map")
    with pytest.raises(FormatError, match="none.svg: No such file or directory"):
        formats.convert(tmp_path / "none.svg", tmp_path / "b.map")
    with pytest.raises(FormatError, match="none.map: No such file or directory"):
        formats.convert(tmp_path / "none.map", tmp_path / "b.map")
    with pytest.raises(FormatError, match="b.map: No such file or directory"):
        formats.convert(path, tmp_path / "none" / "b.map")
    wrong = write(LAYOUT.replace("floor", "flor"), "b.layout.yaml")
    with pytest.raises(FormatError, match="b.layout.yaml:3:1: 'flor' is not a key"):
        formats.convert(wrong, tmp_path / "b.map")


def test_a_layout_stays_as_it_is(write, tmp_path):
    notes = formats.convert(write(LAYOUT, "a.layout.yaml"), tmp_path / "b.layout.yaml")
    before, after = (layout_file.read(tmp_path / n) for n in ("a.layout.yaml", "b.layout.yaml"))
    assert notes == [] and (before.floor == after.floor).all()
    assert before.stations == after.stations


@pytest.mark.parametrize(
    "suffix", [".xinst", ".xlayo", ".map", ".yaml", ".lif.json", ".dxf", ".layout.yaml"]
)
def test_nothing_but_a_format_error_comes_of_rubbish(write, suffix):
    rng = np.random.default_rng(7)
    rubbish = [
        b"",
        b"\0" * 50,
        b"<a>",
        b"{}",
        b"[]",
        b"- 1",
        b"image: 7",
        b"0\nSECTION\n",
        b"\x89PNG",
    ]
    rubbish += [rng.bytes(int(size)) for size in rng.integers(1, 400, 20)]
    for data in rubbish:
        with pytest.raises(FormatError) as error:
            formats.read(write(data, f"rubbish{suffix}"))
        assert "rubbish" in str(error.value) and "\n" not in str(error.value)


XLAYO = "<LayoutConfiguration><BotCount>3</BotCount><WidthHall>6</WidthHall></LayoutConfiguration>"
XINST = """<Instance Name="tiny"><Bots><Bot ID="0" X="0.5" Y="0.5"/></Bots><Waypoints>
<Waypoint ID="0" X="0.5" Y="0.5"><Paths><Waypoint>1</Waypoint></Paths></Waypoint>
<Waypoint ID="1" X="1.5" Y="0.5"><Paths><Waypoint>0</Waypoint></Paths></Waypoint>
</Waypoints></Instance>"""
LIF = """{"layouts": [{"layoutId": "L", "nodes": [
{"nodeId": "a", "nodePosition": {"x": 1.5, "y": 2}},
{"nodeId": "b", "nodePosition": {"x": 2.5, "y": 2}}],
"edges": [{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b"}]}]}"""
WHOLE = {
    ".map": LEAGUE,
    ".layout.yaml": LAYOUT,
    ".xlayo": XLAYO,
    ".xinst": XINST,
    ".lif.json": LIF,
}
NUMBERS = ("nan", "-1", "0", "1e308", "99999999999", "", "true", "[", "<", '"')


@pytest.mark.parametrize("suffix", WHOLE)
def test_a_damaged_file_is_told_or_read(write, tmp_path, suffix):
    """Cut short, or with another value in the place of a number."""
    text = WHOLE[suffix]
    formats.read(write(text, f"a{suffix}"))
    damaged = [text[: int(len(text) * share)] for share in np.linspace(0.05, 0.99, 20)]
    for number in re.finditer(r"\d+(\.\d+)?", text):
        damaged += [text[: number.start()] + value + text[number.end() :] for value in NUMBERS]
    refused = 0
    for content in damaged:
        try:
            formats.convert(write(content, f"a{suffix}"), tmp_path / "b.layout.yaml")
            formats.read(tmp_path / "b.layout.yaml")
        except FormatError as error:
            refused += 1
            assert str(error).startswith(str(tmp_path / "a.")) and "\n" not in str(error)
    assert refused > len(damaged) / 4
