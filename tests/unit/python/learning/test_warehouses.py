# SPDX-License-Identifier: Apache-2.0
"""The task that learning is about: rules, rewards, seeds; without any learning package."""

import numpy as np
import pytest
from paths import ROOT

from warehouse_learning import (
    Action,
    ActionError,
    OptionError,
    Options,
    Warehouses,
    episodes,
    fields,
)
from warehouse_learning.observing import Observer

LAYOUTS = ROOT / "tests" / "layouts"
TURNS = {0: [], 1: [Action.LEFT], 2: [Action.LEFT, Action.LEFT], 3: [Action.RIGHT]}
DELIVERY = {"lifted": 0.5, "stored": 0.25, "approached": 0.0}


def one(**options):
    """One robot, for which all others' ways are free."""
    return Warehouses(1, Options.of({"robots": 1, "shelves": 6, "requests": 1} | options), 1)


def act(warehouses, action):
    return warehouses.step(np.array([[action]]))


def drive_to_goal(warehouses):
    """Drives by the shortest way; returns the rewards earned."""
    earned = 0.0
    grid, goal = warehouses.grid, int(warehouses.goal[0, 0])
    for _ in range(200):
        cell = int(warehouses.cell[0, 0])
        if cell == goal:
            return earned
        far = warehouses.task.way(0, 0)[cell + grid.steps]
        turn = (int(far.argmin()) - int(warehouses.heading[0, 0])) % 4
        for action in [*TURNS[turn], Action.FORWARD]:
            reward, happened = act(warehouses, action)
            assert not happened["refused"].any()
            earned += reward.sum()
    raise AssertionError("it never came to its goal")


def test_a_unit_is_fetched_delivered_and_stored_again():
    warehouses = one(rewards=DELIVERY)
    warehouses.reset([0], [3])
    unit = int(np.flatnonzero(warehouses.requested[0])[0])
    assert drive_to_goal(warehouses) == 0
    assert warehouses.unit_cell[0, unit] == warehouses.cell[0, 0]
    assert act(warehouses, Action.LIFT)[0] == 0.5
    assert warehouses.load[0, 0] == unit
    assert drive_to_goal(warehouses) == 1.0
    assert warehouses.delivered[0, 0] == 1
    assert not warehouses.requested[0, unit] and warehouses.requested[0].sum() == 1
    drive_to_goal(warehouses)
    assert act(warehouses, Action.LIFT)[0] == 0.25
    assert warehouses.grid.storage[warehouses.unit_cell[0, unit]]
    # The physics agrees.
    row = warehouses.worlds[0].storage_units[unit]
    assert row["kiva_id"] == 0
    assert warehouses.grid.cell_of(row["x"], row["y"]) == warehouses.unit_cell[0, unit]


def random_run(seed, decisions=40, n=3, **options):
    warehouses = Warehouses(n, Options.of({"robots": 6, "shelves": 24} | options))
    observer = Observer(warehouses)
    warehouses.reset(np.arange(n), [seed + i for i in range(n)])
    random = np.random.default_rng(seed)
    steps, collisions = [], 0
    for _ in range(decisions):
        masks = warehouses.masks()
        actions = (masks * random.random(masks.shape)).argmax(-1)
        rewards, happened = warehouses.step(actions)
        collisions += int(happened["collided"].sum())
        steps += [observer.observations(), rewards, observer.state()]
    return warehouses, steps, collisions


def test_the_same_seed_is_the_same_episode_bit_by_bit():
    first, before, _ = random_run(5)
    again, same, _ = random_run(5)
    assert (first.worlds.state_hash() == again.worlds.state_hash()).all()
    assert all((a == b).all() for a, b in zip(before, same))
    # In a world that has been used before, and alone, too.
    saved = first.worlds.state_hash()
    first.reset([1], [5])
    assert first.worlds.state_hash()[0] == saved[0]
    alone = Warehouses(1, first.options, 1)
    alone.reset([0], [5])
    assert alone.worlds.state_hash()[0] == first.worlds.state_hash()[1]


