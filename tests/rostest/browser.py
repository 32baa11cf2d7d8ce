# SPDX-License-Identifier: Apache-2.0
"""The viewer's page in a headless Chromium, drawn in software."""

import tempfile
import time
from contextlib import contextmanager

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--window-size=1280,720",
)


class Browser:
    """One page; `world`, `stage`, … below are of web/js/main.js."""

    def __init__(self, driver, patience):
        self.driver, self._patience = driver, patience

    def open(self, address):
        self.driver.get(address)

    def read(self, expression):
        """The value of a JavaScript expression, in which `page` is the page's object."""
        return self.driver.execute_script(f"const page = window.page; return {expression};")

    def until(self, expression):
        """Waits until an expression holds, and returns its value."""
        end = time.monotonic() + self._patience
        while not (value := self.read(f"page && ({expression})")):
            assert time.monotonic() < end, f"waited in vain: {expression}; {self.complaints()}"
            time.sleep(0.05)
        return value

    def text(self, element):
        return self.read(f"document.getElementById('{element}').textContent")

    def pixel(self, x, y, z=0.0):
        """Where in the window a point of the world is drawn [px]."""
        return self.read(
            f"(p => [(p.x + 1) / 2 * innerWidth, (1 - p.y) / 2 * innerHeight])"
            f"(page.stage.camera.position.clone().set({x}, {y}, {z}).project(page.stage.camera))"
        )

    def click(self, x, y, z=0.0):
        """Clicks what is drawn at that point of the world."""
        px, py = self.pixel(x, y, z)
        for kind in ("mousePressed", "mouseReleased"):
            event = {"type": kind, "x": px, "y": py, "button": "left", "clickCount": 1}
            self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def press(self, key):
        """A key, as a person would."""
        for kind in ("keyDown", "keyUp"):
            event = {"type": kind, "key": key, "text": key if kind == "keyDown" else ""}
            self.driver.execute_cdp_cmd("Input.dispatchKeyEvent", event)

    def complaints(self):
        """What the page's console says is wrong. A refused command is not."""
        log = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
        return [message for message in log if "409 (Conflict)" not in message]


@contextmanager
def browser(patience):
    """A Browser that is closed in the end."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = webdriver.ChromeOptions()
        for option in (*OPTIONS, f"--user-data-dir={profile}"):
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        driver.set_page_load_timeout(patience)
        driver.set_script_timeout(patience)
        try:
            yield Browser(driver, patience)
        finally:
            driver.quit()
