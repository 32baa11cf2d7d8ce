# SPDX-License-Identifier: Apache-2.0
"""The viewer's page in a headless Chromium, drawn in software."""

import base64
import tempfile
import time
from contextlib import contextmanager

from selenium import webdriver
from selenium.common.exceptions import ElementClickInterceptedException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains

SETTLES = 0.3  # [s] within which the page fits the picture to its panels
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
)
# Text, boxes and charts: a processor draws them quicker as itself than as a graphics card.
FRUGAL = (
    "--disable-gpu-rasterization",
    "--disable-accelerated-2d-canvas",
    "--disable-gpu-compositing",
)
# Pages that let a person choose name the theme; others follow the system's.
THEME = """const { dataset } = document.documentElement;
if (dataset.theme) dataset.theme = arguments[0];"""

# A person who was here before is not invited again.
KNOWN = "localStorage.setItem('start-shown', 'yes'); localStorage.setItem('toured', 'yes');"

CENTRE = (
    "(r => [r.x + r.width / 2, r.y + r.height / 2])"
    "(document.getElementById('{}').getBoundingClientRect())"
)
# Brings an element into the middle of the window, and is done once it has stayed there.
BRING = """const [element, settles, done] = arguments;
const at = document.getElementById(element);
const top = () => at.getBoundingClientRect().top;
let [was, since] = [NaN, 0];
const look = () => {
  if (top() !== was) {
    at.scrollIntoView({ block: 'center' });
    [was, since] = [top(), performance.now()];
  }
  if (performance.now() < since + 1000 * settles) requestAnimationFrame(look); else done();
};
look();"""
# A processor that draws sixty pictures a second does little else; eight are enough for tests.
SELDOM = """const draw = requestAnimationFrame;
window.requestAnimationFrame = (act) => setTimeout(() => draw(act), 1000 / 8);"""


