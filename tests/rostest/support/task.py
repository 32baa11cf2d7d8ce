# SPDX-License-Identifier: Apache-2.0
"""What a person wants, done with mouse and keys alone, in a count of steps that is kept small."""

import json

from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

MOST_STEPS = 5
VISIBLE = "(e => e?.checkVisibility() && !e.disabled)(document.querySelector({}))"


class Task:
    """Counts the steps on a Browser's page: a click, a choice, or a text that is typed. In the end
    there must be no more than MOST_STEPS."""

    def __init__(self, page, name):
        self.page, self.name, self.steps = page, name, []

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            print(f"{self.name}: {len(self.steps)} steps: {', '.join(self.steps)}", flush=True)
            assert len(self.steps) <= MOST_STEPS, (self.name, self.steps)

    def _element(self, selector):
        self.page.until(VISIBLE.format(json.dumps(selector)))
        return self.page.driver.find_element("css selector", selector)

    def click(self, selector):
        """Clicks an element once it is to be seen and can be pressed."""
        self._element(selector).click()
        self.steps.append(f"click {selector}")

    def choose(self, selector, value):
        """Chooses an option."""
        Select(self._element(selector)).select_by_value(value)
        self.steps.append(f"choose {value}")

    def type(self, selector, text):
        """Types a text into a field, in place of what is in it."""
        element = self._element(selector)
        element.send_keys(Keys.CONTROL, "a")
        element.send_keys(text)
        self.steps.append(f"type {text.strip(Keys.ENTER)}")

    def point(self, x, y, z=0.0):
        """Clicks what is drawn at that point of the world."""
        self.page.click(x, y, z)
        self.steps.append(f"click at {x:g}, {y:g}")

    def search(self, text):
        """Types what is searched on the floor, and Enter."""
        self.type("#search", text + Keys.ENTER)
