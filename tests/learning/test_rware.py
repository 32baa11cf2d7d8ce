# SPDX-License-Identifier: Apache-2.0
"""The RWARE that is built in against the package rware itself: bit for bit. RWARE_STEPS, 300, are
compared of each task. Some ids are checked by Gymnasium and PettingZoo, RWARE_IDS=all: all."""

import itertools
import os

import numpy as np
import pytest

MISSING = "rware is missing: scripts/learning_packages brings it from PyPI"
gymnasium = pytest.importorskip("gymnasium", reason=MISSING)
pytest.importorskip("rware", reason=MISSING)

import rware  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402
from pettingzoo.test import parallel_api_test, parallel_seed_test  # noqa: E402
from rware.warehouse import ImageLayer, ObservationType, RewardType  # noqa: E402
from rware.warehouse import Warehouse as Theirs  # noqa: E402

from warehouse_learning import rware as ours  # noqa: E402
from warehouse_learning.rware.task import Task  # noqa: E402

STEPS = int(os.environ.get("RWARE_STEPS", "300"))
LIKELY = [0.05, 0.55, 0.1, 0.1, 0.2]  # mostly forward: robots meet
NAMES = [
    f"{size}-{agents}ag{diff}"
    for size, agents, diff in itertools.product(
        ("tiny", "small", "medium", "large"), (2, 4, 10), ("", "-hard")
    )
]
# Small enough that random robots deliver, and square, as RWARE's own pictures of loads need it.
FLOOR = """
g x x . g
. x x . .
. . . . .
x . . x .
g . . x g
"""
OPTIONS = {
    "shelf_columns": 1,
    "column_height": 3,
    "shelf_rows": 1,
    "n_agents": 5,
    "msg_bits": 0,
    "sensor_range": 1,
    "request_queue_size": 3,
    "max_inactivity_steps": None,
    "max_steps": 100,
    "reward_type": RewardType.INDIVIDUAL,
    "layout": FLOOR,
}
VARIANTS = [
    *({"n_agents": n, "reward_type": reward} for n in (1, 5, 9) for reward in RewardType),
    {"msg_bits": 2},
    {"normalised_coordinates": True, "sensor_range": 2},
    {"observation_type": ObservationType.DICT, "msg_bits": 1},
    {"observation_type": ObservationType.DICT, "normalised_coordinates": True},
    {"max_inactivity_steps": 20, "max_steps": None},
    {"observation_type": ObservationType.IMAGE, "image_observation_layers": list(ImageLayer)},
    {"observation_type": ObservationType.IMAGE, "image_observation_directional": False},
    {"observation_type": ObservationType.IMAGE_DICT, "sensor_range": 3},
    {"layout": None, "shelf_columns": 3, "column_height": 8, "n_agents": 60},
    {"layout": None, "column_height": 8, "n_agents": 30, "request_queue_size": 0},
]


