# SPDX-License-Identifier: Apache-2.0
"""The hub's page in a real browser: a warehouse from the first click to its own pages."""

import pytest
from hub_process import PATIENCE, Hub, until
from rostest_support import axe
from rostest_support.browser import browser

STATE = "document.querySelector('.simulation .badge')?.textContent"
LIVE = "document.getElementById('link').dataset.state === 'live'"
WEIGHT = "performance.getEntriesByType('resource').reduce((sum, e) => sum + e.transferSize, 0)"
FIRST_VIEW = 300_000  # of the page with the recording that it plays, compressed [bytes]
BUTTON = "[...document.querySelectorAll('.simulation button')].find((b) => b.textContent === '{}')"


@pytest.fixture(scope="module")
def hub(tmp_path_factory):
    out = Hub(tmp_path_factory.mktemp("hub"))
    yield out
    out.end()


@pytest.fixture(scope="module")
def page(hub):
    with browser(PATIENCE, (1440, 900)) as chromium:
        chromium.open(hub.url + "/")
        chromium.until(LIVE)
        yield chromium


def test_0_the_first_view_is_light_and_the_recording_comes_after_it(hub):
    with browser(PATIENCE, (1440, 900)) as fresh:
        fresh.open(hub.url + "/")
        fresh.until(LIVE)
        fresh.until("!document.getElementById('example').hidden")
        names = fresh.read("performance.getEntriesByType('resource').map((e) => e.name)")
        first = next(i for i, name in enumerate(names) if "/api/v1/simulations" in name)
        assert not any("/recordings/" in name or "/replay/" in name for name in names[:first])
        assert 10_000 < fresh.read(WEIGHT) < FIRST_VIEW


def click(page, expression):
    page.driver.execute_script(f"({expression}).click()")


def test_1_a_wrong_value_is_said_beside_its_field(page):
    click(page, "document.getElementById('new')")
    page.until("document.getElementById('wish').open")
    page.driver.execute_script("document.querySelector('[name=rtf]').value = 'fast'")
    click(page, "document.querySelector('#wish-form .answers .strong')")
    wrong = "document.querySelector('#fields .wrong:not([hidden])')?.textContent"
    assert "a factor above 0" in page.until(wrong)
    if axe.is_there():
        assert axe.findings(page) == []
    click(page, "document.getElementById('wish-cancel')")


def test_1_a_recorded_shift_plays_until_a_warehouse_runs(page):
    page.until("!document.getElementById('example').hidden")
    at = "page.example.then((example) => window.seen = example.player.time) && window.seen"
    page.until(f"{at} > 0")
    first = page.read("window.seen")
    page.until(f"{at} > {first} + 1")
    drawn = "document.getElementById('example-floor').getContext('2d').getImageData(0, 0, 300, 150)"
    assert page.read(f"{drawn}.data.some((b) => b)")
    click(page, "document.getElementById('example-play')")
    assert page.read("document.getElementById('example-play').textContent") == "Play"
    assert page.read("document.querySelectorAll('#recording-list a').length") == 1


def test_1_all_of_the_house_needs_no_simulation(hub, page):
    page.open(f"{hub.url}/recordings/at_work/")
    page.until("window.page?.timeline?.player?.chunk")
    page.until("page.world.scene.robots.length >= 4")
    assert page.until("document.querySelector('.site a')?.getAttribute('href')") == "/"
    for path in ("/layout", "/whatif"):
        page.open(hub.url + path)
        page.until("document.querySelectorAll('.site a').length >= 3")
    page.open(hub.url + "/")
    page.until(LIVE)


def test_1_each_request_can_be_tried(hub, page):
    page.open(hub.url + "/api/docs")
    sections = "document.querySelectorAll('#operations details').length"
    until(lambda: page.read(sections) > 20, "no requests are shown")
    form = "document.querySelector('#operations details form')"
    click(page, f"{form}.querySelector('button')")
    shown = f"{form}.querySelector('pre').textContent"
    until(lambda: "simulations" in page.read(shown), "there is no answer")
    if axe.is_there():
        assert axe.findings(page) == []
    page.open(hub.url + "/")
    page.until(LIVE)


