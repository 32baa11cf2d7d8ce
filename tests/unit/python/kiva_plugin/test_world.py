# SPDX-License-Identifier: Apache-2.0
"""The world inside this process: the real module, and no ROS."""

import gc
import inspect
import re
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from paths import ROOT

import kiva_plugin_cpp
from kiva_plugin_cpp import (
    COMMAND,
    CheckpointError,
    DescriptionError,
    EventKind,
    Kind,
    State,
    Status,
    World,
)

PLACES = {1: (0, 0), 2: (0, 3), 7: (-5, -5)}
VIEWS = (
    *("x", "y", "yaw", "vx", "vy", "yaw_rate", "tower", "status", "state"),
    *("left_wheel_speed", "right_wheel_speed", "path_id", "reached", "left", "stopped"),
)


@pytest.fixture
def world():
    world = World()
    for kiva_id, (x, y) in PLACES.items():
        world.spawn_model("kiva", f"kiva{kiva_id}", x, y)
    world.spawn_model("storage_unit", "storage_unit4", 0, 3)
    world.events()
    return world


def run(world, deadline=60.0):
    """Until all robots are idle."""
    status = world.fleet.status
    end = world.time + deadline
    world.step()
    while status.any():
        assert world.time < end
        world.step(100)


def kinds(world):
    return world.events()["kind"].tolist()


# --- commands


def test_commands_drive_robots(world):
    world.mov(kiva_id=1, x=2, y=1)
    run(world)
    at = world.fleet.index(1)
    assert world.fleet.x[at] == pytest.approx(2, abs=1e-3)
    assert world.fleet.y[at] == pytest.approx(1, abs=1e-3)
    assert kinds(world) == [EventKind.ACCEPTED, EventKind.DONE]


def test_commands_go_in_columns(world):
    world.movx([1, 2, 7], np.array([1, -2, 3]))
    run(world)
    np.testing.assert_allclose(world.fleet.x, [1, -2, -2], atol=1e-3)
    world.movy(np.array([1, 2]), 1.0)
    world.rot([7], -1)
    run(world)
    np.testing.assert_allclose(world.fleet.y, [1, 4, -5], atol=1e-3)
    assert world.fleet.yaw[2] == pytest.approx(-np.pi / 2, abs=1e-3)


def test_commands_go_in_a_structured_array(world):
    commands = np.zeros(2, COMMAND)
    commands["kind"] = Kind.MOVE_Y, Kind.ROTATE
    commands["kiva_id"] = 1, 2
    commands["y"][0], commands["direction"][1] = -2, 1
    world.post(commands)
    world.post(commands[:0])
    run(world)
    assert world.fleet.y[0] == pytest.approx(-2, abs=1e-3)
    assert world.fleet.yaw[1] == pytest.approx(np.pi / 2, abs=1e-3)


def test_a_unit_is_carried(world):
    world.carry(2, 4)
    run(world)
    assert world.fleet.shelf_id.tolist() == [0, 4, 0]
    assert world.storage_units["kiva_id"].tolist() == [2]
    assert world.storage_units["z"][0] > 0.05
    world.drop(2, 4)
    run(world)
    assert world.storage_units["kiva_id"].tolist() == [0]
    assert {EventKind.LIFTED, EventKind.DROPPED} <= set(kinds(world))


def test_what_a_robot_cannot_do_is_refused_by_an_event(world):
    world.mov(1, 0.5, 0)
    world.step()
    (event,) = world.events()
    assert (event["kind"], event["model"]) == (EventKind.REFUSED, "kiva1")
    assert "off the grid" in event["text"]


def test_paths_are_followed_as_far_as_they_are_released(world):
    fleet, ways = world.fleet, np.arange(4.0)
    path_id, reached, left = fleet.path_id, fleet.reached, fleet.left  # views: they go on
    world.follow(
        [1, 2],
        [7, 8],
        points=4,
        x=np.concatenate([ways, ways]),
        y=np.repeat([0.0, 3.0], 4),
        released=[3, 1],
    )
    world.step(8000)
    assert path_id.tolist() == [7, 8, 0]
    assert fleet.state.tolist() == [State.WAITING, State.WAITING, State.IDLE]
    assert (reached.tolist(), left.tolist()) == ([3, 1, 0], [2, 0, 0])
    world.stop(0)
    world.follow(1, 7, released=4)
    world.step(2000)
    assert fleet.stopped.tolist() == [1, 1, 1]
    assert reached.tolist() == [3, 1, 0]
    world.stop(0, stop=False)
    world.cancel(2)
    world.step(4000)
    assert fleet.last_end.tolist() == [EventKind.DONE, EventKind.DONE, 0]
    assert fleet.x[0] == pytest.approx(3, abs=1e-3)
    assert "cancelled" in world.events()["text"].tolist()


