# SPDX-License-Identifier: Apache-2.0
"""What was measured of motion and service comes to robots and stations, and nonsense does not."""

from dataclasses import replace

import pytest

from kiva_plugin_cpp import DescriptionError, World
from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.file import layout_file
from warehouse_layout.generate import layout_choice
from warehouse_layout.place import placement
from warehouse_operations.fleets import availability, measured
from warehouse_operations.fleets.availability import RealismError
from warehouse_operations.runs import layout_site
from warehouse_operations.runs.simulation import Description, open_operations
from warehouse_operations.stock.site import Site

TEXT = """
motion: {speed: 0.9, lift_time: 3.5}
energy: {electronics: 50}
service:
  seconds_a_piece: {mean: 7, sd: 2}
  seconds_a_line: 1.5
  seconds_a_bundle: 21
  stations:
    pick2: {seconds_a_piece: 12}
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "found.yaml"
    path.write_text(TEXT)
    return path


@pytest.mark.parametrize("physics", [False, True])
def test_a_shift_has_it(file, physics):
    description = Description("small", physics=physics, realism=str(file))
    with open_operations(description) as ops:
        assert ops.site.kinematics == Kinematics(speed=0.9, lift=3.5)
        first, second = (next(s for s in ops.stations if s.name == f"pick{i}") for i in (1, 2))
        assert (first.seconds_a_piece, first.piece_sd, first.seconds_a_line) == (7, 2, 1.5)
        assert (second.seconds_a_piece, second.piece_sd, second.seconds_a_line) == (12, 2, 1.5)
        refill = next(s for s in ops.stations if s.replenishes)
        assert refill.seconds_a_bundle == 21
        if physics:
            assert ops.fleet.world.realism["motion"]["speed"] == 0.9
        else:
            assert ops.fleet.trips.upkeep.energy.electronics == 50


def test_a_robot_drives_by_it(file):
    world = World(realism=file)
    world.spawn_model("kiva", "kiva1", 0, 0)
    world.movx([1], [6])
    world.step(4000)
    assert world.fleet.vx[0] == pytest.approx(0.9, abs=0.002)


def test_a_layout_has_it_where_it_says_nothing_itself(file):
    plain = layout_choice.chosen("small")
    settings = {"seconds_a_piece": 5.0}
    stations = (replace(plain.stations[0], settings=settings), *plain.stations[1:])
    read = replace(
        plain, measured="found.yaml", path=str(file.parent / "n.layout.yaml"), stations=stations
    )
    again = layout_file.parse(layout_file.text_of(read), read.path)
    assert again.measured == "found.yaml"
    site = layout_site.of_file(Site.of_layout(placement.place(again)), again)
    assert site.kinematics.speed == 0.9
    assert site.settings.of(stations[0].name).piece_s == 5.0
    assert site.settings.of(stations[0].name).line_s == 1.5
    assert World.layout(again).realism["motion"]["speed"] == 0.9
    lost = replace(again, measured="none.yaml")
    with pytest.raises(layout_file.LayoutFileError, match="measured: .*none.yaml.*was expected"):
        layout_site.of_file(Site.of_layout(placement.place(lost)), lost)


def test_presets_measure_nothing():
    assert measured.read("") == measured.read("bad_day") == measured.Measured()
    site = Site.of_layout(placement.place(layout_choice.chosen("small")))
    assert measured.read("typical").at(site).settings == site.settings


@pytest.mark.parametrize(
    "text, complaint",
    [
        ("motion: {speed: fast}", "motion: speed is 'fast'; a number from 0 to 10 was expected"),
        ("motion: {speed: 11}", "motion: speed is 11; a number from 0 to 10 was expected"),
        ("motion: {pace: 1}", "motion: unknown 'pace'; it takes speed, acceleration"),
        ("motion: 3", "motion is 3; true, false or parameters"),
        ("service: {seconds: 3}", "service: unknown 'seconds'; it takes seconds_a_piece"),
        (
            "service: {seconds_a_line: -1}",
            "service: seconds_a_line is -1; a number from 0 to 3600 s",
        ),
        ("service: {stations: 5}", "service: stations: settings by station were expected"),
        ("service: {stations: {pick1: {a: 1}}}", "service: pick1: unknown 'a'"),
        ("- 3", "sections with parameters were expected"),
    ],
)
def test_nonsense_is_refused_by_file_and_key(tmp_path, text, complaint):
    path = tmp_path / "day.yaml"
    path.write_text(text)
    with pytest.raises(RealismError) as error:
        measured.read(str(path))
    assert f"{path}: {complaint}" in str(error.value)


def test_the_world_refuses_what_is_out_of_range():
    with pytest.raises(DescriptionError, match="motion/speed"):
        World(realism={"motion": {"speed": 11}})
    with pytest.raises(DescriptionError, match="services"):
        World(realism={"services": {"seconds_a_piece": 3}})


def test_availability_leaves_it_alone(file):
    assert availability.read(str(file)).energy.electronics == 50
