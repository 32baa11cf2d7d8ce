# SPDX-License-Identifier: Apache-2.0
"""The page /whatif in a real browser, as a person uses it who never opens a terminal; no ROS."""

import paths
import pytest
from page_program import served
from rostest_support import axe
from rostest_support.browser import browser
from rostest_support.task import Task

from warehouse_layout.file import layout_file
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator

PATIENCE = 300.0  # runs yield to all else that the machine has to do [s, wall]
WHATIF = paths.ROOT / "src" / "warehouse_viewer" / "nodes" / "whatif"
CARDS = "[...document.querySelectorAll('.scenario')].map((c) => c.dataset.name)"
DONE = "page.scenarios?.length && page.scenarios.every((one) => one.state === 'done')"
LOCKED = "[...document.querySelectorAll('.scenario button:disabled')].map((b) => b.title)"
COLUMNS = "[...document.querySelectorAll('.column')].map((c) => c.textContent)"


def server(folder):
    """The address of `whatif FOLDER`."""
    return served(WHATIF, folder)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    with (
        server(tmp_path_factory.mktemp("whatif") / "kept") as address,
        browser(PATIENCE, (1440, 900)) as chromium,
    ):
        chromium.open(address)
        chromium.until("document.getElementById('intro').checkVisibility()")
        yield chromium


@pytest.mark.long
def test_medium_with_8_and_with_12_robots_takes_five_steps(tmp_path):
    with server(tmp_path / "kept") as address, browser(PATIENCE, (1440, 900)) as page:
        page.open(address)
        page.until("document.getElementById('intro').checkVisibility()")
        # Shorter than what the page proposes, so that the test is; no part of the task.
        write(page, "intro-minutes", "1")
        write(page, "intro-seeds", "2")
        with Task(page, "medium with 8 and 12 robots") as task:
            task.choose("#first-layout", "medium")
            task.type("#first-robots", "8")
            task.choose("#second-layout", "medium")
            task.type("#second-robots", "12")
            task.click("#intro-form .strong")
        page.until(DONE)
        page.until("Boolean(page.comparison.figures && page.comparison.chart)")
        assert page.read(COLUMNS) == ["medium 8 robots", "medium 12 robots"]
        assert page.complaints() == []


def write(page, element, text):
    field = page.driver.find_element("id", element)
    field.clear()
    field.send_keys(text)


def button(page, name, text):
    label = f"{text} {name}"
    page.driver.find_element("css selector", f"button[aria-label='{label}']").click()


def test_a_wrong_number_is_said_once_in_the_words_of_the_page(page):
    said = "document.getElementById('intro-time').textContent"
    for field, text, expected in (
        ("first-robots", "0", "Robots: a whole number from 1 to 20,000 is expected."),
        ("first-robots", "1000000000", "Robots: a whole number from 1 to 20,000 is expected."),
        ("intro-seeds", "0", "Repetitions: a whole number from 1 to 50 is expected."),
    ):
        write(page, field, text)
        page.until(f"{said} === '{expected}'")
        page.driver.find_element("css selector", "#intro-form .strong").click()
        page.until(f"document.activeElement.id === '{field}' && {said} === '{expected}'")
        assert page.read("document.getElementById('told').textContent") == ""
        write(page, field, "4")
        page.until(f"{said}.startsWith('takes about')")
    page.driver.find_element("id", "first-robots").clear()
    assert page.complaints() == []


def test_a_refusal_goes_when_its_field_is_mended(page):
    refusal = "document.getElementById('intro-time').textContent"
    write(page, "first-robots", "1000")
    page.driver.find_element("css selector", "#intro-form .strong").click()
    page.until(f"{refusal}.includes('1,000 robots, but there is room for 31')")
    write(page, "first-robots", "4")
    page.until(f"{refusal}.startsWith('takes about')")
    page.driver.find_element("id", "first-robots").clear()
    # The server's refusal is in the console too, and is no fault of the page.
    page.complaints()


def test_two_layouts_are_compared(page):
    """The steps that doc/how-to/whatif.md counts; short shifts, so that the test is."""
    page.driver.find_element("css selector", "#second-layout [value=small]").click()
    write(page, "second-robots", "2")
    write(page, "intro-minutes", "2")
    write(page, "intro-seeds", "2")
    page.driver.find_element("css selector", "#intro-form .strong").click()
    # What is disabled while runs are under way says why.
    page.until(f"{LOCKED}.length > 0")
    assert set(page.read(LOCKED)) == {"Its runs are under way: wait for them, or cancel them."}
    page.until(f"{CARDS}.length === 2")
    assert page.read(CARDS) == ["small", "small 2 robots"]
    page.until(DONE)
    assert page.read(LOCKED) == []
    page.until("Boolean(page.comparison.figures && page.comparison.chart)")
    assert page.read(COLUMNS) == ["small", "small 2 robots"]
    rows = page.read("[...document.querySelectorAll('#table tbody th')].map((c) => c.textContent)")
    assert "Robots " in rows and "Layout " not in rows and "Pieces picked an hour" in rows
    assert page.read("page.comparison.chart.scales.y.min") == 0
    assert page.complaints() == []


def test_the_comparison_is_for_all(page):
    assert axe.findings(page) == []


def test_the_comparison_is_in_the_address(page):
    page.driver.refresh()
    page.until("page.comparison?.figures")
    page.driver.find_element("css selector", "thead .text-button").click()
    page.until("page.comparison.figures.names[0] === 'small 2 robots'")
    assert page.read("location.hash") == "#compare=small%202%20robots,small"