def test_reservations_keep_robots_apart():
    warehouses, steps, collisions = random_run(1, decisions=150)
    assert collisions == 0
    x, y = warehouses.grid.point_of(warehouses.cell)
    np.testing.assert_allclose(warehouses.worlds.x, x, atol=1e-3)
    np.testing.assert_allclose(warehouses.worlds.y, y, atol=1e-3)
    # What robots carry and where units stand is what the physics says.
    for w in range(warehouses.n):
        rows = warehouses.worlds[w].storage_units
        cells = np.where(rows["kiva_id"] > 0, -1, warehouses.grid.cell_of(rows["x"], rows["y"]))
        np.testing.assert_array_equal(cells, warehouses.unit_cell[w])


@pytest.mark.parametrize("reserve", [True, False])
def test_without_reservations_physics_keeps_robots_apart(reserve):
    options = Options.of({"robots": 2, "shelves": 6, "reserve": reserve})
    warehouses = Warehouses(1, options, 1)
    warehouses.reset([0], [0])
    grid = warehouses.grid
    cells = np.flatnonzero(grid.street & np.roll(grid.street, -1))[0] + np.array([0, 1])
    x, y = grid.point_of(cells)
    warehouses.worlds.place([0, 0], [1, 2], x, y, [0.0, np.pi])  # face to face
    warehouses.worlds.step(0)
    warehouses._see(warehouses._all)
    warehouses.step(np.full((1, 2), Action.WAIT))
    _, happened = warehouses.step(np.full((1, 2), Action.FORWARD))
    assert happened["collided"].all() != reserve
    assert happened["refused"].all() == reserve
    assert abs(np.diff(warehouses.worlds.x[0])[0]) > 0.75


@pytest.mark.parametrize("options", [{}, {"decision": 0.5}, {"lasers": True}])
def test_observations_stay_within_their_bounds(options):
    _, steps, _ = random_run(2, decisions=20, **options)
    for observations in steps[::3]:
        assert observations.dtype == np.float32
        assert observations.min() >= -1 and observations.max() <= 1


def seen_from(warehouses, w, robot, ahead, left):
    """The layers of the cell so many cells ahead and to the left, one by one."""
    grid, heading = warehouses.grid, warehouses.heading[w, robot]
    cell = warehouses.cell[w, robot]
    cell += ahead * grid.steps[heading] + left * grid.steps[(heading + 1) % 4]
    units = np.flatnonzero(warehouses.unit_cell[w] == cell)
    robots = np.flatnonzero(warehouses.cell[w] == cell)
    return [
        not grid.passable[cell],
        grid.storage[cell],
        cell in grid.stations,
        len(units) > 0,
        warehouses.requested[w, units].any(),
        len(robots) > 0,
        (warehouses.load[w, robots] >= 0).any(),
    ]


def test_robots_observe_what_is_around_them_as_they_face_it():
    warehouses, steps, _ = random_run(4, decisions=60, n=2, radius=3)
    assert (warehouses.load >= 0).any() and len(np.unique(warehouses.heading)) > 2
    see = fields.split(steps[-3], fields.robot_fields(warehouses.options))
    grid = warehouses.grid
    longest = max(grid.width, grid.height) - 2 * grid.rim
    for w, robot in np.ndindex(warehouses.cell.shape):
        for i, j in np.ndindex(7, 7):
            expected = seen_from(warehouses, w, robot, i - 3, j - 3)
            assert see["neighbourhood"][w, robot, i, j].tolist() == expected
        cell, heading = warehouses.cell[w, robot], warehouses.heading[w, robot]
        assert see["heading"][w, robot].argmax() == heading
        way = np.array([1, 1j, -1, -1j])[heading] * (see["goal"][w, robot] @ [1, 1j])
        (row, column), (own_row, own_column) = (
            np.divmod(c, grid.width) for c in (warehouses.goal[w, robot], cell)
        )
        expected = complex(column - own_column, row - own_row) / longest
        assert way == pytest.approx(expected, abs=1e-6)


