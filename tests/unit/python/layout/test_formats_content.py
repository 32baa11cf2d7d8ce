# SPDX-License-Identifier: Apache-2.0
"""Formats are told apart by what files hold; grids of spreadsheets, and plant models of openTCS."""

import shutil

import pytest

from warehouse_layout import convert as formats
from warehouse_layout.convert import FormatError
from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import lines_of
from warehouse_layout.file.request import Request
from warehouse_layout.generate import generator

WRITTEN = [".layout.yaml", ".lif.json", ".sdf", ".map"]


@pytest.fixture
def drawn():
    return generator.of_request(Request(4, 24, 9, 2), "four")


@pytest.mark.parametrize("suffix", WRITTEN)
@pytest.mark.parametrize("name", ["a.json", "a.lif", "a.txt", "a.dxf", "a"])
def test_a_file_is_read_whatever_its_name(tmp_path, drawn, suffix, name):
    right = tmp_path / f"a{suffix}"
    formats.write(drawn, right)
    wrong = tmp_path / "other" / name
    wrong.parent.mkdir()
    shutil.copy(right, wrong)
    assert (formats.read(wrong)[0].floor == formats.read(right)[0].floor).all()


# --- grids

GRID = """#,#,#,#,#,#,#
#,,,,,,wall
#,s,storage,rack,,A,#
#,s,s,s,,,#
#,→,right,>,,pick 2,#
#,p,parking,charger,robot,x,#
#,#,#,#,#,#,#
"""
EXPECTED = [
    "#######",
    "#.....#",
    "#sss.A#",
    "#sss..#",
    "#>>>.B#",
    "#ppcpx#",
    "#######",
]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_grid_in_csv(tmp_path, separator):
    path = tmp_path / "hall.csv"
    path.write_text(GRID.replace(",", separator))
    file, notes = formats.read(path, spacing=1.2)
    assert notes == [] and lines_of(file.floor) == EXPECTED
    assert [(station.name, station.kind) for station in file.stations] == [
        ("A", "pick"),
        ("pick 2", "pick"),
    ]
    assert file.spacing == 1.2 and file.robots == 1


def test_a_grid_in_a_workbook(tmp_path):
    xlsxwriter = pytest.importorskip("xlsxwriter")
    path = tmp_path / "hall.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("north")
        book.add_worksheet("notes").write(0, 0, "not this one")
        for row, line in enumerate(GRID.splitlines()):
            for column, text in enumerate(line.split(",")):
                sheet.write(row + 1, column + 2, text)  # anywhere in the sheet
    assert lines_of(formats.read(path)[0].floor) == EXPECTED


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("#,#\n#,lift\n", "hall.csv: B2: 'lift' means nothing here"),
        ("wall\n", "no comma, semicolon or tab"),
        (",,\n", "a table of 0 x 0 cells"),
    ],
)
def test_a_wrong_grid_is_reported_with_its_address(tmp_path, text, message):
    path = tmp_path / "hall.csv"
    path.write_text(text)
    with pytest.raises(FormatError, match=message):
        formats.read(path)


def test_a_broken_workbook_is_reported(tmp_path):
    path = tmp_path / "hall.xlsx"
    path.write_bytes(b"PK\x03\x04 and nothing more")
    with pytest.raises(FormatError, match="hall.xlsx: the workbook can't be read"):
        formats.read(path)


# --- openTCS


def plant(axis="position{}", more=""):
    """A ring of streets around four storage places, a station and a place to park."""
    points, paths = {}, []
    for x in range(6):
        for y in range(5):
            if x in (0, 5) or y in (0, 4):
                points[f"P{x}{y}"] = (x, y, "HALT_POSITION")
    for x in range(1, 5):
        points[f"S{x}"] = (x, 1, "HALT_POSITION")
        paths.append((f"P{x}0", f"S{x}", 1000, 1000))
    points["PARK"] = (2, 3, "PARK_POSITION")
    paths.append(("P24", "PARK", 1000, 1000))
    ring = [(x, 0) for x in range(6)] + [(5, y) for y in range(1, 5)]
    ring += [(x, 4) for x in range(4, -1, -1)] + [(0, y) for y in range(3, 0, -1)]
    names = [f"P{x}{y}" for x, y in ring]
    paths += [(a, b, 1000, 0) for a, b in zip(names, names[1:] + names[:1])]
    ax, ay = axis.format("X"), axis.format("Y")
    if axis == "{}Position":
        ax, ay = "xPosition", "yPosition"
    lines = [
        f'<point name="{name}" {ax}="{1000 * x}" {ay}="{1000 * y}" type="{kind}"/>'
        for name, (x, y, kind) in points.items()
    ]
    lines += [
        f'<path name="{a} --- {b}" sourcePoint="{a}" destinationPoint="{b}" length="1000"'
        f' maxVelocity="{ahead}" maxReverseVelocity="{back}" locked="false"/>'
        for a, b, ahead, back in paths
    ]
    lines += ['<locationType name="Rack"><allowedOperation name="Load cargo"/></locationType>']
    lines += ['<locationType name="Workplace"><allowedOperation name="Serve"/></locationType>']
    lines += [
        f'<location name="Storage {x}" type="Rack"><link point="S{x}"/></location>'
        for x in range(1, 5)
    ]
    lines += ['<location name="Bench 1" type="Workplace"><link point="P52"/></location>']
    lines += ['<vehicle name="V1"/>', more]
    return f'<?xml version="1.0"?><model version="6.0.0" name="ring">{"".join(lines)}</model>'


@pytest.mark.parametrize("axis", ["position{}", "{}Position"])
def test_a_plant_model(tmp_path, axis):
    path = tmp_path / "plant.xml"
    path.write_text(plant(axis))
    file, notes = formats.read(path)
    assert file.name == "ring" and file.spacing == 1.0
    assert lines_of(file.floor)[0][1] == "<" and lines_of(file.floor)[-1][1] == ">"
    assert lines_of(file.floor)[3][:5] == "vssss"
    assert file.floor[3, 2] == "p"
    ((name, kind),) = [(station.name, station.kind) for station in file.stations]
    assert (name, kind) == ("Bench 1", "pick")
    assert notes[-1] == "1 vehicle: say in robots how many there are"
    layout_file.write(file, tmp_path / "a.layout.yaml")
    again = layout_file.read(tmp_path / "a.layout.yaml")
    assert (again.floor == file.floor).all() and again.stations == file.stations


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('<point name="P00" positionX="0" positionY="0"/>', "point 'P00' is there twice"),
        ('<point name="Q" positionX="far" positionY="0"/>', "positionX is 'far'; a number"),
        ('<path name="x" sourcePoint="Q" destinationPoint="P00"/>', "there is no point 'Q'"),
        ('<location name="L"><link point="Q"/></location>', "'L': there is no point 'Q'"),
        ("<point/>", "a point without a name"),
        ("<", r"plant.xml:\d+: "),
    ],
)
def test_a_wrong_plant_model_is_reported(tmp_path, more, message):
    path = tmp_path / "plant.xml"
    path.write_text(plant(more=more))
    with pytest.raises(FormatError, match=message):
        formats.read(path)