def test_a_scenario_is_duplicated_changed_renamed_and_deleted(page):
    button(page, "small", "Duplicate")
    page.until("document.getElementById('editor').open")
    write(page, "own-stations", "9")
    page.click_on("editor-save")
    result = "document.getElementById('editor-told').textContent"
    page.until(f"{result}.startsWith('9 picking stations open; small has 2')")
    write(page, "own-stations", "1")
    page.driver.find_element("css selector", "#own-orders [value=mix]").click()
    page.click_on("editor-save")
    page.until("!document.getElementById('editor').open")
    button(page, "small 2", "Rename")
    write(page, "new-name", "one station\n")
    page.until(f"{CARDS}.includes('one station')")
    about = page.read("document.querySelector('[data-name=\"one station\"] .about').textContent")
    assert "1 station · 300 orders an hour" in about
    button(page, "one station", "Delete")
    page.click_on("question-yes")
    page.until(f"{CARDS}.length === 2")


COSTS = "robot: {price: 25000}\nperson_hour: 28\ncurrency: EUR\n"
ORDERS = "reference,sku,quantity,at,due\na,red,1,10,900\nb,blue,1,400,1000\n"


def upload(page, kind, file):
    page.read(f"(page.kind = '{kind}')")
    page.driver.find_element("id", "upload").send_keys(str(file))


def new(page):
    """Begins a scenario; the button may have scrolled beneath the page's head."""
    page.read("window.scrollTo({top: 0, behavior: 'instant'})")
    page.click_on("new")


def test_costs_are_compared(page, tmp_path):
    good, bad = tmp_path / "costs.yaml", tmp_path / "bad.yaml"
    good.write_text(COSTS)
    bad.write_text("robot:\n  prize: 3\n")
    upload(page, "costs", bad)
    page.until("document.getElementById('told').textContent.includes('bad.yaml:2')")
    upload(page, "costs", good)
    page.until("page.about.costs && page.comparison.figures.rows.some((r) => r.key === 'a_piece')")
    rows = page.read("[...document.querySelectorAll('#table tbody th')].map((c) => c.textContent)")
    assert "Cost of a piece [EUR]" in rows and "To buy [EUR]" in rows
    bought = "page.comparison.figures.rows.find((r) => r.key === 'to_buy').cells[{}].mean"
    robots = PRESETS["small"].robots
    # The reference is the one with two robots.
    assert page.read(bought.format(1)) - page.read(bought.format(0)) == (robots - 2) * 25000
    page.driver.find_element("css selector", "#costs-drop button").click()
    page.until(
        "!page.about.costs && page.comparison.figures.rows.every((r) => r.key !== 'a_piece')"
    )


def test_a_day_and_its_events_are_taken(page, tmp_path):
    file = tmp_path / "monday.csv"
    file.write_text(ORDERS)
    new(page)
    page.driver.find_element("css selector", "#own-orders [value=day]").click()
    upload(page, "orders", file)
    page.until("document.getElementById('own-file').value === 'monday.csv'")
    write(page, "own-times", "1.3")
    page.driver.find_element("css selector", "#own-layout [value=small]").click()
    page.driver.find_element("css selector", "#events summary").click()
    write(page, "own-events", "1m shut pick1")
    result = "document.getElementById('editor-told').textContent"
    page.until(f"{result}.startsWith('Event 1: shut is unknown; close, open')")
    write(page, "own-events", "1m close pick1\n90s open pick1")
    write(page, "own-name", "a day")
    page.click_on("editor-save")
    page.until("!document.getElementById('editor').open")
    page.until(f"{CARDS}.includes('a day')")
    about = page.read("document.querySelector('[data-name=\"a day\"] .about').textContent")
    assert "the day of monday.csv, × 1.3" in about and "2 events" in about
    button(page, "a day", "Change")
    page.until("document.getElementById('editor').open")
    assert page.read("document.getElementById('own-events').value") == (
        "1m close pick1\n90s open pick1"
    )
    assert page.read("document.getElementById('own-orders').value") == "day"
    page.click_on("editor-cancel")
    button(page, "a day", "Delete")
    page.click_on("question-yes")
    page.until(f"{CARDS}.length === 2")
    assert page.complaints() == []


def test_a_layout_of_ones_own_is_taken(page, tmp_path):
    good, bad = tmp_path / "own.layout.yaml", tmp_path / "bad.layout.yaml"
    layout_file.write(generator.of_request(PRESETS["small"], "own"), good)
    bad.write_text("layout: 1\nfloor: |\n  .\n  ..\n")
    new(page)
    page.driver.find_element("id", "upload")
    for file, then in (
        (bad, "document.getElementById('editor-told').textContent.includes('bad.layout.yaml:4')"),
        (good, "document.getElementById('own-layout').value === 'own.layout.yaml'"),
    ):
        page.read("(page.kind = 'layouts')")
        page.driver.find_element("id", "upload").send_keys(str(file))
        page.until(then)
    page.click_on("editor-cancel")


def test_a_drawing_of_the_editor_is_taken(page):
    page.open(page.driver.current_url.partition("/whatif")[0] + "/layout")
    page.until("Boolean(page.store) && page.editor.view.width > 0")
    page.click_on("new")
    page.driver.find_element("css selector", "#creator [value=yes]").click()
    page.until("page.editor.drawing.robotCount > 0")
    page.click_on("compare")
    page.until("page.form?.dialog.open")
    assert page.read("document.getElementById('own-layout').value") == "warehouse.layout.yaml"
    assert page.complaints() == []
