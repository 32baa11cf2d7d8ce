# SPDX-License-Identifier: Apache-2.0
"""What `render_mode` means, the same for all environments."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from warehouse_learning.page import Page
from warehouse_learning.picture import Picture

RENDER_MODES = ["human", "rgb_array"]
FRAMES = 4  # a second, of a film


class Screen:
    """Shows an environment: pictures from `make_picture()`, a page from `make_page()`.

    Each is made when it is first needed. requested() returns the numbers of the requested
    storage units, which the page marks. Raises ValueError for an unknown mode.
    """

    def __init__(
        self,
        mode: str | None,
        make_picture: Callable[[], Picture],
        make_page: Callable[[], Page],
        requested: Callable[[], Iterable[int]],
    ) -> None:
        if mode not in (None, *RENDER_MODES):
            raise ValueError(f"render_mode is {mode!r}; None or one of {RENDER_MODES} was expected")
        self.mode, self._make_picture, self._make_page = mode, make_picture, make_page
        self._requested = requested
        self._picture: Picture | None = None
        self._page: Page | None = None

    @property
    def is_watched(self) -> bool:
        """Whether a page shows every move."""
        return self.mode == "human"

    @property
    def page(self) -> Page | None:
        """The Page that shows it; None unless render_mode is "human"."""
        return self._shown() if self.is_watched else None

    def _shown(self) -> Page:
        self._page = self._page or self._make_page()
        return self._page

    def render(self) -> np.ndarray | None:
        """Returns the picture, (height, width, 3) uint8; shows it and returns None for "human"."""
        if self.is_watched:
            self._shown().requested(self._requested())
            self._shown().show()
        elif self.mode == "rgb_array":
            self._picture = self._picture or self._make_picture()
            return self._picture.draw()
        return None

    def moved(self, events: Iterable[Any] = ()) -> None:
        """Brings events and the moved world to the page, and keeps its pace, if there is a page."""
        if self.is_watched:
            page = self._shown()
            page.show_events(events)
            page.moved()

    def stepped(self) -> None:
        """Shows the state after a decision, if there is a page."""
        if self.is_watched:
            self.render()

    def close(self) -> None:
        """Closes the page, if there is one."""
        if self._page:
            self._page.close()
            self._page = None