def test_the_task_refuses_what_it_would_misread():
    warehouses = one()
    warehouses.reset([0], [0])
    task, floor = warehouses.task, warehouses.grid.native
    good = Observer(warehouses).observations()
    units = np.zeros(6, np.int32)
    done, counts = np.ones((1, 1), bool), warehouses.worlds.counts
    names = ("x", "y", "yaw", "status", "shelf_id")
    see = {"which": [0]} | {name: getattr(warehouses.worlds, name) for name in names}
    for error, said, call in (
        (ValueError, "out", lambda: task.observe(good[:, :, :17])),
        (ValueError, "out", lambda: task.observe(good.astype(float))),
        (ValueError, "out", lambda: task.observe(np.zeros((2, *good.shape[1:]), np.float32))),
        (ValueError, "actions", lambda: task.begin(np.zeros((1, 1)))),
        (IndexError, "actions", lambda: task.begin(np.full((1, 1), 5, np.int8))),
        (ValueError, "counts", lambda: task.take_events(done, counts[..., :9])),
        (ValueError, "x: ", lambda: task.update(**see | {"x": np.zeros((1, 2))})),
        (IndexError, "which", lambda: task.update(**see | {"which": [1]})),
        (
            IndexError,
            "shelf_id",
            lambda: task.update(**see | {"shelf_id": np.full((1, 1), 7, "i4")}),
        ),
        (ValueError, "unit_cell", lambda: task.place_units(0, units[1:])),
        (IndexError, "unit_cell", lambda: task.place_units(0, units - 2)),
        (ValueError, "requested", lambda: task.begin_episode(0, units, units)),
        (IndexError, "load", lambda: task.deliver(0, 0, 1)),
        (ValueError, "one shape", lambda: floor.locate([0.0, 1.0], [0.0], [0.0])),
    ):
        with pytest.raises(error, match=said):
            call()
    with pytest.raises(ValueError, match="read-only"):
        warehouses.cell[0, 0] = 0
    # Whatever lies beyond the floor counts as its edge.
    cell, heading = floor.locate([-1e9, np.nan], [0.0, 1e9], [-1e-9, -np.pi / 2])
    assert heading.tolist() == [0, 3] and (cell < warehouses.grid.cells).all()


def test_of_several_that_want_into_one_cell_the_first_goes():
    warehouses = Warehouses(1, Options.of({"robots": 3, "shelves": 6}), 1)
    grid = warehouses.grid
    step = grid.steps[1]
    street = grid.street
    middle = next(
        c for c in np.flatnonzero(street) if street[c - 1] and street[c + 1] and street[c - step]
    )
    warehouses.reset([0], [0])
    x, y = grid.point_of(np.array([middle - step, middle + 1, middle - 1]))
    warehouses.worlds.place([0] * 3, [1, 2, 3], x, y, [np.pi / 2, np.pi, 0.0])
    warehouses.worlds.step(0)
    warehouses._see(warehouses._all)
    warehouses.step(np.full((1, 3), Action.WAIT))
    _, happened = warehouses.step(np.full((1, 3), Action.FORWARD))
    assert happened["refused"].tolist() == [[False, True, True]]
    assert warehouses.cell[0].tolist() == [middle, middle + 1, middle - 1]


def test_a_robot_at_an_action_goes_on_with_it():
    warehouses = one(decision=0.5, acceleration=1.0)
    warehouses.reset([0], [0])
    while not warehouses.masks()[0, 0, Action.FORWARD]:
        act(warehouses, Action.LEFT)
    before = warehouses.worlds.x.copy(), warehouses.worlds.y.copy()
    act(warehouses, Action.FORWARD)
    assert warehouses.busy[0, 0]
    assert warehouses.masks()[0, 0].tolist() == [True, False, False, False, False]
    for _ in range(4):
        act(warehouses, Action.LEFT)  # not heard
    moved = np.hypot(warehouses.worlds.x - before[0], warehouses.worlds.y - before[1])
    assert moved[0, 0] == pytest.approx(1.0, abs=1e-3)


def test_larger_steps_of_physics_end_in_the_same_places():
    fine, _, _ = random_run(7, decisions=30, physics_step=0.001)
    coarse, _, _ = random_run(7, decisions=30, physics_step=0.05)
    np.testing.assert_allclose(fine.worlds.x, coarse.worlds.x, atol=1e-3)
    np.testing.assert_allclose(fine.worlds.y, coarse.worlds.y, atol=1e-3)
    np.testing.assert_array_equal(fine.load, coarse.load)


