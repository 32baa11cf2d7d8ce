# SPDX-License-Identifier: Apache-2.0
"""The hub's page in a real browser: a warehouse from the first click to its own pages."""

import pytest
from hub_process import PATIENCE, Hub
from rostest_support import axe
from rostest_support.browser import browser

STATE = "document.querySelector('.simulation .badge')?.textContent"
LIVE = "document.getElementById('link').dataset.state === 'live'"
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


def test_2_one_click_starts_a_warehouse_at_work(page):
    click(page, "document.getElementById('begin')")
    page.until(f"{STATE} === 'running'")
    drawn = "document.querySelector('.simulation canvas')"
    page.until(f"{drawn}.getContext('2d').getImageData(0, 0, 300, 150).data.some((b) => b)")
    if axe.is_there():
        assert axe.findings(page) == []


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