def test_speed_limits_of_paths_are_kept(world):
    fleet = world.fleet
    world.follow(1, 7, points=4, x=np.arange(4.0), y=np.zeros(4), max_speed=[9, np.inf, 0.2, 0.2])
    fastest = np.zeros(3)
    for _ in range(1500):
        world.step(10)
        way = int(np.clip(fleet.x[0], 0, 2.99))
        fastest[way] = max(fastest[way], np.hypot(fleet.vx[0], fleet.vy[0]))
    assert fleet.x[0] == pytest.approx(3, abs=1e-3)
    assert fastest[0] > 0.5 and max(fastest[1:]) < 0.2 + 1e-6


WRONG = [
    (lambda w: w.mov(9, 1, 1), ValueError, "no robot kiva9"),
    (lambda w: w.mov(-1, 1, 1), ValueError, "no robot kiva-1"),
    (lambda w: w.mov(2**40, 1, 1), ValueError, "too large"),
    (lambda w: w.mov(1.5, 1, 1), TypeError, "kiva_id: expected whole numbers, not float64"),
    (lambda w: w.mov(True, 1, 1), TypeError, "kiva_id: expected whole numbers, not bool"),
    (lambda w: w.mov(1, "a", 1), TypeError, "x: expected numbers"),
    (lambda w: w.mov(1, None, 1), TypeError, "x: expected numbers"),
    (lambda w: w.mov(1, 1j, 1), TypeError, "x: expected numbers"),
    (lambda w: w.mov([1, [2]], 1, 1), TypeError, "kiva_id"),
    (lambda w: w.mov(1, float("nan"), 1), ValueError, "x of command 0 is nan"),
    (lambda w: w.mov([1, 2], 1, [1, np.inf]), ValueError, "y of command 1 is inf"),
    (lambda w: w.mov([1, 2], [1, 2, 3], 1), ValueError, "x has 3 entries and kiva_id has 2"),
    (lambda w: w.mov([[1]], 1, 1), ValueError, r"not \(1, 1\)"),
    (lambda w: w.follow(9, 1, x=[0], y=[0]), ValueError, "no robot kiva9"),
    (lambda w: w.follow(1, -1, x=[0], y=[0]), ValueError, "path_id: .* negative"),
    (lambda w: w.follow(1, 1, x=[0, 1], y=[0]), ValueError, "y has 1 entries, and points make 2"),
    (lambda w: w.follow(1, 1, x=[np.nan], y=[0]), ValueError, "x of command 0 is nan"),
    (
        lambda w: w.follow(1, 1, x=[0], y=[0], max_speed=[0]),
        ValueError,
        "max_speed of point 0 is 0",
    ),
    (lambda w: w.follow(1, 1, x=[0], y=[0], max_speed=[1, 1]), ValueError, "max_speed has 2 entr"),
    (lambda w: w.follow([1, 2], 1, points=[1], x=[0], y=[0]), ValueError, "points make 2"),
    (lambda w: w.follow([1, 2], [1, 2, 3]), ValueError, "path_id has 3"),
    (lambda w: w.cancel(9), ValueError, "no robot kiva9"),
    (lambda w: w.stop(9), ValueError, "no robot kiva9"),
    (lambda w: w.rot(1, 1.0), TypeError, "direction: expected whole numbers"),
    (lambda w: w.post(np.zeros(3)), TypeError, "COMMAND"),
    (lambda w: w.post(np.zeros((1, 1), COMMAND)), ValueError, r"shape \(n,\)"),
    (lambda w: w.post(np.full(1, 9, COMMAND)), ValueError, "kind of command 0 is 9"),
    (lambda w: w.post(np.zeros(1, COMMAND)), ValueError, "no robot kiva0"),
    (lambda w: w.step(-1), ValueError, "steps is -1"),
    (lambda w: w.step(1.5), TypeError, ""),
    (lambda w: w.fleet.index(3), ValueError, "no robot kiva3"),
    (lambda w: w.scans([1, 3]), ValueError, "no robot kiva3"),
    (lambda w: w.delete("missing"), KeyError, "missing"),
    (lambda w: w.pose("missing"), KeyError, "missing"),
    (lambda w: w.set_pose("kiva1", np.nan, 0), DescriptionError, "finite"),
    (lambda w: w.spawn("<sdf"), DescriptionError, "<text>"),
    (lambda w: w.spawn_model("dragon", "kiva9", 0, 0), DescriptionError, "dragon"),
    (lambda w: w.spawn_model("kiva", "kiva1", 9, 9), DescriptionError, "already exists"),
    (lambda w: w.spawn_model("kiva", "robot", 9, 9), DescriptionError, "kiva<id>"),
    (lambda w: w.restore(b"nothing"), CheckpointError, "ends too early"),
    (lambda w: w.restore(w.checkpoint()[:-1]), CheckpointError, "bytes"),
    (lambda w: w.restore("text"), TypeError, ""),
    (lambda w: World("nowhere"), FileNotFoundError, "there is no world 'nowhere'"),
    (lambda w: World(drive="wings"), ValueError, "drive is 'wings'"),
    (lambda w: World.preset("gigantic"), ValueError, "gigantic"),
    (lambda w: World.create(robots=-1), ValueError, "negative"),
]