def test_a_saved_episode_is_played_again(tmp_path):
    warehouses = one()
    warehouses.reset([0], [4])
    actions = [Action.LEFT, Action.FORWARD, Action.RIGHT, Action.WAIT]
    for action in actions:
        act(warehouses, action)
    file = tmp_path / "episode.json"
    episodes.save(file, warehouses.options, 4, [[int(a)] for a in actions])
    options, seed, saved = episodes.load(file)
    again = Warehouses(1, options, 1)
    again.reset([0], [seed])
    for action in saved:
        again.step(action[None])
    assert again.worlds.state_hash()[0] == warehouses.worlds.state_hash()[0]
    file.write_text("{}")
    with pytest.raises(episodes.EpisodeError, match="episode.json"):
        episodes.load(file)


def test_bad_actions_name_the_robot():
    warehouses = Warehouses(2, Options.of({"robots": 2, "shelves": 6}), 1)
    warehouses.reset([0, 1], [0, 1])
    for actions, said in (
        ([[0, 0]], r"shape \(2, 2\) was expected"),
        ([[0, 5], [0, 0]], "robot_2 of world 0: action .*5.*0 to 4 was expected"),
        ([[0, 0], [-1, 0]], "robot_1 of world 1"),
        ([[0, np.nan], [0, 0]], "robot_2 of world 0: action .*nan"),
        ([[0, 0.5], [0, 0]], "robot_2 of world 0"),
    ):
        with pytest.raises(ActionError, match=said):
            warehouses.step(np.array(actions))
    wheels = Warehouses(1, Options.of({"robots": 1, "shelves": 6, "continuous": True}), 1)
    wheels.reset([0], [0])
    with pytest.raises(ActionError, match="robot_1 of world 0.*three numbers"):
        wheels.step(np.array([[[0.0, np.inf, 0.0]]]))


def test_bad_options_are_named():
    for options, said in (
        ({"size": "vast"}, "size is 'vast'; one of tiny"),
        ({"robots": -1, "shelves": 3}, "robots is -1"),
        ({"requests": 99, "size": "tiny"}, "requests is 99; a whole number from 1 to 11"),
        ({"max_cycles": 0}, "max_cycles"),
        ({"decision": float("nan")}, "decision is nan"),
        ({"rewards": {"profit": 1}}, "rewards has 'profit'"),
        ({"colour": "red"}, "colour is not an option"),
    ):
        with pytest.raises(OptionError, match=said):
            Options.of(options)


@pytest.mark.parametrize(("name", "units"), [("north", 20), ("in_hall", 14)])
def test_a_layout_file_is_learned_in(name, units):
    options = Options(layout=str(LAYOUTS / f"{name}.layout.yaml"), robots=1, requests=1)
    warehouses = Warehouses(1, options, 1)
    assert (warehouses.robots, warehouses.units) == (1, units)
    warehouses.reset([0], [3])
    drive_to_goal(warehouses)
    assert act(warehouses, Action.LIFT)[1]["lifted"].all()
    rng = np.random.default_rng(1)
    for _ in range(100):
        action = rng.choice(np.flatnonzero(warehouses.masks()[0, 0]))
        _, happened = act(warehouses, action)
        assert not happened["refused"].any() and not happened["collided"].any()
    cells = {name: warehouses.grid.point_of(warehouses.cell[0])[i] for i, name in enumerate("xy")}
    for name, at in cells.items():
        assert getattr(warehouses.worlds, name)[0] == pytest.approx(at, abs=0.01)


def test_a_layout_that_is_none_is_reported():
    for options, message in (
        ({"layout": "nix.layout.yaml"}, "layout: .*nix.layout.yaml: No such file"),
        ({"layout": str(LAYOUTS / "blocked.layout.yaml")}, "can't pass each other"),
        ({"layout": "small", "shelves": 3}, "shelves is 3; a layout has its own"),
    ):
        with pytest.raises(OptionError, match=message):
            Options(**options)
