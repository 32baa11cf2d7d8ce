# SPDX-License-Identifier: Apache-2.0
"""The layout editor in a real browser, drawn in by mouse, fingers and keys; no ROS runs.

`pytest -s` shows how long frames take, and how large the page is.
"""

import numpy as np
import pytest
from editor_page import (
    LOADED,
    PATIENCE,
    REDRAWN,
    at,
    browser,
    checked,
    drag,
    editor,
    keys,
    lines,
    mouse,
    open_drawing,
    packed,
    paper,
    press,
    saved,
)
from rostest_support import axe, pictures
from rostest_support.task import Task

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFile, StationEntry
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator
from warehouse_layout.place import file_check

# The links that a running warehouse has, with a count of alarms.
ALL_LINKS = """document.querySelector('.site').innerHTML =
  ['Floor', 'Operations<span class="badge needs-help count">12</span>', 'Layout', 'What-if', 'API',
    'Docs'].map((title) => `<a href="/">${title}</a>`).join('')"""
# Buttons and links that lie beside the window, or beneath something else.
OUT_OF_SIGHT = """[...document.querySelectorAll('.top :is(button, a, input), .acts button')]
  .filter((element) => element.checkVisibility()).filter((element) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    const hit = document.elementFromPoint(left + width / 2, top + height / 2);
    return left < 0 || left + width > innerWidth || !element.contains(hit);
  }).map((element) => element.id || element.textContent)"""


@pytest.fixture(scope="module")
def address():
    with editor() as where:
        yield where


@pytest.fixture(scope="module")
def chromium():
    with browser(PATIENCE, (1280, 800)) as opened:
        yield opened


@pytest.fixture
def page(chromium, address):
    """Empty paper."""
    paper(chromium, address)
    yield chromium
    assert chromium.complaints() == []


def draw_first(page):
    """The layout of doc/how-to/editor.md: two aisles, two stations, six robots."""
    keys(page, "r.")
    drag(page, (0, 0), (15, 10))
    keys(page, "s")
    drag(page, (3, 2), (11, 3))
    drag(page, (3, 5), (11, 6))
    keys(page, "p")
    drag(page, (2, 9), (9, 9))
    page.driver.find_element("css selector", "[data-char='A–Z']").click()
    keys(page, "d")
    drag(page, (14, 3))
    drag(page, (14, 7))
    field = page.driver.find_element("id", "own-robots")
    field.clear()
    field.send_keys("6\n")


def test_a_first_layout_is_drawn_tried_and_saved(chromium, tmp_path):
    file = tmp_path / "first.layout.yaml"
    with editor(file) as address:
        paper(chromium, address)
        draw_first(chromium)
        assert checked(chromium) == []
        chromium.click_on("try")
        chromium.until("document.getElementById('trial').dataset.phase === 'done'")
        assert int(chromium.text("trial-pieces").replace(",", "")) > 100
        assert chromium.read("page.editor.heat.values.some((value) => value > 0)")
        chromium.click_on("save")
        chromium.until("document.getElementById('said').textContent.startsWith('saved')")
        assert chromium.complaints() == []
        # The trial's process may be about to end: the page, not the server, leaves its answer.
        chromium.open("about:blank")
    drawn = layout_file.read(file)
    assert file_check.faults(drawn) == []
    assert (drawn.robots, len(drawn.stations), np.sum(drawn.floor == "s")) == (6, 2, 36)


def test_ten_robots_are_drawn_and_tried_in_five_steps(page):
    with Task(page, "ten robots drawn and tried") as task:
        task.click("#new")
        task.type("#new-robots", "10")
        task.click("#creator [value=yes]")
        page.until("page.editor.drawing.places > 0 && !page.checker.isStale")
        task.click("#try")
    page.until("document.getElementById('trial').dataset.phase === 'done'")
    assert page.text("count-robots") == "10"
    assert int(page.text("trial-pieces").replace(",", "")) > 100


def test_the_page_is_for_all_and_looks_as_it_did(page):
    open_drawing(page, "medium")
    assert checked(page) == []
    assert axe.findings(page) == []
    for button in ("new", "help"):
        page.click_on(button)
        page.until("document.querySelector('dialog[open]')")
        assert axe.findings(page, "dialog[open]") == []
        page.read("document.querySelector('dialog[open]').close()")
    pictures.compare(page, "layout")


@pytest.mark.parametrize("width", [1600, 1440, 1024, 820])
def test_every_button_is_in_sight_whatever_the_width(page, width):
    """Beside all links of a running warehouse, one of them with alarms."""
    page.be_screen(width, 900)
    page.read(ALL_LINKS)
    page.until(f"innerWidth === {width}")
    assert page.read(OUT_OF_SIGHT) == []
    page.be_desktop()


