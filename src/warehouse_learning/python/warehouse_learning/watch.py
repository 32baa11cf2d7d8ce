# SPDX-License-Identifier: Apache-2.0
"""Plays a saved episode, or lets robots drive by a trained policy, on the warehouse's page, on this
machine, once the page is open.

python3 -m warehouse_learning.watch episode.json [--speed 5]
python3 -m warehouse_learning.watch --policy tiny-4ag
"""

import argparse
import contextlib
import itertools
import sys
import time
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, cast

import numpy as np

from kiva_plugin_cpp import World
from warehouse_learning import episodes
from warehouse_learning.page import SPEED, Event, Page
from warehouse_learning.warehouses import Warehouses

if TYPE_CHECKING:
    from warehouse_learning.marl.policy import GridPolicy
    from warehouse_learning.rware.env import Warehouse
    from warehouse_learning.rware.motion import BodyMotion

POLL = 0.1  # between two checks whether a browser has opened the page [s, wall]


def play(page: Page, warehouses: Warehouses, actions: np.ndarray) -> int:
    """Plays an episode on the page; returns how many units were delivered."""

    def moved(events: Iterable[Event]) -> None:
        page.show_events(events)
        page.moved()

    warehouses.on_moved = moved
    for action in actions:
        page.requested(warehouses.units_requested(0))
        warehouses.step(action[None])
    page.show()
    return int(warehouses.delivered.sum())


def drive(page: Page, env: "Warehouse", policy: "GridPolicy", seed: int) -> float:
    """Lets an environment's robots drive by a policy for an episode; returns what they earned."""

    def moved(events: Iterable[Event]) -> None:
        page.show_events(events)
        page.moved()

    bodies = cast("BodyMotion", env.motion)
    bodies.on_moved = moved
    random = np.random.default_rng(seed)
    observations, _ = env.reset(seed=seed)
    total, ends = 0.0, False
    while not ends:
        page.requested(env.requested)
        actions = policy.act(np.stack(observations), random)
        observations, rewards, ends, _, _ = env.step(actions.tolist())
        total += sum(rewards)
    page.show()
    return total


def main() -> None:
    """Plays what the command line names."""
    parser = argparse.ArgumentParser(
        "python3 -m warehouse_learning.watch",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", nargs="?", help="episode written by save_episode()")
    parser.add_argument("--policy", help="file, or one that is shipped, that examples/ trained")
    parser.add_argument("--seed", type=int, default=0, help="of the policy's first episode (0)")
    speed = "simulated seconds a wall second, 0: as fast as possible (5); the page can change it"
    parser.add_argument("--speed", type=float, default=SPEED, help=speed)
    args = parser.parse_args()
    if (args.file is None) == (args.policy is None):
        parser.error("an episode's file or --policy was expected, one of them")
    try:
        (_watch_policy if args.policy else _watch_episode)(args)
    except KeyboardInterrupt:
        sys.exit(130)


def _watch_episode(args: argparse.Namespace) -> None:
    try:
        options, seed, actions = episodes.load(args.file)
    except episodes.EpisodeError as error:
        sys.exit(f"watch: {error}")
    warehouses = Warehouses(1, options)
    warehouses.reset([0], [seed])
    with _open(warehouses.worlds[0], options.title, args.speed) as page:
        delivered = play(page, warehouses, actions)
        print(f"{len(actions)} decisions, {delivered} units delivered; Ctrl-C ends the page")
        while True:
            time.sleep(3600)


def _watch_policy(args: argparse.Namespace) -> None:
    from warehouse_learning.marl import policy
    from warehouse_learning.rware import options_of
    from warehouse_learning.rware.env import Warehouse

    try:
        trained = policy.load(args.policy)
    except policy.PolicyError as error:
        sys.exit(f"watch: {error}")
    task = trained.about["task"]
    env = Warehouse(physics="bodies", **options_of(task))
    env.reset(seed=args.seed)
    bodies = cast("BodyMotion", env.motion)
    with _open(bodies.worlds[0], f"{task}, by {args.policy}", args.speed) as page:
        for seed in itertools.count(args.seed):
            print(f"episode {seed}: {drive(page, env, trained, seed):g} delivered; Ctrl-C ends it")


@contextlib.contextmanager
def _open(world: World, title: str, speed: float) -> Iterator[Page]:
    """A Page, once a browser has it open, and until then."""
    page = Page(world, title, speed=speed)
    try:
        while not page.watchers:
            time.sleep(POLL)
        yield page
    finally:
        page.close()


if __name__ == "__main__":
    main()
