# SPDX-License-Identifier: Apache-2.0
"""axe finds nothing on pages, and something where something is; they look as they did."""

from urllib.parse import quote

import pytest
from docs_page import SHOWN, docs
from editor_page import PATIENCE, browser
from rostest_support import axe, pictures
from selenium.webdriver.support.ui import WebDriverWait

from warehouse_viewer.server import token_page

PAGE = """<!doctype html><html lang="en"><title>A page</title><style>
@media (prefers-color-scheme: dark) {{
  body {{ background: #111; color: #eee }} p {{ color: {dark} }} }}
</style><main><h1>A page</h1><p>With words</p>{more}</main></html>"""


@pytest.fixture(scope="module")
def page():
    with browser(PATIENCE) as browser_page:
        yield browser_page


def found(page, text):
    page.open("data:text/html;charset=utf-8," + quote(text))
    return axe.findings(page)


def test_faults_are_found_in_both_themes(page):
    assert found(page, PAGE.format(dark="#eee", more="")) == []
    result = found(page, PAGE.format(dark="#333", more=""))
    assert len(result) == 1 and result[0].startswith("dark: color-contrast: p:")
    result = found(page, PAGE.format(dark="#eee", more="<img src='x.png'>"))
    assert [item.split(":")[:2] for item in result] == [
        ["dark", " image-alt"],
        ["light", " image-alt"],
    ]


@pytest.mark.parametrize("wrong", [False, True])
def test_the_token_page_is_for_all(page, wrong):
    assert found(page, token_page.text("/", wrong).decode()) == []


def test_the_api_s_page_is_for_all_and_looks_as_it_did(page):
    with docs() as address:
        page.open(address)
        wait = WebDriverWait(page.driver, PATIENCE)
        wait.until(lambda driver: driver.execute_script(f"return {SHOWN}"))
        pictures.compare(page, "docs")
        page.driver.execute_script(
            "document.querySelectorAll('details').forEach((e) => e.open = true)"
        )
        assert axe.findings(page) == []


def test_a_page_that_looks_otherwise_is_reported(page):
    page.open("data:text/html;charset=utf-8," + quote(PAGE.format(dark="#eee", more="")))
    before = pictures.picture(page, "light")
    assert pictures.difference(before, pictures.picture(page, "light")) == 0
    page.driver.execute_script("document.querySelector('h1').style.paddingTop = '100px'")
    moved = pictures.difference(before, pictures.picture(page, "light"))
    assert 0 < moved < pictures.difference(before, pictures.picture(page, "dark"))