def test_2_one_click_starts_a_warehouse_at_work(page):
    click(page, "document.getElementById('begin')")
    page.until(f"{STATE} === 'running'")
    drawn = "document.querySelector('.simulation canvas')"
    page.until(f"{drawn}.getContext('2d').getImageData(0, 0, 300, 150).data.some((b) => b)")
    if axe.is_there():
        assert axe.findings(page) == []


def test_2_its_card_has_size_and_orders(page):
    facts = "document.querySelector('.simulation dl').textContent"
    page.until(f"{facts}.includes('24 storage units')")
    page.until(f"/Orders\\d+ wait, \\d+ at stations/.test({facts})")
    assert page.until("document.getElementById('example').offsetParent === null")


def test_2_its_world_is_saved_under_a_name(hub, page):
    click(page, BUTTON.format("Save as"))
    page.until("document.getElementById('save').open")
    page.driver.execute_script("document.querySelector('#save-form [name=world]').value = 'paper'")
    click(page, "document.querySelector('#save-form .answers .strong')")
    page.until("document.getElementById('save-answer').textContent.includes('another name')")
    page.driver.execute_script("document.querySelector('#save-form [name=world]').value = 'mine'")
    click(page, "document.querySelector('#save-form .answers .strong')")
    page.until("document.getElementById('answer').textContent.includes('saved')")
    assert hub.ask("GET", "/api/v1/worlds")[1]["worlds"][0]["name"] == "mine"
    click(page, BUTTON.format("Insert a world"))
    page.until("[...document.getElementById('worlds').options].some((o) => o.value === 'mine')")
    click(page, "document.getElementById('insert-cancel')")
    page.until("document.getElementById('journal-list').textContent.includes('save the world')")


def test_3_its_own_pages_are_live_beneath_its_name(hub, page):
    page.open(f"{hub.url}/s/small/")
    page.until(LIVE)
    page.until("page.world?.robotOf?.size === 4")
    links = "[...document.querySelectorAll('.site a')].map((a) => a.getAttribute('href'))"
    paths_there = page.until(links)
    assert paths_there[0] == "/"
    assert "/s/small/operations" in paths_there
    page.open(f"{hub.url}/s/small/operations")
    page.until(LIVE)


def test_4_its_log_is_shown_and_it_ends(hub, page):
    page.open(hub.url + "/")
    page.until(f"{STATE} === 'running'")
    click(page, BUTTON.format("Log"))
    page.until("document.getElementById('log-text').textContent.includes('process[')")
    click(page, "document.getElementById('log-close')")
    click(page, BUTTON.format("Stop"))
    click(page, "document.getElementById('question-yes')")
    page.until(f"{STATE} === 'stopped'")
    assert hub.ask("GET", "/api/v1/simulations/small")[1]["state"] == "STOPPED"
    page.until("document.getElementById('recording-list').textContent.includes('small')")


def test_5_a_drawing_of_the_editor_is_started(hub, page):
    page.open(f"{hub.url}/layout")
    page.until("window.page?.editor && !document.getElementById('start').hidden")
    new = "fetch('/layout/new', {method: 'POST', headers: {'content-type': 'application/json'},"
    counts = "body: JSON.stringify({robots: 2, units: 8, items: 16, stations: 1})})"
    page.driver.execute_script(
        f"{new} {counts}.then((r) => r.json()).then((d) => page.editor.open(d));"
    )
    page.until("page.editor.bounds")
    click(page, "document.getElementById('start')")
    page.until("location.pathname === '/'")
    rows = hub.ask("GET", "/api/v1/simulations")[1]["simulations"]
    name = next(row["name"] for row in rows if row["state"] != "STOPPED")
    assert hub.wait_for(name, "RUNNING")["robots"] == 2
