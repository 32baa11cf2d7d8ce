# SPDX-License-Identifier: Apache-2.0
"""Building a warehouse in place of another: all of it, or none."""

import re
from types import SimpleNamespace

import pytest
from fake_world import FakeWorld
from geometry_msgs.msg import Pose

from warehouse_client import warehouse_builder
from warehouse_client.build_transaction import BUILDING
from warehouse_client.engine import WAIT, Engine, EngineError
from warehouse_layout.file.request import PRESETS, resolve
from warehouse_layout.floor import poses
from warehouse_layout.generate.generated import plan
from warehouse_layout.models import models
from warehouse_layout.models.models import FLOOR, kind_and_number
from warehouse_msgs.srv import CreateWarehouseRequest
from warehouse_sim.service import CLOCK_PATIENCE, WarehouseService


def service(world, lines=None):
    return WarehouseService(world, [].append if lines is None else lines.append)


def ask(world, name="", **counts):
    return service(world).handle(CreateWarehouseRequest(warehouse_name=name, **counts))


def counts(world):
    kinds = [kind_and_number(name)[0] for name in world.standing]
    return {kind: kinds.count(kind) for kind in kinds}


def test_small_stands():
    world = FakeWorld()
    answer = ask(world, "small", warehouse_id=7)
    assert answer.success
    assert answer.message == (
        "small: 4 robots, 24 storage units, 96 items, 2 conveyor belts on a 21 x 14 m floor"
    )
    assert counts(world) == {
        None: 1,
        "floor_markings": 1,
        "kiva": 4,
        "storage_unit": 24,
        "item": 96,
        "conveyor_belt": 2,
    }
    assert world.parameters["warehouse/name"] == "small"
    assert world.parameters["warehouse/id"] == 7
    assert world.parameters["warehouse/floor"] == [-10.5, 10.5, -6.5, 7.5]


def test_items_are_spawned_within_their_units():
    world = FakeWorld()
    ask(world, shelves=3, items=12)
    at = world.standing["storage_unit2"].position
    item = world.standing["item2"].position
    assert abs(item.x - at.x) < 0.3
    assert abs(item.y - at.y) < 0.3
    assert item.z == 0.46


def test_robots_face_where_the_layout_says():
    world = FakeWorld()
    ask(world, robots=2)
    headings = poses.planar_of([world.standing["kiva1"], world.standing["kiva2"]])[:, 2]
    assert headings == pytest.approx(plan(resolve("", robots=2)).robots[:, 2])


def test_the_seed_decides_which_items_a_unit_holds():
    worlds = [FakeWorld(), FakeWorld(), FakeWorld()]
    for world, seed in zip(worlds, (1, 2, 2)):
        WarehouseService(world, [].append, seed=seed).create("small")
    first, second, third = ({n: str(p) for n, p in w.standing.items()} for w in worlds)
    assert first != second == third


def test_no_document_is_longer_than_the_world_reads(monkeypatch):
    monkeypatch.setattr(models, "MOST_CHARACTERS", 100)
    lengths = (60, 60, 40, 300, 10, 10, 10)
    parts = [models.Part(str(i), "x" * length) for i, length in enumerate(lengths)]
    names = [[part.name for part in batch] for batch in models.batches(parts, 2)]
    assert names == [["0"], ["1", "2"], ["3"], ["4", "5"], ["6"]]


def test_the_world_reads_models_in_batches(monkeypatch):
    monkeypatch.setattr(warehouse_builder, "BATCH", 50)
    world = FakeWorld()
    ask(world, "small")
    assert world.documents == [50, 50, 28]
    assert "kiva4" in world.standing


def test_a_warehouse_takes_the_place_of_the_last():
    world = FakeWorld(standing=["kiva9", "storage_unit1", "item1", "item77", "conveyor_belt3"])
    others = ["person1", "kiva_statue", "item1_label"]
    world.standing |= dict.fromkeys([FLOOR, *others])
    ask(world, robots=1)
    assert set(world.standing) == {FLOOR, "floor_markings1", "kiva1", "conveyor_belt1", *others}


@pytest.mark.parametrize("counts", [{}, {"robots": -1}, {"robots": 1, "items": 5}])
def test_a_refused_request_changes_nothing(counts):
    world = FakeWorld(standing=["kiva9", "storage_unit1", "item1"])
    before = dict(world.standing)
    answer = ask(world, "nowhere", **counts)
    assert not answer.success
    assert answer.message
    assert world.standing == before
    assert world.parameters == {}


def test_half_a_warehouse_is_taken_away_again(monkeypatch):
    monkeypatch.setattr(warehouse_builder, "BATCH", 3)
    world = FakeWorld(standing=["kiva9", "person1"], refuses="item5")
    answer = ask(world, shelves=2, items=9, robots=2)
    assert not answer.success
    assert answer.message == "item5 is bad; the half-made warehouse was taken away"
    assert set(world.standing) == {FLOOR, "person1"}
    assert world.parameters["warehouse/name"] == ""
    assert not world.has_param(BUILDING)


@pytest.mark.parametrize("paused", [True, False])
@pytest.mark.parametrize("refuses", [None, "kiva2"])
def test_physics_stands_still_meanwhile_and_only_then(paused, refuses):
    world = FakeWorld(paused=paused, refuses=refuses)
    ask(world, robots=3)
    assert world.pause == paused
    assert world.spawned_while_running == []


def test_builds_at_the_start():
    world, lines = FakeWorld(standing=[FLOOR]), []
    service(world, lines).start("small")
    assert counts(world)["kiva"] == 4
    assert "small: 4 robots" in lines[-1]
    assert len(re.findall("rostopic pub -1", lines[-1])) == 3


