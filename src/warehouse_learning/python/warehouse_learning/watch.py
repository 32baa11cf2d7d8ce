# SPDX-License-Identifier: Apache-2.0
"""Plays a saved episode on a page of this machine.

python3 -m warehouse_learning.watch episode.json [--rate 4]
"""

import argparse
import sys
import time

from warehouse_learning import episodes
from warehouse_learning.page import Page
from warehouse_learning.picture import Picture
from warehouse_learning.warehouses import Warehouses


def main():
    parser = argparse.ArgumentParser("python3 -m warehouse_learning.watch", description=__doc__)
    parser.add_argument("file", help="an episode, as save_episode() writes it")
    parser.add_argument("--rate", type=float, default=4, help="decisions a second (4)")
    wanted = parser.parse_args()
    try:
        options, seed, actions = episodes.load(wanted.file)
    except episodes.EpisodeError as error:
        sys.exit(f"watch: {error}")
    warehouses = Warehouses(1, options)
    warehouses.reset([0], [seed])
    page, picture = Page(), Picture(warehouses)
    page.show(picture.draw())
    for action in actions:
        time.sleep(1 / wanted.rate)
        warehouses.step(action[None])
        page.show(picture.draw())
    delivered = int(warehouses.delivered.sum())
    print(f"{len(actions)} decisions, {delivered} units delivered; Ctrl-C ends the page")
    try:
        while True:
            time.sleep(3600)
    except KeyboardInterrupt:
        page.close()


if __name__ == "__main__":
    main()
