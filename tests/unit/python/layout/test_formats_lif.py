# SPDX-License-Identifier: Apache-2.0
"""Layouts of VDMA's LIF become floors, and floors become such layouts."""

import copy
import json

import pytest

from warehouse_layout import convert as formats
from warehouse_layout.convert import FormatError
from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file.layout_file import lines_of
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator
from warehouse_layout.place import file_check
from warehouse_layout.place.placement import plan_of


def plan(file):
    drawn = drawn_floor.areas(file.floor)
    return plan_of(file, drawn, station_lanes.of_file(file, drawn)[0])


@pytest.mark.parametrize("preset", ["small", "medium"])
def test_there_and_back(tmp_path, preset):
    """Cells, directions, stations and lanes stay what they were; the rest is told."""
    file = generator.of_request(PRESETS[preset], preset)
    notes = formats.write(file, tmp_path / "a.lif.json")
    assert [text.split(":")[0] for text in notes] == [
        "LIF has no conveyor belts",
        "LIF holds none of",
    ]
    back, notes = formats.read(tmp_path / "a.lif.json")
    assert notes == [] and file_check.faults(back) == [] and back.name == preset
    before, after = plan(file), plan(back)
    width = after.shape[1]  # the belts beyond are lost
    assert after.point_of(0) == before.point_of(0)
    for name in ("exits", "passable", "storage", "parking"):
        assert (getattr(before, name)[:, :width] == getattr(after, name)).all()
    assert {(s.name, s.kind, s.queue, s.service, s.exit) for s in back.stations} == {
        (s.name, s.kind, s.queue, s.service, s.exit) for s in file.stations
    }


def node(number, x, y, *actions, **more):
    types = {"vehicleTypeId": "ACME.Mouse"}
    if actions:
        types["actions"] = [{"actionType": a, "blockingType": "HARD"} for a in actions]
    position = {"x": x, "y": y}
    return {
        "nodeId": number,
        "nodePosition": position,
        "vehicleTypeNodeProperties": [types],
        **more,
    }


def edges(*pairs, **more):
    types = [{"vehicleTypeId": "ACME.Mouse", "rotationAllowed": False, **more}]
    return [
        {"edgeId": f"E{a}{b}", "startNodeId": a, "endNodeId": b, "vehicleTypeEdgeProperties": types}
        for a, b in pairs
    ]


def lif():
    """A ring of 4 x 2 steps of 1.4 m with a rack, a charger and two stations, as an integrator's.

    Its longest edges have no nodes between their ends; its nodes are centimetres off.
    """
    s = 1.4
    nodes = [
        node("N1", 0, 0),
        node("N2", 4 * s + 0.02, -0.01),
        node("N3", 4 * s, 2 * s),
        node("N4", 0, 2 * s + 0.02),
        node("N5", s, 2 * s),
        node("R1", s, s, "pick", "drop"),
        node("C1", -s, 0, "startCharging", "stopCharging"),
        node("W1", 5 * s, 2 * s, "pick", "drop"),
        node("P1", -s, 2 * s, nodeName="Parking 1"),
    ]
    ring = [("N1", "N2"), ("N2", "N3"), ("N3", "N5"), ("N5", "N4"), ("N4", "N1")]
    ways = [("N5", "R1"), ("R1", "N5"), ("N1", "C1"), ("C1", "N1"), ("N3", "W1"), ("W1", "N3")]
    ways += [("N4", "P1"), ("P1", "N4")]
    return {
        "metaInformation": {
            "projectIdentification": "hall",
            "creator": "ACME",
            "exportTimestamp": "2024-03-15T11:40:03.12Z",
            "lifVersion": "1.0.0",
        },
        "layouts": [
            {
                "layoutId": "L1",
                "layoutName": "hall 3",
                "layoutVersion": "1",
                "nodes": nodes,
                "edges": edges(*ring, maxSpeed=1.5) + edges(*ways),
                "stations": [
                    {
                        "stationId": "S1",
                        "interactionNodeIds": ["W1"],
                        "stationName": "goods in 1",
                        "stationHeight": 0.5,
                    },
                    {"stationId": "S2", "interactionNodeIds": ["C1"], "stationName": "loader"},
                ],
            }
        ],
    }


@pytest.fixture
def write(tmp_path):
    def _write(values):
        path = tmp_path / "hall.lif.json"
        path.write_text(values if isinstance(values, str) else json.dumps(values))
        return path

    return _write


def test_an_integrators_file(write):
    file, notes = formats.read(write(lif()))
    # The rack has one edge to it; here it is entered from all streets around.
    assert notes == [
        "2 cells may be left in more directions than before: [2, 0], [1, 1]",
        "a layout holds no maxSpeed: left out 5 times",
    ]
    assert (file.name, file.spacing) == ("hall 3", pytest.approx(1.4))
    drawn = lines_of(file.floor)
    assert (len(drawn[0]), len(drawn)) == (7, 3)
    assert file.floor[1, 2] == "s" and file.floor[0, 0] == "c" and file.floor[2, 0] == "p"
    station = file.stations[0]
    assert (station.name, station.kind, station.service) == ("goods in 1", "replenish", (6, 2))
    exits = plan(file).exits
    # The ring leads one way: east at the bottom, north, west at the top, south.
    assert [exits[0, 3], exits[1, 5], exits[2, 3], exits[1, 1] & 0b1010] == [1, 2, 4, 8]


