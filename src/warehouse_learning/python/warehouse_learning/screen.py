# SPDX-License-Identifier: Apache-2.0
"""What `render_mode` means, the same for all environments."""

RENDER_MODES = ["human", "rgb_array"]
FRAMES = 4  # a second, of a film


class Screen:
    """Shows an environment: pictures from `make_picture()`, a page from `make_page()`.

    Each is made when it is first needed. Raises ValueError for an unknown mode.
    """

    def __init__(self, mode, make_picture, make_page):
        if mode not in (None, *RENDER_MODES):
            raise ValueError(f"render_mode is {mode!r}; None or one of {RENDER_MODES} was expected")
        self.mode, self._make_picture, self._make_page = mode, make_picture, make_page
        self._picture = self._page = None

    @property
    def is_watched(self):
        """Whether it is shown as it goes."""
        return self.mode == "human"

    @property
    def page(self):
        """The Page that it is shown on; None if it is not."""
        if self.is_watched and not self._page:
            self._page = self._make_page()
        return self._page

    def render(self):
        """The picture as (height, width, 3) uint8, or, for "human", on the page."""
        if self.is_watched:
            self.page.show()
        elif self.mode == "rgb_array":
            self._picture = self._picture or self._make_picture()
            return self._picture.draw()
        return None

    def moved(self, events=()):
        """Brings events and the moved world to the page, and keeps its pace, if there is a page."""
        if self.is_watched:
            self.page.tell(events)
            self.page.moved()

    def stepped(self):
        """Shows the state after a decision, if there is a page."""
        if self.is_watched:
            self.render()

    def close(self):
        if self._page:
            self._page.close()
            self._page = None