def test_a_closed_tab_loses_nothing(page, address):
    keys(page, "r#")
    drag(page, (2, 2), (6, 4))
    kept = lines(page)
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("tab")
    second = page.driver.current_window_handle
    page.driver.switch_to.window(first)
    page.driver.close()
    page.driver.switch_to.window(second)
    page.open(address)
    page.until("Boolean(page.store)")
    assert lines(page) == kept
    page.until("document.getElementById('notice').checkVisibility()")
    page.click_on("notice-button")
    assert page.read("page.editor.drawing.bounds()") is None
    page.click_on("undo")
    assert lines(page) == kept


def test_tools_keys_and_lanes(page):
    keys(page, "l>")
    drag(page, (0, 0), (9, 1))
    keys(page, "o#")
    drag(page, (0, 2), (4, 5))
    keys(page, "fx")
    drag(page, (2, 3))
    wall, inside, none, street = "#####     ", "#xxx#     ", " " * 10, ">" * 10
    assert lines(page) == [wall, inside, inside, wall, none, street]
    keys(page, "B")
    keys(page, "d")
    drag(page, (9, 3))
    keys(page, "q")
    drag(page, (6, 3), (8, 3))
    keys(page, "e")
    drag(page, (9, 3), (9, 5))
    station = page.read("page.editor.station")
    assert station["queue"] == [[6, 3], [7, 3], [8, 3]] and station["exit"] == [[9, 4], [9, 5]]


def test_keys_alone_draw(page):
    page.read("document.getElementById('overlay').focus()")
    for key in ("ArrowRight", "s", "ArrowRight", "s", "ArrowUp", "p", "r", "#", "Enter"):
        press(page, key)
    for key in ("ArrowRight", "ArrowRight", "ArrowUp", "Enter"):
        press(page, key)
    drawn = lines(page)
    assert drawn == [" ###", " ###", "ss  "], drawn
    for _ in range(3):
        press(page, "z", control=True)
    assert lines(page) == ["ss"]
    press(page, "y", control=True)
    assert lines(page) == [" p", "ss"]


def test_a_block_is_copied_mirrored_and_repeated(page):
    keys(page, "d>")
    drag(page, (0, 0))
    keys(page, "s")
    drag(page, (1, 0))
    keys(page, "m")
    drag(page, (0, 0), (1, 0))
    assert page.read("document.getElementById('block').checkVisibility()")
    press(page, "c", control=True)
    press(page, "v", control=True)
    press(page, "j")
    drag(page, (3, 0))
    assert lines(page) == [">s s<"]
    keys(page, "m")
    drag(page, (0, 0), (4, 0))
    page.driver.execute_script(
        "document.getElementById('repeat-columns').value = 1;"
        "document.getElementById('repeat-rows').value = 3;"
    )
    page.click_on("repeat")
    assert lines(page) == [">s s<"] * 3
    press(page, "z", control=True)
    assert lines(page) == [">s s<"]


def test_fingers_draw_and_two_zoom(chromium, address):
    chromium.be_phone(1024, 768)
    try:
        paper(chromium, address)
        keys(chromium, "d.")
        start, end = at(chromium, (3, 3)), at(chromium, (8, 3))
        chromium.swipe([start, end])
        chromium.until("page.editor.drawing.count('.') === 6")
        before = chromium.read("page.editor.view.scale")
        a, b = at(chromium, (4, 8)), at(chromium, (6, 8))
        chromium.touch("touchStart", a)
        chromium.swipe([a, (a[0] - 60, a[1])], [b, (b[0] + 60, b[1])])
        chromium.until(f"page.editor.view.scale > {before} * 1.5")
        assert lines(chromium) == ["......"]
        assert chromium.complaints() == []
    finally:
        chromium.be_desktop()


def test_a_trial_can_be_given_up(page):
    open_drawing(page, "huge")
    page.click_on("try")
    page.until("document.getElementById('trial').dataset.phase === 'running'")
    page.click_on("trial-cancel")
    page.until("document.getElementById('trial-told').textContent === 'cancelled'")


def test_a_trial_that_is_closed_while_it_runs_stays_closed(page):
    open_drawing(page, "large")
    page.click_on("try")
    page.until("document.getElementById('trial').dataset.phase === 'running'")
    # Records each state of the panel until the request has ended and the page has dealt with it.
    page.read("void (window.seen = [])")
    page.read("""void new MutationObserver(() => seen.push(document.getElementById('trial').hidden))
        .observe(document.getElementById('trial'), { attributes: true })""")
    page.read(
        "void (page.trial.abort.signal.onabort = () => setTimeout(() => seen.push('over'), 300))"
    )
    page.click_on("trial-close")
    page.until("seen.includes('over')")
    assert page.read("document.getElementById('trial').hidden")
    is_hidden = page.read("seen")
    assert False not in is_hidden[is_hidden.index(True) :]  # progress showed it before