def test_version_2(write):
    """Drafts of version 2 have layouts in origins, and other names of robots and actions."""
    old = lif()
    for node in old["layouts"][0]["nodes"]:
        types = node.pop("vehicleTypeNodeProperties")[0]
        robots = [{"manufacturer": "ACME", "seriesName": "Mouse"}]
        node["mobileRobotTypeNodeProperties"] = [
            {"mobileRobotTypes": robots, "feasibleActions": types.get("actions", [])}
        ]
    new = {"metaInformation": {}, "origins": [{"originId": "O", "layouts": old["layouts"]}]}
    expected, _ = formats.read(write(lif()))
    file, _ = formats.read(write(new))
    assert (file.floor == expected.floor).all()


def changed(**at):
    values = copy.deepcopy(lif())
    for place, value in at.items():
        *names, last = [int(n) if n.isdigit() else n for n in place.split("__")]
        inner = values["layouts"]
        for name in names:
            inner = inner[name]
        inner[last] = value
    return values


@pytest.mark.parametrize(
    "values, message",
    [
        ("[1, 2", r"hall.lif.json:1:6: is not JSON: Expecting ',' delimiter"),
        ("[1, 2]", r"is \[1, 2\]; an object was expected"),
        ('{"layouts": []}', "layouts is missing or empty"),
        ("[" * 100_000, "too large or too deep"),
        (
            changed(**{"0__nodes__3__nodePosition": {"x": float("nan"), "y": 0}}),
            r"nodes\[3\].nodePosition.x is NaN",
        ),
        (
            changed(**{"0__nodes__3__nodePosition": {"x": 1e300, "y": 0}}),
            r"nodePosition.x is 1e\+300",
        ),
        (changed(**{"0__nodes__3__nodePosition": {"x": 9e5, "y": 9e5}}), "1 to 4000000 cells"),
        (changed(**{"0__nodes__3__nodeId": 7}), r"layouts\[0\].nodes\[3\].nodeId is 7; a text"),
        (changed(**{"0__nodes__3__nodeId": "N1"}), "nodeId is 'N1', as that of another node"),
        (changed(**{"0__nodes": {}}), r"layouts\[0\].nodes is {}; a list was expected"),
        (changed(**{"0__nodes": []}), r"edges\[0\].startNodeId is 'N1', which is not a node"),
        (
            changed(**{"0__edges__1__endNodeId": "N9"}),
            r"edges\[1\].endNodeId is 'N9', which is not a node",
        ),
        (changed(**{"0__stations__0__interactionNodeIds": ["Q"]}), "name no node that there is"),
        (changed(**{"0__stations__0__interactionNodeIds": [3]}), r"interactionNodeIds\[0\] is 3"),
        (
            {**lif(), "layouts": [{**lif()["layouts"][0], "layoutLevelId": n} for n in "12"]},
            "2 levels",
        ),
    ],
)
def test_what_is_wrong_is_reported(write, values, message):
    path = write(values)
    with pytest.raises(FormatError, match=message) as error:
        formats.read(path)
    assert str(error.value).startswith(str(path)) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    "edge, spacing", [(0.8, 0.8), (1.4, 1.4), (2.0, 1.0), (5.0, 1.0), (2.6, 2.6 / 3)]
)
def test_long_edges_are_divided(write, edge, spacing):
    values = lif()
    for node in values["layouts"][0]["nodes"]:
        node["nodePosition"] = {axis: v / 1.4 * edge for axis, v in node["nodePosition"].items()}
    file, _ = formats.read(write(values))
    assert file.spacing == pytest.approx(spacing, abs=1e-3)
    assert file.shape[1] == round(6 * edge / spacing) + 1


def test_nodes_that_lie_on_no_grid(write):
    values = changed(**{"0__nodes__2__nodePosition": {"x": 4.9, "y": 3.3}})
    file, notes = formats.read(write(values))
    assert file.spacing == 1.0
    assert any(text.startswith("nodes were moved to the middle of their cells") for text in notes)
    assert any("is neither along x nor along y: it got a corner" in text for text in notes)


def test_stations_one_above_the_other_are_reported(write):
    values = lif()
    values["layouts"][0]["stations"] += [
        {
            "stationId": f"S1{level}",
            "interactionNodeIds": ["R1"],
            "stationName": f"rack {level}",
            "stationHeight": height,
        }
        for level, height in zip("ABC", (0.0, 2.5, 5.0))
    ]
    file, notes = formats.read(write(values))
    assert notes[-1] == (
        "a cell has one place, on the floor; node R1 has 3: rack A at 0 m, rack B at 2.5 m,"
        " rack C at 5 m"
    )
    assert file.floor[1, 2] == "s"


def test_heights_at_many_nodes_are_reported_in_one_sentence(write):
    values = lif()
    values["layouts"][0]["stations"] += [
        {
            "stationId": f"{number}{height}",
            "interactionNodeIds": [number],
            "stationName": "rack",
            "stationHeight": height,
        }
        for number in ("R1", "N5")
        for height in (0.0, 2.5)
    ]
    notes = formats.read(write(values))[1]
    (said,) = [text for text in notes if text.startswith("a cell has one place")]
    assert said.endswith("node R1 has 2: rack at 0 m, rack at 2.5 m; 1 other node too")


def test_curves_and_corridors_are_reported_once_each(write):
    values = lif()
    for edge in values["layouts"][0]["edges"]:
        (types,) = edge["vehicleTypeEdgeProperties"]
        types["trajectory"] = {"degree": 3, "knotVector": [0, 1], "controlPoints": []}
        types["corridor"] = {"leftWidth": 1.0, "rightWidth": 1.0}
    count = len(values["layouts"][0]["edges"])
    notes = formats.read(write(values))[1]
    for name in ("trajectory", "corridor"):
        assert [text for text in notes if name in text] == [
            f"a layout holds no {name}: left out {count} times"
        ]
