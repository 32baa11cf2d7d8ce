# SPDX-License-Identifier: Apache-2.0
"""Drawings become floors: layers, blocks, outlines and lines, in the units of the drawing."""

import math

import ezdxf
import pytest

from warehouse_layout import convert as formats
from warehouse_layout.convert import FormatError
from warehouse_layout.file.layout_file import lines_of

FLOOR = [
    "##############",
    "#............#",
    "#.ssss.ssss..#",
    "#.ssss.ssss..#",
    "#............#",
    "#p.......A==.#",
    "#c...........#",
    "##############",
]


def drawing(names=str, unit=1000.0, insunits=4, turn=0.0):
    """A hall of 14 x 8 cells, drawn as architects do: walls as two lines, shelves as blocks."""
    document = ezdxf.new("R2010", setup=True)
    document.header["$INSUNITS"] = insunits
    space = document.modelspace()
    c, s = math.cos(turn), math.sin(turn)

    def at(x, y):
        return (unit * (c * x - s * y), unit * (s * x + c * y))

    def on(layer):
        return {"layer": names(layer)}

    def outline(points, layer, closed=True):
        space.add_lwpolyline([at(*p) for p in points], close=closed, dxfattribs=on(layer))

    outline([(0.3, 0.3), (13.7, 0.3), (13.7, 7.7), (0.3, 7.7)], "walls")
    for a, b in (((0.5, 0.5), (13.5, 0.5)), ((13.5, 0.5), (13.5, 7.5))):
        space.add_line(at(*a), at(*b), dxfattribs=on("walls"))
    shelf = document.blocks.new("SHELF")
    w = 0.45 * unit
    shelf.add_lwpolyline([(-w, -w), (w, -w), (w, w), (-w, w)], close=True)
    for x in range(2, 6):
        for y in (4, 5):
            space.add_blockref("SHELF", at(x + 0.5, y + 0.5), dxfattribs=on("storage"))
    outline([(7, 4), (11, 4), (11, 6), (7, 6)], "storage")
    space.add_point(at(1.5, 2.5), dxfattribs=on("parking"))
    space.add_circle(at(1.5, 1.5), 0.3 * unit, dxfattribs=on("charging"))
    station = document.blocks.new("STATION")
    station.add_circle((0, 0), 0.3 * unit)
    station.add_attdef("NAME", (0, 0))
    space.add_blockref("STATION", at(9.5, 2.5), dxfattribs=on("station")).add_auto_attribs(
        {"NAME": "Packing 1"}
    )
    space.add_line(at(10.2, 2.5), at(11.8, 2.5), dxfattribs=on("belt"))
    return document


@pytest.fixture
def path(tmp_path):
    return tmp_path / "hall.dxf"


@pytest.mark.parametrize("unit, insunits", [(1000.0, 4), (1.0, 6), (100.0, 5), (1 / 0.0254, 1)])
def test_a_hall(path, unit, insunits):
    drawing(unit=unit, insunits=insunits).saveas(path)
    file, notes = formats.read(path)
    assert lines_of(file.floor) == FLOOR and notes == []
    assert (file.name, file.stations[0].name, file.stations[0].kind) == (
        "hall",
        "Packing 1",
        "pick",
    )


@pytest.mark.parametrize("unit, name", [(1000.0, "millimetres"), (1.0, "metres")])
def test_a_drawing_that_lies_askew_and_names_no_unit(path, unit, name):
    drawing(turn=math.radians(3), insunits=0, unit=unit).saveas(path)
    file, notes = formats.read(path)
    assert notes == [
        f"$INSUNITS names no unit of length: {name} were assumed",
        "turned by -3.00 degrees",
    ]
    assert lines_of(file.floor) == FLOOR


def test_layers_of_ones_own(path, tmp_path):
    drawing(names=lambda name: f"A-{name}-NEW").saveas(path)
    with pytest.raises(FormatError, match="no layer is named as one of ours: walls, "):
        formats.read(path)
    layers = tmp_path / "layers.yaml"
    layers.write_text(
        "walls: A-walls-*\nstorage: [A-storage-NEW, other]\nstations: a station new\n"
        "parking: A-park*\ncharging: A-charg*\nbelts: A-BELT-NEW\n"
    )
    file, notes = formats.read(path, layers)
    assert lines_of(file.floor) == FLOOR and notes == []
    layers.write_text("walls: A-walls-*\nstorage: A-storage-NEW\n")
    _, notes = formats.read(path, layers)
    assert "layer 'A-parking-NEW': 1 POINT left out; --layers can say what it holds" in notes
    for text, message in (
        ("wals: A", "'wals' is not one of our names; did you mean 'walls'"),
        ("walls: {a: 1}", "walls is {'a': 1}; names of layers were expected"),
        ("walls: [", "layers.yaml:1: is not YAML"),
        ("[]", "our names with layers were expected"),
    ):
        layers.write_text(text)
        with pytest.raises(FormatError, match=message):
            formats.read(path, layers)