@pytest.mark.parametrize(("call", "error", "reason"), WRONG)
def test_what_is_wrong_raises_with_its_reason_and_changes_nothing(world, call, error, reason):
    before = world.state_hash()
    with pytest.raises(error, match=reason):
        call(world)
    assert world.state_hash() == before
    world.step()
    assert kinds(world) == []


def test_a_world_file_that_is_wrong_names_its_line():
    worlds = ROOT / "tests" / "worlds"
    with pytest.warns(UserWarning, match=r"invalid_box_size\.sdf:\d+"):
        World(worlds / "invalid_box_size.sdf")
    with pytest.raises(DescriptionError, match=r"invalid_no_world\.sdf: expected a <world>"):
        World(worlds / "invalid_no_world.sdf")


def test_what_a_world_leaves_out_is_a_warning(tmp_path):
    file = tmp_path / "their.world"
    file.write_text(
        '<sdf version="1.6"><world name="w">\n'
        '<plugin name="p" filename="libnowhere.so"/>\n'
        "<include><uri>model://kiva</uri></include>\n"
        "<include><uri>model://wall</uri></include></world></sdf>"
    )
    with pytest.warns(UserWarning) as warnings:
        assert World(file).names == ["wall"]
    text = "\n".join(str(warning.message) for warning in warnings)
    assert "libnowhere.so" in text
    assert "left out: model 'kiva': a robot is called kiva<id>" in text


def test_models_of_a_world_that_are_called_like_ours_are_no_robots(tmp_path):
    (tmp_path / "kiva").mkdir()
    (tmp_path / "kiva" / "model.config").write_text(
        '<model><name>kiva</name><sdf version="1.6">model.sdf</sdf></model>'
    )
    (tmp_path / "kiva" / "model.sdf").write_text(
        '<sdf version="1.6"><model name="kiva"><static>1</static><link name="l"/></model></sdf>'
    )
    file = tmp_path / "their.world"
    file.write_text(
        '<sdf version="1.6"><world name="w"><include><uri>model://kiva</uri></include>'
        "</world></sdf>"
    )
    world = World(file, model_paths=[tmp_path])
    assert world.names == ["kiva"]
    world.spawn_model("kiva", "kiva1", 0, 0)
    assert world.fleet.kiva_id.tolist() == [1]
    assert len(World.preset("small", model_paths=[tmp_path]).fleet.kiva_id) == 4


def test_models_are_looked_for_where_the_node_looks(tmp_path, monkeypatch):
    for folder in ("exported", "listed"):
        model = tmp_path / folder / "models" / f"{folder}_box"
        model.mkdir(parents=True)
        (model / "model.config").write_text(
            f'<model><name>{folder}_box</name><sdf version="1.6">model.sdf</sdf></model>'
        )
        (model / "model.sdf").write_text(
            f'<sdf version="1.6"><model name="{folder}_box"><link name="l"/></model></sdf>'
        )
    (tmp_path / "exported" / "package.xml").write_text(
        "<package><export><gazebo_ros gazebo_model_path='${prefix}/models'/></export></package>"
    )
    (tmp_path / "elsewhere").mkdir()
    file = tmp_path / "elsewhere" / "their.world"
    file.write_text(
        '<sdf version="1.6"><world name="w"><include><uri>model://listed_box</uri></include>'
        "<include><uri>model://exported_box</uri></include></world></sdf>"
    )
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(tmp_path / "listed" / "models"))
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "exported"))
    assert World(file).names == ["listed_box", "exported_box"]
    world = World("empty")
    include = "<include><uri>model://listed_box</uri><name>another</name></include>"
    world.spawn(f'<sdf version="1.6"><world name="w">{include}</world></sdf>')
    assert "another" in world.names


