# SPDX-License-Identifier: Apache-2.0
"""Policies to measure others by. Each is a function of observations (…, size) and action masks
(…, 5) that returns actions (…,)."""

import argparse
from collections.abc import Callable

import numpy as np

from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.transports.transports import Kind
from warehouse_layout.floor.stations import PICK
from warehouse_learning import building, fields
from warehouse_learning.observing import Observer
from warehouse_learning.options import SIZES, Options
from warehouse_learning.warehouses import Action, Warehouses

Policy = Callable[[np.ndarray, np.ndarray], np.ndarray]

IMPATIENCE = 0.2  # probability that a blocked robot tries another action


def random_policy(seed: int = 0) -> Policy:
    """Returns a policy that takes any of the possible actions."""
    random = np.random.default_rng(seed)

    def act(_observations: np.ndarray, masks: np.ndarray) -> np.ndarray:
        return (masks * random.random(masks.shape)).argmax(-1)

    return act


def greedy_policy(options: Options, seed: int = 0) -> Policy:
    """Returns a policy that goes to the goal by the shortest way, whatever robot is in it."""
    random = np.random.default_rng(seed)
    robot_fields = fields.robot_fields(options)
    turns = np.array([Action.FORWARD, Action.LEFT, Action.LEFT, Action.RIGHT])

    def act(observations: np.ndarray, masks: np.ndarray) -> np.ndarray:
        see = fields.split(observations, robot_fields)
        nearer = see["way"]
        out = turns[nearer.argmax(-1)]
        out = np.where(nearer.max(-1) <= 0, Action.WAIT, out)
        is_there = see["distance"][..., 0] == 0
        carries_asked = see["load"][..., 1] > 0
        has_goal = (see["goal"] != 0).any(-1) | is_there
        lifts = is_there & has_goal & ~carries_asked & (masks[..., Action.LIFT] > 0)
        useless = (see["load"][..., 0] > 0) & ~_beneath_a_request(see)
        out = np.where(lifts & ~useless, Action.LIFT, out)
        possible = np.take_along_axis(masks, out[..., None].astype(int), -1)[..., 0] > 0
        other = (masks[..., :4] * random.random((*masks.shape[:-1], 4))).argmax(-1)
        impatient = ~possible & (random.random(possible.shape) < IMPATIENCE)
        return np.where(possible, out, np.where(impatient, other, Action.WAIT))

    return act


def _beneath_a_request(see: dict[str, np.ndarray]) -> np.ndarray:
    here = see["neighbourhood"]
    middle = here.shape[-2] // 2
    return here[..., middle, middle, fields.LAYERS.index("requested")] > 0


def measure(
    policy: Policy, options: Options, episodes: int = 8, seed: int = 0, threads: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """Returns (episodes,) units delivered in each, and (episodes,) simulated seconds."""
    warehouses = Warehouses(episodes, options, threads)
    observer = Observer(warehouses)
    warehouses.reset(np.arange(episodes), [seed + i for i in range(episodes)])
    for _ in range(options.max_cycles):
        warehouses.step(policy(observer.observations(), warehouses.masks()))
    seconds = np.array([warehouses.worlds[i].time for i in range(episodes)])
    return warehouses.delivered.sum(1), seconds


def measure_planner(options: Options, seconds: float, seed: int = 0) -> int:
    """Returns the units that the fleet's own planner delivers within `seconds` of simulated time.

    As many requests are open as in the task; a delivered unit is released at once."""
    world = building.build(1, options, threads=1)[0][0]
    driver = FleetDriver(world, seed=seed)
    random = np.random.default_rng(seed)
    transports = driver.transports
    stations = [s.name for s in driver.plan.stations if s.kind == PICK]
    delivered = asked = 0
    while world.time < seconds:
        while asked < options.requests:
            units = sorted(set(transports.cell_of_unit) - {t.shelf for t in transports})
            transports.submit(int(random.choice(units)), str(random.choice(stations)))
            asked += 1
        driver.step()
        for event in transports.take_events():
            if event.kind == Kind.ARRIVED:
                delivered, asked = delivered + 1, asked - 1
                transports.release(event.transport_id)
    driver.close()
    return delivered


def main() -> None:
    """Prints how many units random robots, greedy robots and the fleet's planner deliver."""
    parser = argparse.ArgumentParser(
        prog="python3 -m warehouse_learning.baselines", description=main.__doc__
    )
    parser.add_argument("size", nargs="?", choices=SIZES, default="tiny", help="(tiny)")
    options = Options.of({"size": parser.parse_args().size})
    for name, policy in (("random", random_policy()), ("greedy", greedy_policy(options))):
        delivered, seconds = measure(policy, options)
        hourly = 3600 * delivered.sum() / seconds.sum()
        print(f"{name:8} {delivered.mean():7.1f} units an episode, {hourly:7.1f} an hour")
    planned = measure_planner(options, 1800)
    print(f"{'planner':8} {'':7} {'':19} {2 * planned:7.1f} an hour")


if __name__ == "__main__":
    main()
