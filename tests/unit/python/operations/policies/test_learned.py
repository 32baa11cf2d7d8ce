# SPDX-License-Identifier: Apache-2.0
"""Policies that were learnt: what they see, their files, and shifts by them."""

import numpy as np
import pytest
from operations_site import site

from warehouse_fleet.planners import scorer
from warehouse_operations import Operations, Policies, PolicyError
from warehouse_operations.policies import decisions, learned
from warehouse_operations.runs import simulation
from warehouse_operations.stock.protocols import Task

ROLES = "orders", "units", "robots"


def shift(policies):
    """Its figures, but for those of the clock."""
    ops = Operations(site=site(robots=6), physics=False, policies=policies)
    ops.run(minutes=8)
    figures = ops.kpis()
    return {name: figures[name] for name in figures.keys() - {"wall_s", "real_time_factor"}}


@pytest.mark.parametrize("role", ROLES)
def test_what_takes_the_usual_is_the_default_policy(role, monkeypatch):
    """The figures are equal to the piece: the shortlist always has the usual choice."""
    monkeypatch.setattr(learned, "best_of", lambda scorer: lambda decision: decision.usual)
    figures = shift({role: "learned"})
    assert figures["items_picked"] > 30
    assert figures == shift({})


@pytest.mark.parametrize("role", ROLES)
def test_a_file_decides(role, tmp_path):
    scorer.linear(np.random.default_rng(1).standard_normal(decisions.FEATURES)).save(
        tmp_path / "mine.npz", role
    )
    policies = {role: {"name": "learned", "file": str(tmp_path / "mine.npz")}}
    assert shift(policies) != shift({})


def test_a_file_lies_beside_the_policies(tmp_path, monkeypatch):
    """Nodes of ROS run in another folder."""
    scorer.linear(np.zeros(decisions.FEATURES)).save(tmp_path / "mine.npz", "units")
    (tmp_path / "p.yaml").write_text("units: {name: learned, file: mine.npz}\n")
    monkeypatch.chdir("/")
    assert Policies.read(tmp_path / "p.yaml").choices["units"]["file"] == str(tmp_path / "mine.npz")


def test_scores_are_those_of_the_network():
    weights = np.zeros((8, 2)), np.array([0.5, -1.0]), np.array([2.0, 1.0]), np.zeros(8)
    weights[0][1, 0] = 1.0
    weights[3][2] = 3.0
    rows = np.zeros((2, 8), np.float32)
    rows[1, 1:3] = 0.25, 1.0
    scores = scorer.Scorer(weights).scores(rows)
    assert scores[0] == pytest.approx(2 * np.tanh(0.5) + np.tanh(-1.0))
    assert scores[1] == pytest.approx(2 * np.tanh(0.75) + np.tanh(-1.0) + 3)


def test_a_robot_is_chosen_of_those_that_are_free():
    task = Task(1, 7, "pick1", 2, 3)
    seconds = np.array([[30.0, 5.0, 60.0], [1.0, 90.0, 90.0]])
    decision = decisions.decision_on_robot(task, seconds, np.array([0, 2]))
    assert decision.keys == [0, 2] and decision.usual == 0
    assert decision.rows[:, 0].tolist() == [0.5, 1.0]
    assert decision.rows[:, 2] == pytest.approx([1 / 60, 1.5])
    assert decision.rows[0, 5:7].tolist() == [0.5, 0.5]


def bad_files(folder):
    good = scorer.linear(np.zeros(8))
    good.save(folder / "orders.npz", "orders")
    (folder / "text.npz").write_text("hello")
    np.savez(folder / "other.npz", format="else")
    weights = {"into": np.zeros((3, 1)), "bias": np.zeros(1), "out": np.zeros(1)}
    np.savez(
        folder / "small.npz", format=scorer.FORMAT, role="units", straight=np.zeros(8), **weights
    )


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("none.npz", "No such file"),
        ("text.npz", "text.npz: "),
        ("other.npz", "its format is not 'kiva-dispatcher 1'"),
        ("orders.npz", "it was learnt for the role orders, not units"),
        ("small.npz", "into is float64 of shape (3, 1), not numbers (8, -1)"),
    ],
)
def test_wrong_files_are_told(file, said, tmp_path):
    bad_files(tmp_path)
    (tmp_path / "p.yaml").write_text(f"units: {{name: learned, file: {tmp_path}/{file}}}\n")
    with pytest.raises(PolicyError) as error:
        Policies.read(tmp_path / "p.yaml")
    assert said in str(error.value) and "p.yaml: units: learned: file: " in str(error.value)


def test_ideal_robots_have_no_planner():
    described = simulation.Description(size="small", physics=False, planner={"planner": "learned"})
    with pytest.raises(simulation.ERRORS, match="planner: ideal robots pass through each other"):
        simulation.open_operations(described)