def test_a_block_of_everything_and_streets(path):
    """An architect's whole floor inserted as one block, on any layer; curves; one-way lines."""
    document = ezdxf.new("R2010")
    document.units = 6
    block = document.blocks.new("FLOOR1")
    block.add_lwpolyline(
        [(0.5, 0.5), (9.5, 0.5), (9.5, 5.5), (0.5, 5.5)], close=True, dxfattribs={"layer": "WALLS"}
    )
    block.add_hatch(dxfattribs={"layer": "pillars"}).paths.add_polyline_path(
        [(7, 3), (9, 3), (9, 5), (7, 5)], is_closed=True
    )
    block.add_lwpolyline([(1.5, 1.5), (5.5, 1.5), (5.5, 3.5)], dxfattribs={"layer": "one-way"})
    block.add_text("replenish here", dxfattribs={"layer": "replenish", "insert": (2.2, 3.2)})
    block.add_circle((2.5, 3.5), 0.4, dxfattribs={"layer": "replenish"})
    block.add_mtext("12 m", dxfattribs={"layer": "dimensions"})
    document.modelspace().add_blockref("FLOOR1", (100, 50), dxfattribs={"layer": "XREF"})
    document.saveas(path)
    file, notes = formats.read(path)
    assert notes == ["layer 'dimensions': 1 MTEXT left out; --layers can say what it holds"]
    assert lines_of(file.floor) == [
        "##########",
        "#......###",
        "#.A..^.###",
        "#....^...#",
        "#>>>>^...#",
        "##########",
    ]
    assert (file.stations[0].name, file.stations[0].kind) == ("replenish here", "replenish")


def test_walls_with_gaps(path):
    document = ezdxf.new("R2010")
    document.units = 6
    space = document.modelspace()
    for points in ([(0.5, 0.5), (6.5, 0.5)], [(0.5, 0.5), (0.5, 4.5)]):
        space.add_line(*points, dxfattribs={"layer": "walls"})
    space.add_point((3.5, 2.5), dxfattribs={"layer": "storage"})
    document.saveas(path)
    file, notes = formats.read(path)
    (note,) = notes
    assert note == "walls do not enclose all places: the floor is the rectangle about the drawing"
    assert lines_of(file.floor)[-1] == "#######" and file.floor[2, 3] == "s"


def test_what_is_wrong_is_reported(path):
    document = drawing()
    path.write_text("0\nSECTION\nthis is not a drawing")
    with pytest.raises(FormatError, match="hall.dxf: "):
        formats.read(path)
    space = document.modelspace()
    space.add_point((9500, 2500), dxfattribs={"layer": "station"})
    document.saveas(path)
    with pytest.raises(FormatError, match=r"two stations fall into one cell: \[9, 2\]"):
        formats.read(path)
    space.add_point((9e12, 0), dxfattribs={"layer": "storage"})
    document.saveas(path)
    with pytest.raises(FormatError, match=r"POINT \w+ is not within 1e\+06 m of the origin"):
        formats.read(path)
    with pytest.raises(FormatError, match="none.dxf: No such file"):
        formats.read(path.parent / "none.dxf")


def test_a_truncated_drawing_is_told_or_read(path):
    drawing().saveas(path)
    data = path.read_bytes()
    for share in (0.02, 0.3, 0.5, 0.8, 0.95):
        path.write_bytes(data[: int(share * len(data))])
        try:
            formats.read(path)
        except FormatError as error:
            assert str(error).startswith(str(path))


def test_layers_are_listed_with_what_is_on_them_and_a_proposal(path):
    own = {"walls": "A-WAND", "storage": "Regale", "station": "0-X", "parking": "AGV-PARK"}
    drawing(names=lambda name: own.get(name, "rest")).saveas(path)
    with pytest.raises(FormatError) as error:
        formats.read(path)
    text = str(error.value)
    assert "'A-WAND' (1 LWPOLYLINE, 2 LINE)" in text and "'Regale' (64 LWPOLYLINE" not in text
    assert "'walls: [A-WAND]'; 'storage: [Regale]'" in text and "parking: [AGV-PARK]" in text
    with pytest.raises(FormatError, match="its model space is empty"):
        ezdxf.new().saveas(path)
        formats.read(path)


def test_loose_lines_are_joined(path):
    """Shelves, a station and the floor as four lines each, drawn in any order and direction."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 6
    space = document.modelspace()

    def box(x, y, u, v, layer):
        corners = [(x, y), (u, y), (u, v), (x, v)]
        edges = list(zip(corners, corners[1:] + corners[:1]))
        edges[1], edges[3] = edges[3][::-1], edges[1]
        for a, b in edges:
            space.add_line(a, b, dxfattribs={"layer": layer})

    box(0, 0, 8, 5, "floor")
    box(1, 1, 5, 3, "storage")
    box(6.1, 1.1, 6.9, 1.9, "station")
    space.add_line((6.2, 4.5), (7.8, 4.5), dxfattribs={"layer": "belts"})
    document.saveas(path)
    file, notes = formats.read(path)
    assert notes == [] and lines_of(file.floor) == [
        "......==",
        "........",
        ".ssss...",
        ".ssss.A.",
        "........",
    ]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is not a DXF drawing: it is empty"),
        (b"AC1027" + bytes(99), "it is a DWG, which only CAD programs read; save it as DXF there"),
        (bytes(range(256)), "is not a DXF drawing: "),
    ],
    ids=["empty", "a DWG", "noise"],
)
def test_what_is_no_drawing_is_one_sentence(path, data, message):
    path.write_bytes(data)
    with pytest.raises(FormatError) as error:
        formats.read(path)
    assert message in str(error.value)
    assert "NoneType" not in str(error.value) and "attribute" not in str(error.value)
