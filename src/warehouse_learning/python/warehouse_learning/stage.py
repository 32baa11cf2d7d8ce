# SPDX-License-Identifier: Apache-2.0
"""What environments of robots have in common, whatever their interface: warehouses, what is
observed of them, who watches, and, of one warehouse, the episode as it goes."""

from pathlib import Path

import numpy as np

from kiva_plugin_cpp import World
from warehouse_learning import episodes
from warehouse_learning.observing import Observer
from warehouse_learning.options import Options
from warehouse_learning.page import Page
from warehouse_learning.picture import Picture
from warehouse_learning.screen import Screen
from warehouse_learning.warehouses import Warehouses


class Stage:
    """The stage of n warehouses; a mixin, to be the first among an environment's bases."""

    def _set_up(
        self, n: int, render_mode: str | None, options: dict[str, object], threads: int
    ) -> None:
        """options: by name, as of warehouse_learning.Options."""
        self.options = Options.of(options)
        self._in = Warehouses(n, self.options, threads)
        self._see = Observer(self._in)
        self.fields, self.state_fields = self._see.fields, self._see.state_fields
        page = lambda: Page(self._in.worlds[0], self.options.title)  # noqa: E731
        picture = lambda: Picture(self._in)  # noqa: E731
        self._screen = Screen(render_mode, picture, page, lambda: self._in.units_requested(0))
        if self._screen.is_watched:
            self._in.on_moved = self._screen.moved

    @property
    def render_mode(self) -> str | None:
        """The render mode: None, "human" or "rgb_array"."""
        return self._screen.mode

    @property
    def page(self) -> Page | None:
        """The Page that shows it, with its `url`; None unless render_mode is "human"."""
        return self._screen.page

    def render(self) -> np.ndarray | None:
        """Returns the picture, (height, width, 3) uint8; shows it and returns None for "human"."""
        return self._screen.render()

    def _masks(self) -> dict[str, np.ndarray]:
        """{"action_mask": (n, robots, 5) int8}; nothing of wheels, which may do anything."""
        if self.options.continuous:
            return {}
        return {"action_mask": self._in.masks().astype(np.int8)}

    def _ends(self) -> np.ndarray:
        """(n,) bool: whose episodes are over."""
        return self._in.cycle >= self.options.max_cycles


class OneWarehouse(Stage):
    """The stage of one warehouse: its episode can be saved."""

    def _set_up_one(self, render_mode: str | None, options: dict[str, object]) -> None:
        self._set_up(1, render_mode, options, threads=1)
        self._seed: int | None = None
        self._actions: list[np.ndarray] = []

    def _begin(self, seed: int) -> None:
        self._seed, self._actions = int(seed), []
        self._in.reset([0], [int(seed)])
        self._screen.stepped()

    def _decide(self, chosen: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray], bool]:
        """One decision, (robots,) or of wheels (robots, 3). Returns rewards (robots,), what
        happened, {name: (robots,)}, and whether the episode is over."""
        rewards, happened = self._in.step(chosen[None])
        self._actions.append(chosen)
        self._screen.stepped()
        happened = {name: events[0] for name, events in happened.items()}
        return rewards[0], happened, bool(self._ends()[0])

    @property
    def world(self) -> World:
        """The kiva_plugin_cpp.World behind the environment."""
        return self._in.worlds[0]

    def state(self) -> np.ndarray:
        """Returns the warehouse, (size,) float32 as in `state_fields`, for central critics."""
        return self._see.state()[0]

    def close(self) -> None:
        """Closes the page, if there is one."""
        self._screen.close()

    def save_episode(self, path: str | Path) -> None:
        """Writes the episode up to now; `python3 -m warehouse_learning.watch` plays it."""
        if self._seed is None:
            raise ValueError("there is no episode yet: reset() begins one")
        episodes.save(path, self.options, self._seed, self._actions)