def is_same(a, b):
    """Whether both have the same types of arrays, shapes and bits."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(is_same(a[key], b[key]) for key in a)
    if isinstance(a, (tuple, list)):
        return type(a) is type(b) and len(a) == len(b) and all(map(is_same, a, b))
    if a is None or isinstance(a, bool):
        return a is b
    a, b = np.asarray(a), np.asarray(b)
    return (a.dtype, a.shape, a.tobytes()) == (b.dtype, b.shape, b.tobytes())


def draw(random, agents, bits):
    """An action an agent, with a message if there are bits."""
    actions = random.choice(5, size=agents, p=LIKELY).tolist()
    if not bits:
        return actions
    return [[action, *random.integers(0, 2, bits).tolist()] for action in actions]


def compare(theirs, mine, bits=0):
    """Steps both and returns the sum of rewards."""
    random = np.random.default_rng(1)
    assert theirs.observation_space == mine.observation_space
    assert theirs.action_space == mine.action_space
    assert is_same(theirs.reset(seed=7), mine.reset(seed=7))
    total = 0
    for step in range(STEPS):
        actions = draw(random, theirs.n_agents, bits)
        expected = theirs.step(actions)
        assert is_same(expected, mine.step(actions)), f"step {step}"
        total += sum(expected[1])
        if expected[2]:
            assert is_same(theirs.reset(), mine.reset())
    return total


def make(name):
    return gymnasium.make(name, disable_env_checker=True).unwrapped


@pytest.mark.parametrize("name", NAMES)
def test_registered_tasks(name):
    compare(make(f"rware-{name}-v2"), make(f"kiva-rware-{name}-v2"))


@pytest.mark.filterwarnings("ignore:.*precision lowered")
@pytest.mark.parametrize("variant", VARIANTS, ids=str)
def test_options(variant):
    options = OPTIONS | variant
    rewarded = compare(Theirs(**options), ours.Warehouse(**options), options["msg_bits"])
    if options["layout"] and options["n_agents"] > 1:
        assert rewarded > 0  # else deliveries were not compared


def test_every_name_is_registered():
    rware.image_registration()
    ours.image_registration()
    names = {name for name in gymnasium.registry if name.startswith("rware-")}
    assert len(names) == 228 * 5
    assert {f"kiva-{name}" for name in names} <= gymnasium.registry.keys()


def steps_of(envs, mode, count=250):
    """Observations, rewards and ends of each step of a vector environment."""
    random = np.random.default_rng(3)
    actions = random.choice(5, size=(count, envs.num_envs, 2), p=LIKELY)
    steps = [envs.reset(seed=11)[0]]
    for action in actions:
        steps.append(envs.step(action))
        if mode == AutoresetMode.DISABLED and steps[-1][2].any():
            envs.reset(options={"reset_mask": steps[-1][2]})
    return actions, steps


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize("threads", [1, 2])
def test_vectors_are_single_ones_side_by_side(mode, threads):
    options = {"max_steps": 40, "n_agents": 2}
    envs = ours.RwareVectorEnv(150, threads=threads, autoreset_mode=mode, **options)
    actions, actual = steps_of(envs, mode)
    for i in (0, 1, 149):
        alone = ours.Warehouse(**options)
        assert is_same(np.stack(alone.reset(seed=11 + i)[0]), actual[0][i])
        begins = False
        for action, (observations, rewards, ends, _, infos) in zip(actions[:, i], actual[1:]):
            if begins and mode == AutoresetMode.NEXT_STEP:
                begins = False
                assert is_same(np.stack(alone.reset()[0]), observations[i])
                assert not rewards[i].any()
                continue
            expected = alone.step(action.tolist())
            last = np.stack(expected[0])
            assert (expected[1], expected[2]) == (rewards[i].tolist(), ends[i])
            begins = expected[2]
            if begins and mode == AutoresetMode.SAME_STEP:
                assert is_same(last, infos["final_obs"][i])
                last = np.stack(alone.reset()[0])
            assert is_same(last, observations[i])
            if begins and mode == AutoresetMode.DISABLED:
                alone.reset()


def test_gymnasium_makes_vectors():
    envs = gymnasium.make_vec("kiva-rware-tiny-2ag-v2", num_envs=3)
    assert envs.reset(seed=1)[0].shape == envs.observation_space.shape == (3, 2, 71)
    assert envs.step(envs.action_space.sample())[1].shape == (3, 2)


def checked():
    """Every id that importing RWARE registers, and those with images; or one of forty."""
    ids = [*ours.ids.plain(), *ours.ids.of_images()]
    chosen = ids if os.environ.get("RWARE_IDS") == "all" else ids[::40]
    return [name for name, options in chosen if is_playable(options)]


def is_playable(options):
    """tiny-17ag-easy to tiny-19ag-easy request more shelves than there are."""
    return options["request_queue_size"] <= (Task(**options).floor.highways == 0).sum()


def test_what_the_package_registers_but_can_not_begin_is_refused():
    for name, expected in (("rware", "larger sample"), ("kiva-rware", "request_queue_size is 34")):
        with pytest.raises(ValueError, match=expected):
            make(f"{name}-tiny-17ag-easy-v2").reset(seed=1)
    unplayable = [name for name, options in ours.ids.plain() if not is_playable(options)]
    assert unplayable == [f"rware-tiny-{n}ag-easy-v2" for n in (17, 18, 19)]


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("name", checked())
def test_checkers(name):
    ours.image_registration()
    check_env(make(f"kiva-{name}"), skip_render_check=True, skip_close_check=True)
    parallel_api_test(ours.parallel_env(name, max_steps=5), 12)
    parallel_seed_test(lambda: ours.parallel_env(f"kiva-{name}", max_steps=5), 12)


def test_picture():
    env = ours.Warehouse(**OPTIONS, render_mode="rgb_array")
    assert env.render() is None
    env.reset(seed=1)
    before = env.render()
    assert before.shape == (101, 101, 3)
    env.step([2, 2, 2, 2, 2])
    assert (env.render() != before).any()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"layout": "gx\n."}, "line 2 has 1 cells; 2 were expected"),
        ({"layout": "gy"}, "line 1, cell 2 is 'y'"),
        ({"layout": "x."}, "no goal"),
        ({"n_agents": 0}, "agents is 0"),
        ({"n_agents": 26}, "agents is 26"),
        ({"request_queue_size": 9}, "request_queue_size is 9"),
        ({"layout": None, "shelf_columns": 2}, "shelf_columns is 2"),
        ({"sensor_range": -1}, "sensor_range"),
    ],
)
def test_bad_options(options, said):
    with pytest.raises(ValueError, match=said):
        ours.Warehouse(**OPTIONS | options)


@pytest.mark.parametrize("actions", [[1], [1, 2, 3, 4, 5], [0, 0, 0, 0, -1], [0] * 6])
def test_bad_actions(actions):
    env = ours.Warehouse(**OPTIONS)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step([0] * 5)
    env.reset(seed=1)
    with pytest.raises(ValueError, match="actions"):
        env.step(actions)