# --- views


def test_views_show_the_world_without_copying(world):
    for name in VIEWS:
        view = getattr(world.fleet, name)
        assert view.shape == (3,)
        assert not view.flags.writeable
        assert not view.flags.owndata
        assert np.shares_memory(view, getattr(world.fleet, name))
        with pytest.raises(ValueError, match="read-only"):
            view[0] = 0
    x, status = world.fleet.x, world.fleet.status
    world.movx(1, 1)
    world.step(1000)
    assert x[0] > 0.1
    assert status[0] == Status.BUSY
    assert world.fleet.state[0] == State.MOVING_X


def test_a_view_outlives_its_world(world):
    views = {name: getattr(world.fleet, name) for name in VIEWS}
    scans = world.scans()
    fleet = world.fleet
    before = {name: view.copy() for name, view in views.items()}
    del world
    gc.collect()
    assert len(fleet) == 3  # it holds the world
    del fleet
    gc.collect()
    for i in range(20):  # others take the memory that is free
        World().spawn_model("kiva", f"kiva{i + 1}", 0, 0)
    for name, view in views.items():
        np.testing.assert_array_equal(view, before[name])
    assert scans.shape == (3, 121)
    assert not np.isnan(scans).any()


def test_a_view_outlives_the_size_of_its_fleet(world):
    x = world.fleet.x
    for i in range(100):
        world.spawn_model("kiva", f"kiva{i + 100}", 10 + i // 10, i % 10)
    assert x.tolist() == [0, 0, -5]
    assert world.fleet.x.shape == (103,)
    x = world.fleet.x
    for i in range(100):
        world.delete(f"kiva{i + 100}")
    assert world.fleet.x.shape == (3,)
    assert x.shape == (103,)
    assert np.isfinite(x).all()


def test_a_view_outlives_a_restore(world):
    saved = world.checkpoint()
    x = world.fleet.x
    world.movx(1, 1)
    world.step(3000)
    there = x[0]
    world.restore(saved)
    world.step(10)
    assert x[0] == there
    assert world.fleet.x[0] == 0


def test_an_empty_fleet_has_empty_views():
    world = World("empty")
    assert world.fleet.x.shape == (0,)
    assert world.scans().shape == (0, 0)
    assert world.storage_units.shape == (0,)


def test_scans_see(world):
    world.spawn_model("wall", "wall1", 2, 0, yaw=np.pi / 2)
    scans = world.scans()
    assert (scans.dtype, scans.shape) == (np.float32, (3, 121))
    assert 1 < scans[0, 60] < 2  # ahead of kiva1
    assert np.isinf(scans[2]).all()
    np.testing.assert_array_equal(world.scans([7, 1])[1], scans[0])
    assert world.scans(1).shape == (1, 121)


def test_scans_are_a_view_until_the_next(world):
    first = world.scans()
    assert not first.flags.writeable
    world.set_pose("kiva1", 3, 3)
    second = world.scans()
    assert np.shares_memory(first, second)
    assert not np.shares_memory(first, world.scans([1]))


# --- models


def test_models_come_and_go(world):
    sdf = (ROOT / "worlds" / "models" / "person" / "model.sdf").read_text()
    assert world.spawn(sdf, "person9", (4, 4, 0, 0)) == ["person9"]
    assert "person9" in world.names
    np.testing.assert_allclose(world.pose("person9"), [4, 4, 0, 0, 0, 0, 1])
    world.delete("person9")
    assert "person9" not in world.names
    assert kinds(world) == [EventKind.SPAWNED, EventKind.DELETED]


@pytest.mark.parametrize(("name", "robots", "units"), [("empty", 0, 0), ("small", 4, 24)])
def test_presets(name, robots, units):
    world = World.preset(name)
    assert (len(world.fleet), len(world.storage_units)) == (robots, units)
    assert len(world.events()) == 0


def test_a_warehouse_of_ones_own():
    world = World.create(robots=3, shelves=5, items=7)
    assert len(world.fleet) == 3
    assert world.items["shelf_id"].min() >= 1
    assert len(world.items) == 7


def test_the_papers_world():
    assert len(World("paper").fleet) > 0


# --- checkpoints


def test_a_checkpoint_goes_on_the_same():
    world = World.preset("small")
    world.movy(world.fleet.kiva_id, [1, -1, 2, 1])
    world.step(700)
    saved = world.checkpoint()
    assert isinstance(saved, bytes)
    world.step(3000)
    expected = world.state_hash()
    world.restore(saved)
    assert world.time == pytest.approx(0.7)
    world.step(3000)
    assert world.state_hash() == expected
    other = World()
    other.restore(saved)
    other.step(3000)
    assert other.state_hash() == expected


# --- threads


def test_step_releases_the_interpreter_and_a_second_thread_is_told_so():
    world = World.preset("medium")
    stop, ready = threading.Event(), threading.Event()

    def work():
        while not stop.is_set():
            world.step(2000)
            ready.set()

    thread = threading.Thread(target=work)
    thread.start()
    try:
        ready.wait(30)
        end, errors = time.monotonic() + 30, set()
        while len(errors) < 4 and time.monotonic() < end:
            calls = (world.step, world.checkpoint, lambda: world.fleet.x, world.events)
            for i, call in enumerate(calls):
                try:
                    call()
                except RuntimeError as error:
                    assert "another thread" in str(error)
                    errors.add(i)
    finally:
        # A step of ours may have met one of the thread's, which ended it.
        stop.set()
        thread.join()
    assert len(errors) == 4
    world.step()


def test_ctrl_c_ends_a_long_step():
    code = (
        "from kiva_plugin_cpp import World; import signal; world = World.preset('small');"
        "signal.setitimer(signal.ITIMER_REAL, 0.2); signal.signal(signal.SIGALRM,"
        " signal.default_int_handler); world.step(10**12)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], check=False, capture_output=True, timeout=60, text=True
    )
    assert "KeyboardInterrupt" in done.stderr


# --- the package


def test_it_imports_no_ros():
    code = (
        "import sys, kiva_plugin_cpp; kiva_plugin_cpp.World.preset('empty');"
        "print([m for m in sys.modules if m.split('.')[0] in"
        " ('rospy', 'roslib', 'genpy', 'rosgraph', 'std_msgs', 'geometry_msgs')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert done.stdout.strip() == "[]"


def public(cls):
    return {n for n in dir(cls) if not n.startswith("_")}


def test_everything_has_a_docstring():
    for cls in (World, kiva_plugin_cpp.Fleet):
        for name in public(cls):
            doc = inspect.getdoc(inspect.getattr_static(cls, name))
            assert doc and len(doc.splitlines()[-1]) > 5, name


def test_everything_is_annotated():
    assert Path(kiva_plugin_cpp.__file__).with_name("py.typed").exists()
    for cls in (World, kiva_plugin_cpp.Worlds):
        for name, value in vars(cls).items():
            function = value.__func__ if isinstance(value, classmethod) else value
            if inspect.isfunction(function):
                arguments = set(inspect.signature(function).parameters) - {"self", "cls"}
                assert set(function.__annotations__) == arguments | {"return"}, name


def test_the_readmes_example_runs():
    readme = (ROOT / "README.md").read_text()
    (example,) = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(example)],
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.strip("[] \n").split()) == 20  # where each robot of medium is


def test_a_robot_can_be_driven_by_velocities_and_is_given_back_on_a_grid_point():
    world = World.preset("small")
    world.begin_steering(1)
    x, y = world.fleet.x[0], world.fleet.y[0]
    world.movx(1, 1)
    world.step()
    assert [event["kind"] for event in world.events()][-1] == EventKind.REFUSED
    for _ in range(20):
        world.steer(1, 0.2, 0.0)
        world.step(100)
    way = np.hypot(world.fleet.x[0] - x, world.fleet.y[0] - y)
    assert way == pytest.approx(0.2 * 2 - 0.2**2 / 2, abs=0.01)  # v t - v²/2a
    with pytest.raises(ValueError, match="ask it to stop first"):
        world.end_steering(1)
    world.step(1500)  # nothing is heard: it stops
    with pytest.raises(ValueError, match=r"kiva1: it stands 0\.\d\d m off the grid point"):
        world.end_steering(1)
    with pytest.raises(ValueError, match="finite numbers were expected"):
        world.steer(1, float("nan"), 0.0)
