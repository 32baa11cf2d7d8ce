# SPDX-License-Identifier: Apache-2.0
"""What `render_mode` means, the same for all environments."""

from warehouse_learning.page import Page

RENDER_MODES = ["human", "rgb_array"]
FRAMES = 4  # a second, of a film


class Screen:
    """Pictures by `make`, a Picture's maker, once somebody wants them."""

    def __init__(self, mode, make):
        if mode not in (None, *RENDER_MODES):
            raise ValueError(f"render_mode is {mode!r}; None or one of {RENDER_MODES} was expected")
        self.mode, self._make = mode, make
        self._picture = self._page = None

    def render(self):
        """The picture as (height, width, 3) uint8, or, for "human", on the page."""
        if self.mode is None:
            return None
        self._picture = self._picture or self._make()
        pixels = self._picture.draw()
        if self.mode == "rgb_array":
            return pixels
        self._page = self._page or Page()
        self._page.show(pixels)
        return None

    def stepped(self):
        """Whoever watches sees every decision."""
        if self.mode == "human":
            self.render()

    def close(self):
        if self._page:
            self._page.close()
            self._page = None
