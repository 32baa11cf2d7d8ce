# SPDX-License-Identifier: Apache-2.0
"""The layout editor in a browser, as tests lead it: by mouse, fingers and keys."""

import time
import urllib.request

import paths
from page_program import served
from rostest_support.browser import browser  # noqa: F401 (for the tests)

from warehouse_layout.file import layout_file
from warehouse_layout.file.request import PRESETS

PATIENCE = 60.0  # with a machine that has much to do [s, wall]
EDIT = paths.ROOT / "src" / "warehouse_viewer" / "nodes" / "edit"
WHERE = """(() => {{
  const [x, y] = page.editor.view.centreOf([{}, {}]);
  const box = document.getElementById('overlay').getBoundingClientRect();
  return [box.left + x, box.top + y];
}})()"""
LINES = """(() => {
  const b = page.editor.bounds, row = (r) => Array.from({ length: b.right - b.left },
    (_, i) => page.editor.drawing.get(b.left + i, r)).join('');
  return b && Array.from({ length: b.top - b.bottom }, (_, i) => row(b.top - 1 - i));
})()"""


def editor(file=None):
    """The address of `edit FILE`."""
    return served(EDIT, *([file] if file else []))


def paper(chromium, address):
    chromium.open(address)
    chromium.read("localStorage.clear()")
    # What the page keeps as it is left is not to come back.
    chromium.read("(page && (page.store.keep = () => {}))")
    chromium.open(address)
    chromium.until("Boolean(page.store) && page.editor.view.width > 0")


def at(page, cell):
    """Where in the window a cell is [px]."""
    return page.read(WHERE.format(*cell))


def mouse(page, kind, cell, pressed=1):
    x, y = at(page, cell)
    event = {"type": kind, "x": x, "y": y, "button": "left", "buttons": pressed, "clickCount": 1}
    page.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)


def drag(page, *cells):
    mouse(page, "mouseMoved", cells[0], 0)
    mouse(page, "mousePressed", cells[0])
    for cell in cells[1:]:
        mouse(page, "mouseMoved", cell)
    mouse(page, "mouseReleased", cells[-1], 0)


def keys(page, text):
    page.driver.switch_to.active_element.send_keys(text)


def press(page, key, control=False):
    """A key that is not a character, or one with control, where the focus is."""
    page.driver.execute_script(
        "document.activeElement.dispatchEvent(new KeyboardEvent('keydown',"
        " {key: arguments[0], ctrlKey: arguments[1], bubbles: true, cancelable: true}))",
        key,
        control,
    )


def lines(page):
    """The drawing, the highest line first; None if there is none."""
    return page.read(LINES)


def checked(page):
    """Waits until the present drawing is checked; returns the sentences."""
    page.until("!page.checker.isAsking && !page.checker.isStale")
    return page.read("page.editor.faults.map((fault) => fault.text)")


def open_drawing(page, preset):
    counts = vars(PRESETS[preset])
    fields = {"robots": "robots", "units": "shelves", "items": "items", "stations": "belts"}
    asked = {name: counts[count] for name, count in fields.items()}
    page.driver.set_script_timeout(PATIENCE)
    page.driver.execute_async_script(
        "const done = arguments[1]; fetch('/layout/new', {method: 'POST', body:"
        " JSON.stringify(arguments[0])}).then((r) => r.json()).then((d) => { page.editor.open(d);"
        " done(); })",
        asked,
    )


LOADED = """performance.getEntriesByType('resource').filter((r) => r.initiatorType !== 'fetch')
  .map((r) => r.name)"""


# How long it takes to draw all that is in sight, the median [ms]; pixels that are read are drawn.
REDRAWN = """(() => {
  const times = Array.from({ length: 21 }, () => {
    const began = performance.now();
    page.editor.isStale = true;
    page.editor.paint();
    for (const { pen } of [page.editor.sheet, page.editor.overlay]) pen.getImageData(0, 0, 1, 1);
    return performance.now() - began;
  });
  return times.sort((a, b) => a - b)[10];
})()"""


def packed(url):
    """A file of the page as a browser gets it."""
    request = urllib.request.Request(url, headers={"accept-encoding": "gzip"})
    with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
        return answer.read()


def saved(page, folder):
    """The text of the file that the page downloads, in our own hand."""
    allowed = {"behavior": "allow", "downloadPath": str(folder)}
    page.driver.execute_cdp_cmd("Page.setDownloadBehavior", allowed)
    page.click_on("save")
    page.until("document.getElementById('said').textContent.startsWith('Downloaded')")
    name = page.text("said").removeprefix("Downloaded ")
    end = time.monotonic() + PATIENCE
    while not (folder / name).exists():
        assert time.monotonic() < end, f"{name} does not come"
        time.sleep(0.05)
    return layout_file.text_of(layout_file.read(folder / name))
