# SPDX-License-Identifier: Apache-2.0
"""RWARE's task on the floor of a layout file: walls, storage places and stations as drawn."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="gymnasium is missing: scripts/learning_packages")

import warehouse_learning.rware  # noqa: E402
from warehouse_learning.marl import evaluation  # noqa: E402
from warehouse_learning.rware import RwareVectorEnv  # noqa: E402
from warehouse_learning.rware.task import Task  # noqa: E402

NORTH = str(Path(__file__).parents[1] / "layouts/north.layout.yaml")
OPTIONS = {"layout": NORTH, "n_agents": 3, "request_queue_size": 3, "max_steps": 200}


def test_the_floor_is_the_drawing():
    floor = Task(**OPTIONS).floor
    assert floor.grid_size == (9, 20)
    assert floor.walls[0].all() and floor.walls[:, 0].all() and not floor.walls[1, 1:19].any()
    assert np.flatnonzero(floor.highways[2] == 0).tolist() == [3, 4, 6, 7, 9, 10]
    assert len(floor.goals) == 1 and floor.goals[0][0] == 18


def test_agents_are_where_no_wall_is():
    envs = RwareVectorEnv(16, **OPTIONS)
    walls = envs.task.floor.walls.astype(bool)
    random = np.random.default_rng(1)
    observations, _ = envs.reset(seed=1)
    for _ in range(150):
        columns, rows = observations[..., 0].astype(int), observations[..., 1].astype(int)
        assert not walls[rows, columns].any()
        # Mostly forward: they come to walls.
        actions = random.choice(5, (16, 3), p=[0, 0.7, 0.1, 0.1, 0.1])
        observations = envs.step(actions)[0]


@pytest.mark.parametrize("physics", ["grid", "bodies"])
def test_the_planner_delivers(physics):
    results = evaluation.episodes(evaluation.by_planner, 2, 3, physics=physics, **OPTIONS)
    assert results["returns"].min() >= 3
    assert not results.get("collisions", np.zeros(1)).any()


def test_walls_are_drawn_and_not_accessible():
    envs = RwareVectorEnv(1, render_mode="rgb_array", observation_type=_images(), **OPTIONS)
    images, _ = envs.reset(seed=1)
    assert images.shape[1:] == (3, 5, 3, 3)
    picture = envs.render()[0]
    assert (picture[5, 5] == picture[5, 25]).all() and (picture[5, 5] != picture[30, 200]).any()


def _images():
    return warehouse_learning.rware.ObservationType.IMAGE


def test_a_wrong_file_is_told(tmp_path):
    with pytest.raises(ValueError, match=r"none.layout.yaml"):
        Task(layout=str(tmp_path / "none.layout.yaml"))
    bare = tmp_path / "bare.layout.yaml"
    bare.write_text("layout: 1\nfloor: |\n  ....\n  ....\n")
    with pytest.raises(ValueError, match="storage places and a picking station were expected"):
        Task(layout=str(bare))