class Browser:
    """One page; `world`, `stage`, … below are of web/js/main.js."""

    def __init__(self, driver, patience):
        self.driver, self._patience = driver, patience

    def open(self, address):
        self.driver.get(address)

    def be_phone(self, width=390, height=844):
        """A small window of the kind that fingers tap at; for what is opened from now on."""
        self._be(width, height, has_fingers=True)

    def be_screen(self, width, height):
        """A window of that size with a mouse; for what is opened from now on."""
        self._be(width, height, has_fingers=False)

    def _be(self, width, height, has_fingers):
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": has_fingers}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": has_fingers})

    def be_known(self):
        """Is no newcomer, in what is opened from now on."""
        self._begin_with(f"if (location.protocol.startsWith('http')) {{ {KNOWN} }}")

    def draw_seldom(self):
        """Has the pages that are opened from now on draw eight pictures a second at most."""
        self._begin_with(SELDOM)

    def _begin_with(self, script):
        """Runs a script in each page before its own."""
        self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": script})

    def be_desktop(self):
        """Takes be_phone() and be_screen() back."""
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})

    def wear(self, theme):
        """Dresses the page in "dark" or "light", as the system or a person would, at once."""
        settings = {"prefers-color-scheme": theme, "prefers-reduced-motion": "reduce"}
        features = [{"name": name, "value": value} for name, value in settings.items()]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        self.driver.execute_script(THEME, theme)

    def read(self, expression):
        """The value of a JavaScript expression, in which `page` is the page's object."""
        return self.driver.execute_script(f"const page = window.page; return {expression};")

    def picture(self):
        """A photograph, PNG, however long the page takes to be drawn."""
        return base64.b64decode(self.driver.execute_cdp_cmd("Page.captureScreenshot", {})["data"])

    def until(self, expression):
        """Waits until an expression holds, and returns its value."""
        end = time.monotonic() + self._patience
        while not (value := self.read(f"page && ({expression})")):
            assert time.monotonic() < end, f"waited in vain: {expression}; {self._told()}"
            time.sleep(0.05)
        return value

    def _told(self):
        """What the page says to a person and to its console."""
        said = {name: self.text(name) for name in ("tip", "answer", "name", "link")}
        return f"{said}; {self.complaints()}"

    def text(self, element):
        return self.read(f"document.getElementById('{element}')?.textContent")

    def pixel(self, x, y, z=0.0):
        """Where in the window a point of the world is drawn [px]."""
        return self.read(
            f"(p => [(p.x + 1) / 2 * innerWidth, (1 - p.y) / 2 * innerHeight])"
            f"(page.stage.camera.position.clone().set({x}, {y}, {z}).project(page.stage.camera))"
        )

    def click(self, x, y, z=0.0):
        """Clicks what is drawn at that point of the world, once panels push it about no more."""
        at, before = self.pixel(x, y, z), None
        while at != before:
            time.sleep(SETTLES)
            at, before = self.pixel(x, y, z), at
        self.click_at(*at)

    def click_at(self, px, py):
        """Clicks a point of the window [px]."""
        for kind in ("mousePressed", "mouseReleased"):
            event = {"type": kind, "x": px, "y": py, "button": "left", "clickCount": 1}
            self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def tap(self, px, py):
        """Touches a point of the window [px]."""
        self.swipe([(px, py)])

    def tap_on(self, element):
        """Touches the middle of an element, by its id."""
        self.tap(*self.read(CENTRE.format(element)))

    def tap_until(self, element, expression):
        """Touches the middle of an element, by its id, until an expression holds: a page that is
        alive may move the element away from under a finger, and a person then taps again."""
        end = time.monotonic() + self._patience
        while not self.read(f"page && ({expression})"):
            assert time.monotonic() < end, f"tapped in vain: {expression}; {self._told()}"
            self.tap(*self.bring(element))
            time.sleep(SETTLES)

    def bring(self, element):
        """Brings an element, by its id, into view; returns its middle [px]. A window that has just
        changed its size moves what it shows for a while."""
        self.driver.execute_async_script(BRING, element, SETTLES)
        return self.read(CENTRE.format(element))

    def swipe(self, *paths):
        """Moves fingers, one along each path of points of the window [px]; paths are as long as
        each other."""
        for i, points in enumerate(zip(*paths)):
            self.touch("touchMove" if i else "touchStart", *points)
        self.touch("touchEnd")

    def touch(self, kind, *points):
        """Fingers at points of the window [px]; touchStart, touchMove or touchEnd."""
        touches = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        event = {"type": kind, "touchPoints": touches}
        self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", event)

    def drop(self, path, px, py):
        """Lets a file go over a point of the window [px], as if it came from elsewhere."""
        data = {"items": [], "files": [str(path)], "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            event = {"type": kind, "x": px, "y": py, "data": data}
            self.driver.execute_cdp_cmd("Input.dispatchDragEvent", event)

    def click_on(self, element):
        """Clicks an element, by its id, where a person would: once nothing lies over its middle,
        as it may while a page that is alive moves it."""
        end = time.monotonic() + self._patience
        while True:
            try:
                self.driver.find_element("id", element).click()
                return
            except ElementClickInterceptedException:
                if time.monotonic() > end:
                    raise
                time.sleep(SETTLES)

    def type(self, keys, element=None):
        """Presses keys one by one: in an element that is clicked first, or where the focus is."""
        if element:
            self.click_on(element)
        for key in keys:
            ActionChains(self.driver).send_keys(key).perform()

    def complaints(self):
        """What the page's console says is wrong. A refused command is not."""
        log = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
        return [message for message in log if "409 (Conflict)" not in message]


@contextmanager
def browser(patience, size=(1280, 720), is_newcomer=False, is_frugal=True):
    """A Browser that is closed in the end, its window of that size [px].

    is_newcomer: the floor's page invites, as it does a person at first. is_frugal: it draws seldom,
    and without a graphics card that the processor plays; False: as a person's browser does.
    """
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = webdriver.ChromeOptions()
        window = f"--window-size={size[0]},{size[1]}"
        frugal = FRUGAL if is_frugal else ()
        for option in (*OPTIONS, *frugal, window, f"--user-data-dir={profile}"):
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        driver.set_page_load_timeout(patience)
        driver.set_script_timeout(patience)
        try:
            page = Browser(driver, patience)
            if not is_newcomer:
                page.be_known()
            if is_frugal:
                page.draw_seldom()
            yield page
        finally:
            driver.quit()