def test_a_respawned_node_finds_the_warehouse_as_it_stands():
    world, lines = FakeWorld(standing=[FLOOR]), []
    service(world).start("small")
    del world.standing["item3"]
    before = dict(world.standing)
    service(world, lines).start("small")
    assert world.standing == before
    assert lines == []


class KilledError(BaseException):
    """The end of a process, in the middle of whatever it does."""


def killed_while_building(paused, standing=()):
    """The world as a builder leaves it that is killed with its warehouse half-built."""
    world = FakeWorld(standing=standing, paused=paused)
    begin = world.replace_models

    def killed(*_):
        world.standing |= {"storage_unit1": Pose(), "item1": Pose()}
        raise KilledError

    world.replace_models = killed
    with pytest.raises(KilledError):
        ask(world, "medium")
    world.replace_models = begin
    assert world.pause
    return world


@pytest.mark.parametrize("paused", [True, False])
def test_what_a_builder_left_half_built_is_undone_by_the_next(paused):
    world, lines = killed_while_building(paused), []
    service(world, lines).start("small")
    assert counts(world)["storage_unit"] == 24
    assert world.pause == paused
    assert not world.has_param(BUILDING)
    assert "left half-built" in lines[0]


def test_what_can_not_be_built_anew_is_undone_all_the_same():
    world = killed_while_building(paused=False, standing=["person1"])
    service(world).start("smal")
    assert set(world.standing) == {"person1"}
    assert not world.pause
    assert not world.has_param(BUILDING)


def test_a_second_death_forgets_nothing():
    world = killed_while_building(paused=False)
    names, world.get_world_properties = world.get_world_properties, None
    with pytest.raises(TypeError):
        service(world).start("small")
    world.get_world_properties = names
    service(world).start("small")
    assert not world.pause


@pytest.mark.parametrize("size", ["", "none"])
def test_without_a_size_nothing_is_built(size):
    world = FakeWorld(standing=[FLOOR])
    service(world).start(size)
    assert set(world.standing) == {FLOOR}


def test_a_misspelt_size_is_told_and_the_service_comes_all_the_same():
    world, lines = FakeWorld(standing=[FLOOR]), []
    service(world, lines).start("smal")
    assert set(world.standing) == {FLOOR}
    assert lines[0].startswith("nothing was built: 'smal' is not a preset")


def test_long_work_is_announced(monkeypatch):
    monkeypatch.setattr(warehouse_builder, "MANY", 128)
    lines = []
    with Engine(FakeWorld()) as engine:
        builder = warehouse_builder.WarehouseBuilder(engine, lines.append)
        builder.replace(plan(PRESETS["small"]))
        builder.replace(plan(PRESETS["empty"]))
    assert lines == ["building 128 models"]


def test_what_the_world_refuses_as_a_whole_leaves_the_warehouse_that_stands():
    world = FakeWorld()
    assert ask(world, "small").success
    before, parameters = dict(world.standing), dict(world.parameters)
    world.replace_models = lambda *_: SimpleNamespace(success=False, changed=False, message="no")
    answer = ask(world, "medium")
    assert (answer.success, answer.message) == (False, "no")
    assert world.standing == before and world.parameters == parameters
    assert not world.pause


@pytest.mark.parametrize(
    "method, error, words",
    [
        ("wait_for_service", "ROSException", "the world does not answer: too late"),
        ("replace_models", "ServiceException", "replace_models: too late"),
    ],
)
def test_a_world_that_does_not_answer(method, error, words):
    world = FakeWorld()

    def fail(*_):
        raise getattr(world, error)("too late")

    setattr(world, method, fail)
    answer = ask(world, "small")
    assert not answer.success
    assert words in answer.message


def test_a_world_that_does_not_answer_is_waited_for_once():
    world, waits = FakeWorld(), []

    def fail(_, timeout):
        waits.append(timeout)
        raise world.ROSException("too late")

    world.wait_for_service = fail
    ask(world, "small")
    assert sum(waits) <= WAIT + CLOCK_PATIENCE


def test_engine_names_what_can_not_be_deleted():
    with Engine(FakeWorld()) as engine, pytest.raises(EngineError, match="kiva1: .*not exist"):
        engine.delete("kiva1")


def test_a_layout_file_takes_the_place_of_the_last(tmp_path):
    path = tmp_path / "one.layout.yaml"
    path.write_text(
        "layout: 1\nname: mine\nfloor: |\n  ....\n  .ss.\n  ....\nrobots: 1\nitems: 2\n"
    )
    world = FakeWorld(standing=["kiva9", "layout_walls1"])
    answer = ask(world, str(path))
    assert answer.success, answer.message
    assert answer.message.startswith("mine: 1 robot, 2 storage units, 2 items, 0 conveyor belts")
    assert counts(world)["kiva"] == 1 and "layout_walls1" not in world.standing
    assert world.parameters["warehouse/name"] == "mine"
    assert world.parameters["warehouse/layout"] == str(path)
    ask(world, "small")
    assert world.parameters["warehouse/layout"] == ""


def test_a_layout_file_that_is_none_changes_nothing(tmp_path):
    world = FakeWorld(standing=["kiva9"])
    path = tmp_path / "one.layout.yaml"
    path.write_text("layout: 1\nfloor: |\n  ...\n  .s.\nspacing: 1.2\n")
    for text, message in (
        (path.read_text(), "loaded robots that meet at"),
        (path.read_text().replace("  .s.", "  .s.\n  ..."), "only a launch with layout:="),
        ("layout: 2", "one.layout.yaml:1:9: layout is 2; this reads version 1"),
    ):
        path.write_text(text)
        answer = ask(world, str(path))
        assert not answer.success and message in answer.message, answer.message
    assert set(world.standing) == {"kiva9"}
