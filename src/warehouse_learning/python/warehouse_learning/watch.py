# SPDX-License-Identifier: Apache-2.0
"""Plays a saved episode on the warehouse's page, on this machine, once the page is open.

python3 -m warehouse_learning.watch episode.json [--speed 5]
"""

import argparse
import sys
import time
from typing import Any

import numpy as np

from warehouse_learning import episodes
from warehouse_learning.page import SPEED, Page
from warehouse_learning.warehouses import Warehouses

POLL = 0.1  # between two checks whether a browser has opened the page [s, wall]


def play(page: Page, warehouses: Warehouses, actions: np.ndarray) -> int:
    """Plays an episode on the page; returns how many units were delivered."""

    def moved(events: Any) -> None:
        page.show_events(events)
        page.moved()

    warehouses.on_moved = moved
    for action in actions:
        warehouses.step(action[None])
    page.show()
    return int(warehouses.delivered.sum())


def main() -> None:
    """Plays the episode of the command line."""
    parser = argparse.ArgumentParser("python3 -m warehouse_learning.watch", description=__doc__)
    parser.add_argument("file", help="episode written by save_episode()")
    speed = "simulated seconds a wall second, 0: as fast as possible (5); the page can change it"
    parser.add_argument("--speed", type=float, default=SPEED, help=speed)
    wanted = parser.parse_args()
    try:
        options, seed, actions = episodes.load(wanted.file)
    except episodes.EpisodeError as error:
        sys.exit(f"watch: {error}")
    warehouses = Warehouses(1, options)
    warehouses.reset([0], [seed])
    page = Page(warehouses.worlds[0], options.title, speed=wanted.speed)
    try:
        while not page.watchers:
            time.sleep(POLL)
        delivered = play(page, warehouses, actions)
        print(f"{len(actions)} decisions, {delivered} units delivered; Ctrl-C ends the page")
        while True:
            time.sleep(3600)
    except KeyboardInterrupt:
        page.close()


if __name__ == "__main__":
    main()
