# SPDX-License-Identifier: Apache-2.0
"""A search for a layout in the page /whatif, in a real browser, from the form to the editor."""

import pytest
from designs import COSTS, orders
from rostest_support import axe
from rostest_support.browser import browser
from test_whatif_page import PATIENCE, button, server, upload, write

from warehouse_operations.design import packages

SAID = "document.getElementById('design-{}-said').textContent"
STATE = "page.designs.all?.find((each) => each.name === {!r})?.state"


@pytest.fixture(name="page", scope="module")
def _page(tmp_path_factory):
    with (
        server(tmp_path_factory.mktemp("design") / "kept") as address,
        browser(PATIENCE, (1440, 900)) as chromium,
    ):
        chromium.open(address)
        chromium.until("document.getElementById('intro').checkVisibility()")
        yield chromium


@pytest.fixture(name="files", scope="module")
def _files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    for name, text in (
        ("day.csv", orders()),
        ("costs.yaml", COSTS),
        ("bad.yaml", "robot:\n  prize: 3\n"),
    ):
        (folder / name).write_text(text)
    return folder


def said(page, field):
    return page.read(SAID.format(field))


def test_refusals_stand_beside_their_field(page, files):
    page.click_on("design-first")
    page.until("document.getElementById('designer').open")
    page.until(f"{SAID.format('demand')}.includes('a file of orders')")
    upload(page, "orders", files / "day.csv")
    page.until("document.getElementById('design-demand').value === 'day.csv'")
    page.until(f"{SAID.format('costs')}.includes('open a costs.yaml')")
    assert said(page, "demand") == ""
    upload(page, "costs", files / "bad.yaml")
    page.until(f"{SAID.format('costs')}.includes('bad.yaml:2')")
    upload(page, "costs", files / "costs.yaml")
    page.until("document.getElementById('design-costs').value === 'those of costs.yaml'")
    write(page, "design-edges", "2 x 90")
    page.until(f"{SAID.format('building')}.includes('edges of 8')")
    assert page.read("document.getElementById('design-building').ariaInvalid") == "true"
    write(page, "design-edges", "36 x 26")
    write(page, "design-late", "200")
    page.until(f"{SAID.format('late')}.includes('below 100 %')")
    write(page, "design-late", "5")
    write(page, "design-cpu_hours", "0.5")
    page.until("document.getElementById('design-said').textContent.includes('It takes about')")
    assert all(not said(page, field) for field in ("building", "demand", "costs", "late"))
    assert page.read("document.getElementById('design-name').value") == "36x26"


def test_the_form_is_for_all(page):
    assert axe.findings(page) == []


def test_without_optuna_the_form_says_so(page):
    """Gives the page what the server answers where Optuna is missing."""
    page.click_on("design-cancel")
    page.read("(page.lacks = page.about.lacks, page.about.lacks = 'the search needs Optuna')")
    page.click_on("design-first")
    page.until("document.getElementById('design-lack').checkVisibility()")
    assert page.read("document.getElementById('design-run').disabled")
    page.read("(page.about.lacks = page.lacks)")
    page.click_on("design-cancel")


@pytest.mark.skipif(bool(packages.lack_of_optuna()), reason=packages.lack_of_optuna())
def test_a_search_shows_its_progress_and_goes_on(page):
    page.click_on("design-first")
    for field, text in (
        ("name", "hall"),
        ("edges", "36x26"),
        ("late", "5"),
        ("cpu_hours", "0.02"),
        ("physics_hours", "0"),
    ):
        write(page, f"design-{field}", text)
    page.click_on("design-run")
    page.until("!document.getElementById('designer').open")
    page.until("document.querySelector('[data-design=hall] progress')?.value > 0")
    left = "document.querySelector('[data-design=hall] .progress .number').textContent"
    page.until(f"/trials.*left$/.test({left})")
    button(page, "hall", "Cancel")
    page.until(f"{STATE.format('hall')} === 'cancelled'")
    button(page, "hall", "Go on")
    page.until(f"['waits', 'runs'].includes({STATE.format('hall')})")
    button(page, "hall", "Delete")
    page.click_on("question-yes")
    page.until("page.designs.all.length === 0")
    assert page.complaints() == []


@pytest.mark.skipif(bool(packages.lack_of_optuna()), reason=packages.lack_of_optuna())
def test_a_front_is_shown_and_its_layouts_are_opened(page):
    page.click_on("design-first")
    write(page, "design-name", "hall")
    write(page, "design-edges", "36x26")
    write(page, "design-late", "5")
    write(page, "design-cpu_hours", "0.0002")
    write(page, "design-physics_hours", "0")
    page.click_on("design-run")
    page.until(f"{STATE.format('hall')} === 'done'")
    rows = "[...document.querySelectorAll('.front tbody tr')].map((row) => row.cells.length)"
    front = page.read("page.designs.all[0].front")
    assert page.read(rows) == [8] * len(front) and front
    first = page.read(
        "[...document.querySelector('.front tbody tr').cells].map((c) => c.innerText)"
    )
    assert first[0] == "front-1" and first[1] == f"{front[0]['to_buy']:,.0f}"
    page.read("document.querySelector('.plans img').scrollIntoView()")
    page.until("document.querySelector('.plans img').naturalWidth > 100")
    assert axe.findings(page) == []
    button(page, "hall", "Another like it")
    assert page.read("document.getElementById('design-edges').value") == "36x26"
    page.click_on("design-cancel")
    page.driver.find_element("css selector", ".plans .text-button").click()
    page.until("document.getElementById('editor').open")
    assert page.read("document.getElementById('own-layout').value") == "hall-front-1.layout.yaml"
    page.click_on("editor-cancel")
    page.driver.find_element("css selector", ".plans a").click()
    page.until("Boolean(page.store) && page.editor.drawing.robotCount > 0")
    assert page.read("page.editor.drawing.robotCount") == front[0]["robots"]
    assert page.read("location.search") == ""
    assert page.complaints() == []
