# SPDX-License-Identifier: Apache-2.0
"""axe finds what is wrong with a page, and nothing where nothing is."""

from urllib.parse import quote

import axe
import pytest
from editor_page import PATIENCE, browser

from warehouse_viewer.server import token_page

PAGE = """<!doctype html><html lang="en"><title>A page</title><style>
@media (prefers-color-scheme: dark) {{
  body {{ background: #111; color: #eee }} p {{ color: {dark} }} }}
</style><main><h1>A page</h1><p>With words</p>{more}</main></html>"""


@pytest.fixture(scope="module")
def page():
    with browser(PATIENCE) as one:
        yield one


def found(page, text):
    page.open("data:text/html;charset=utf-8," + quote(text))
    return axe.findings(page)


def test_faults_are_found_in_both_themes(page):
    assert found(page, PAGE.format(dark="#eee", more="")) == []
    told = found(page, PAGE.format(dark="#333", more=""))
    assert len(told) == 1 and told[0].startswith("dark: color-contrast: p:")
    told = found(page, PAGE.format(dark="#eee", more="<img src='x.png'>"))
    assert [one.split(":")[:2] for one in told] == [["dark", " image-alt"], ["light", " image-alt"]]


@pytest.mark.parametrize("wrong", [False, True])
def test_the_token_page_is_for_all(page, wrong):
    assert found(page, token_page.text("/", wrong).decode()) == []