def test_a_trial_whose_server_ends_says_so(page):
    open_drawing(page, "small")
    page.read("""void (window.whole = window.fetch, window.fetch = async () => new Response(
        '{"time": 1, "of": 600, "pieces": 0, "waiting": {}}\\n'))""")
    try:
        page.click_on("try")
        page.until("document.getElementById('trial').dataset.phase === 'failed'")
        words = page.read("document.getElementById('trial-told').textContent")
        assert words == "The trial ended without a result; try again."
    finally:
        page.read("void (window.fetch = window.whole)")


def test_files_are_opened_and_wrong_ones_told(page, tmp_path):
    good, bad = tmp_path / "a.layout.yaml", tmp_path / "b.layout.yaml"
    layout_file.write(generator.of_request(PRESETS["small"], "from a file"), good)
    bad.write_text("layout: 1\nfloor: |\n  .\n  ..\n")
    page.driver.find_element("id", "file").send_keys(str(good))
    page.until("page.editor.drawing.name === 'from a file'")
    assert saved(page, tmp_path) == good.read_text()
    page.driver.find_element("id", "file").send_keys(str(bad))
    page.until("document.getElementById('said').textContent.includes('b.layout.yaml:4')")
    assert page.read("page.editor.drawing.name") == "from a file"


def ordinary(edge):
    """A floor of so many cells along x and y, with streets driven both ways and twelve stations."""
    floor = np.full((edge, edge), ".")
    for y in range(3, edge - 10, 3):
        floor[y : y + 2, 4 : edge - 20] = "s"
    floor[-4, 10:60] = "p"
    stations = []
    for i in range(12):
        column, row = edge - 8, 6 + 7 * i
        floor[row, column] = chr(65 + i)
        queue = ((column, row + 2), (column, row + 1))
        station = StationEntry(
            chr(65 + i), (column, row), f"pick{i + 1}", queue=queue, exit=((column, row - 1),)
        )
        stations.append(station)
    return LayoutFile(floor=floor, stations=tuple(stations), robots=40, items=2000)


def test_a_hundred_by_a_hundred_cells_are_no_burden(page, tmp_path, capsys):
    file = tmp_path / "large.layout.yaml"
    layout_file.write(ordinary(100), file)
    page.driver.find_element("id", "file").send_keys(str(file))
    page.until("page.editor.drawing.places > 1000")
    assert checked(page) == []
    page.read("(page.editor.frames.length = 0)")
    keys(page, "d#")
    drag(page, *((2 + 2 * i, 1) for i in range(30)))
    assert page.until("page.editor.drawing.count('#') >= 59")
    faults = checked(page)
    frames = sorted(page.read("page.editor.frames"))
    page.read("page.editor.view.zoom(9 / page.editor.view.scale)")  # from there on all has signs
    redrawn = page.read(REDRAWN)
    size = sum(len(packed(url)) for url in {page.driver.current_url, *page.read(LOADED)})
    median, most, check = frames[len(frames) // 2], frames[-1], page.read("page.checker.took")
    with capsys.disabled():
        print(
            f"\n100 x 100 cells: frame {median:.1f} ms in the median of {len(frames)},"
            f" {most:.1f} ms at most, {redrawn:.0f} ms with all pixels; check {check:.0f} ms,"
            f" {len(faults)} faults; page {size / 1024:.0f} KiB"
        )


def test_a_fault_leads_to_its_cells(page):
    keys(page, "r.")
    drag(page, (0, 0), (5, 3))
    keys(page, "l.")
    drag(page, (6, 1), (14, 1))
    assert checked(page)
    cells = page.read("page.editor.faults[0].cells")
    assert [14, 1] in cells and [2, 2] not in cells
    page.driver.find_element("css selector", "#faults button").click()
    page.until("page.editor.overlay.chosen")
    keys(page, "r ")
    drag(page, (6, 1), (14, 1))
    assert checked(page) == []


def test_faults_show_while_the_button_is_held(page):
    keys(page, "r.")
    drag(page, (0, 0), (5, 3))
    assert checked(page) == []
    keys(page, "d")
    mouse(page, "mousePressed", (6, 1))
    mouse(page, "mouseMoved", (12, 1))
    page.until("page.editor.faults.length > 0")
    mouse(page, "mouseReleased", (12, 1), 0)
