# SPDX-License-Identifier: Apache-2.0
"""Learning for several robots: networks, trainings that go on, policies as files, statistics."""

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="gymnasium is missing: scripts/learning_packages")

from gymnasium.vector import AutoresetMode  # noqa: E402

from warehouse_learning.marl import evaluation, policy, statistics  # noqa: E402
from warehouse_learning.marl.encoding import Encoder  # noqa: E402
from warehouse_learning.marl.mlp import Mlp  # noqa: E402
from warehouse_learning.marl.rollouts import Rollouts  # noqa: E402
from warehouse_learning.marl.training import Training, TrainingSettings  # noqa: E402
from warehouse_learning.rware import RwareVectorEnv, options_of  # noqa: E402

# A floor on which chance delivers now and then.
FLOOR = {
    "layout": "g x\n. x\n. .",
    "n_agents": 2,
    "request_queue_size": 1,
    "max_steps": 50,
}

QUICK = {"environments": 32, "rollout": 16, "steps": 30_000, "rate": 3e-3, "discount": 0.95}


def training(seed=0, **settings):
    settings = QUICK | settings
    envs = RwareVectorEnv(settings["environments"], autoreset_mode=AutoresetMode.SAME_STEP, **FLOOR)
    return Training(envs, Encoder.of_task(envs.task), TrainingSettings(**settings), seed)


def save(training, path):
    about = training.record | {"task": "floor"}
    policy.GridPolicy(training.actor, training.encoder, about).save(path)


def test_slopes_are_those_of_the_loss():
    random = np.random.default_rng(1)
    network = Mlp([4, 6, 5, 3], 1.0, random)
    network.parameters = [p.astype(np.float64) for p in network.parameters]
    x, weight = random.standard_normal((7, 4)), random.standard_normal((7, 3))
    _, kept = network.forward(x)
    slopes = network.backward(kept, weight)
    for parameter, slope in zip(network.parameters, slopes):
        flat, at = parameter.reshape(-1), int(np.abs(slope).argmax())
        loss = []
        for shift in (1e-6, -2e-6):
            flat[at] += shift
            loss.append((network.forward(x)[0] * weight).sum())
        flat[at] += 1e-6
        assert (loss[0] - loss[1]) / 2e-6 == pytest.approx(slope.reshape(-1)[at], rel=1e-4)


@pytest.mark.parametrize("algorithm", ["ippo", "mappo"])
def test_a_training_beats_chance(algorithm, tmp_path):
    learnt = training(algorithm=algorithm)
    assert learnt.run()
    save(learnt, tmp_path / "p.npz")
    trained = policy.load(tmp_path / "p.npz")
    returns = evaluation.episodes(evaluation.by_policy(trained), 32, 5, **FLOOR)["returns"]
    chance = evaluation.episodes(evaluation.by_chance, 32, 5, **FLOOR)["returns"]
    assert returns.mean() > chance.mean() + 2, learnt.curve
    assert trained.about["steps"] == learnt.done


def test_rollouts_tell_where_episodes_were_cut():
    envs = RwareVectorEnv(8, autoreset_mode=AutoresetMode.SAME_STEP, **FLOOR)
    encoder = Encoder.of_task(envs.task)
    random = np.random.default_rng(3)
    rollout = Rollouts(envs, encoder, random).collect(Mlp([encoder.size, 5], 0.01, random), 120)
    cut = np.zeros_like(rollout.end)
    for t, which, rows in rollout.cut:
        cut[t] |= which
        assert rows.shape == (which.sum(), 2, encoder.size)
    assert (cut == rollout.end).all()
    # Each begins at another time, then ends after 50 steps, or was reset once more before.
    assert 8 * 2 <= rollout.end.sum() <= 8 * 4
    assert 8 <= len(rollout.finished) <= 16
    assert np.exp(rollout.log).min() > 0.15 and set(np.unique(rollout.action)) == set(range(5))


def test_what_nothing_was_earned_for_changes_little():
    """Rewards are rare: noise of the critic must not count as much as they do."""
    learnt = training()
    rollout = learnt._rollouts.collect(learnt.actor, 16)
    rollout.reward[:] = 0
    advantage, _ = learnt._advantages(rollout)
    assert 0 < advantage.std() < learnt.settings.spread


def test_a_training_goes_on_from_its_checkpoint(tmp_path):
    first = training(steps=4096)
    first.run()
    first.save(tmp_path / "c.npz")
    other = training(steps=4096)
    other.restore(tmp_path / "c.npz")
    assert (other.done, other.curve) == (first.done, first.curve)
    for mine, theirs in zip(first.actor.parameters, other.actor.parameters):
        assert (mine == theirs).all()
    other.settings = TrainingSettings(**vars(other.settings) | {"steps": 8192})
    other.run()
    assert other.done == 8192
    with pytest.raises(ValueError, match="its hidden is 64, not 8"):
        training(steps=4096, hidden=8).restore(tmp_path / "c.npz")


def test_a_training_begins_with_a_policy(tmp_path):
    first = training(steps=4096)
    first.run()
    save(first, tmp_path / "p.npz")
    other = training(seed=3)
    other.take(policy.load(tmp_path / "p.npz"))
    for mine, theirs in zip(first.actor.parameters, other.actor.parameters):
        assert np.allclose(mine, theirs, atol=2e-3)
    with pytest.raises(ValueError, match="of another task"):
        training(hidden=8).take(policy.load(tmp_path / "p.npz"))


def test_the_planner_delivers_more_than_chance_and_without_a_stop():
    options = options_of("tiny-2ag") | {"max_steps": 200}
    returns = evaluation.episodes(evaluation.by_planner, 4, 3, **options)["returns"]
    assert returns.min() >= 5
    with_bodies = evaluation.episodes(evaluation.by_planner, 2, 3, physics="bodies", **options)
    assert with_bodies["returns"].min() >= 4
    assert not with_bodies["collisions"].any()


def test_what_is_no_policy_says_so(tmp_path):
    (tmp_path / "no.npz").write_text("hello")
    with pytest.raises(policy.PolicyError, match="no.npz is not a policy"):
        policy.load(tmp_path / "no.npz")
    with pytest.raises(policy.PolicyError, match="huge-99ag: there is no such file"):
        policy.load("huge-99ag")
    np.savez(tmp_path / "other.npz", about='{"format": "x"}')
    with pytest.raises(policy.PolicyError, match="its format is not"):
        policy.load(tmp_path / "other.npz")


def test_interquartile_means():
    assert statistics.interquartile_mean(np.array([9.0, 1, 2, -50])) == pytest.approx(1.5)
    assert statistics.interquartile_mean(np.arange(5.0)) == pytest.approx(2)


def test_intervals_hold_the_mean_as_often_as_they_say():
    random = np.random.default_rng(0)
    held = 0
    for _ in range(60):
        scores = random.normal(3, 1, 20)
        _, low, high = statistics.interval([scores], lambda s: s.mean(-1), draws=300)
        held += low <= 3 <= high
    assert held >= 50


def test_curves_are_brought_to_the_same_steps():
    curves = [[(1, 1.0), (2, 3.0), (4, 5.0)], [(2, 2.0), (4, 4.0)]]
    at = statistics.aligned(curves, np.array([2.0, 4.0]))
    assert at.tolist() == [[2, 2], [5, 4]]
