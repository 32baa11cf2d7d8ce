#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Teaches a network to plan for a fleet, by the example of the fleet's own planner, EPIBT.

examples/planner_train.py --out planner.npz

Then in a file for simulate --planner, or a warehouse's planner:= :

    planner: learned
    options: {file: planner.npz}

A fleet at work is driven by EPIBT first, then by the network and by EPIBT in turns, which says all
the while what it would do (DAgger: Ross et al., 2011).
"""

import argparse

import numpy as np

from kiva_plugin_cpp import World
from warehouse_fleet import Rules, epibt
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.planners import scorer
from warehouse_fleet.planners.learned_planner import ROLE, Learned, Rollout
from warehouse_fleet.planners.local_view import LocalView
from warehouse_fleet.planners.plan_loop import GUIDANCE, HORIZON
from warehouse_learning.marl.mlp import Adam, log_softmax

BATCH, RATE = 512, 3e-3


def main():
    options = arguments()
    try:
        teach(options)
    except KeyboardInterrupt:
        raise SystemExit(130) from None


def teach(options):
    """Writes the network after each round."""
    network = beginning(options.hidden, np.random.default_rng(options.seed))
    inputs, targets = [], []
    for number in range(options.rounds):
        for size in options.size:
            teacher = Teacher(network, leads=number / options.rounds, seed=number)
            stored = drive(size, teacher, 60 * options.minutes, number)
            inputs += teacher.inputs
            targets += teacher.targets
            print(
                f"round {number}, {size}: {stored} units stored, {len(inputs):,} ticks", flush=True
            )
        agrees = learn(network, np.concatenate(inputs), np.concatenate(targets), options.steps)
        print(f"  {agrees:.1%} of what it would do is what EPIBT does", flush=True)
        network.save(options.out, ROLE, about=repr(vars(options)))


def arguments():
    parser = argparse.ArgumentParser(
        "planner_train", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--size", nargs="+", default=["small", "medium"], help="(small medium)")
    parser.add_argument("--rounds", type=int, default=4, help="(4)")
    parser.add_argument("--minutes", type=float, default=4, help="of each round and size (4)")
    parser.add_argument("--steps", type=int, default=3000, help="of learning, each round (3000)")
    parser.add_argument("--hidden", type=int, default=24, help="cells (24); 0: a linear one")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", default="planner.npz")
    return parser.parse_args()


def beginning(hidden, random):
    """A Scorer that goes where it gets nearer."""
    straight = np.zeros(LocalView.FEATURES)
    straight[0] = 4.0
    into = 0.5 * random.standard_normal((LocalView.FEATURES, hidden))
    return scorer.Scorer([into, np.zeros(hidden), np.zeros(hidden), straight])


class Teacher:
    """A planner that does what EPIBT does, or what the network does, and keeps what it saw: rows
    (robots, 5, features) with -inf in the first of what is no candidate, and EPIBT's choices."""

    def __init__(self, network, leads, seed):
        self.learner, self.leads = Learned(), leads
        self.learner.scorer = network
        self.random = np.random.default_rng(seed)
        self.inputs, self.targets = [], []

    def start(self, floor):
        rules = Rules(turning=True)
        self.epibt = epibt(floor, rules, 1, horizon=HORIZON, threads=1, **GUIDANCE)
        self.learner.start(floor, rules, 1)

    def prepare(self, seconds=0.0):
        pass

    def plan(self, fleet, seconds=0.0, attempts=-1):
        actions = self.epibt.plan(fleet, seconds, attempts)
        own = self.learner.plan(fleet)
        self.watch(fleet, actions)
        return own if self.random.random() < self.leads else actions

    def watch(self, fleet, actions):
        """Keeps what each robot sees on its way by a plan, and which cell it enters next."""
        view = self.learner.view
        rollout = Rollout(view, fleet, self.learner.rules, self.learner.waited)
        cells = self.cells(rollout, actions)
        rollout = Rollout(view, fleet, self.learner.rules, self.learner.waited)
        for tick in range(0, actions.shape[1] - 3, 2):
            while rollout.at < tick:
                rollout.perform(actions[:, rollout.at])
            rows, possible = view.rows(rollout.scene)
            targets = view.targets(rollout.scene)
            later = cells[tick + 1 :]
            leaves = later != cells[tick]
            enters = np.where(
                leaves.any(0), later[leaves.argmax(0), np.arange(len(fleet))], cells[tick]
            )
            choice = (targets == enters[:, None]).argmax(1)
            rows[..., 0] = np.where(possible, rows[..., 0], -np.inf)
            kept = rollout.is_free() & possible[np.arange(len(fleet)), choice] & (fleet.goal >= 0)
            self.inputs.append(rows[kept])
            self.targets.append(choice[kept])

    def cells(self, rollout, actions):
        out = [rollout.scene.cell]
        for tick in actions.T:
            rollout.perform(tick)
            out.append(rollout.scene.cell)
        return np.array(out)


def drive(size, teacher, seconds, seed):
    """Units that a fleet stores in so much simulated time."""
    world = World.preset(size, seed=seed)
    driver = FleetDriver(world, seed=seed)
    teacher.start(driver.plan.floor())
    driver.traffic.plans.planner = teacher
    demand = RandomTransports(driver.transports, seed)
    stored = 0
    while world.time < seconds:
        events = driver.transports.take_events()
        stored += sum(event.kind.name == "STORED" for event in events)
        demand.advance(world.time, events)
        driver.step()
    driver.close()
    return stored


def learn(network, rows, choices, steps):
    """Makes EPIBT's choices likely, by cross entropy; returns how many are the likeliest."""
    random = np.random.default_rng(0)
    parameters = [network.into, network.bias, network.out, network.straight]
    adam = Adam(parameters)
    possible = rows[..., 0] > -np.inf
    rows = np.where(possible[..., None], rows, 0).astype(np.float64)
    for _ in range(steps):
        drawn = random.integers(len(rows), size=BATCH)
        x, there, choice = rows[drawn], possible[drawn], choices[drawn]
        hidden = np.tanh(x @ network.into + network.bias)
        scores = np.where(there, hidden @ network.out + x @ network.straight, -30)
        slope = np.exp(log_softmax(scores))
        slope[np.arange(BATCH), choice] -= 1
        slope = slope / BATCH * there
        back = slope[..., None] * network.out * (1 - hidden**2)
        flat = x.reshape(-1, x.shape[-1])
        into = flat.T @ back.reshape(len(flat), -1)
        out = np.einsum("bch,bc->h", hidden, slope)
        straight = np.einsum("bcf,bc->f", x, slope)
        adam.step([into, back.sum((0, 1)), out, straight], RATE)
    scores = np.where(possible, network.scores(rows), -np.inf)
    return (scores.argmax(1) == choices).mean()


if __name__ == "__main__":
    main()
