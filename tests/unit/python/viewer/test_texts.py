# SPDX-License-Identifier: Apache-2.0
"""All texts of the pages are in the catalogue, and a page speaks the language of its address."""

import importlib.machinery
import importlib.util
import json

import pytest
from editor_page import PATIENCE, browser, editor
from page_program import served
from paths import ROOT
from whatif.test_whatif_page import server as whatif

from warehouse_viewer.server.static_files import without_comments

REPLAY = ROOT / "src/warehouse_viewer/nodes/replay"
RECORDING = ROOT / "src/warehouse_viewer/web/recordings/at_work.kiva"
SCRIPT = str(ROOT / "scripts/pages/texts")
# The language xx is English in brackets.
BRACKETS = """{
  const bracketed = (text) => (typeof text === 'string' ? `‹${text}›`
    : Object.fromEntries(Object.entries(text).map(([form, words]) => [form, `‹${words}›`])));
  const texts = Object.fromEntries(Object.entries(%s).map(([key, text]) => [key, bracketed(text)]));
  const { fetch } = window;
  const isOurs = (path) => `${path}`.endsWith('/web/texts/xx.json');
  window.fetch = async (path, ...more) => (
    isOurs(path) ? new Response(JSON.stringify(texts)) : fetch(path, ...more));
}"""
# What can be read, now or once it is opened, and has no bracket around it;
# events, policies and what a person called a warehouse come from the server.
ENGLISH = """(() => {
  const SERVERS = 'script, style, code, kbd, #warehouse, #events, #own-events, select[id^=policy]';
  const out = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let depth = 0; walker.nextNode();) {
    const { data, parentElement: element } = walker.currentNode;
    if (/[A-Za-z]{2} [a-z]{2}|^\\s*[A-Z][a-z]+\\s*$/.test(data) && !/[‹›]/.test(data)
      && !element.closest(SERVERS)) out.push(data.trim());
  }
  return out;
})()"""


def replay():
    """The address of a recording's page, which is the floor's."""
    return served(REPLAY, RECORDING)


@pytest.fixture(scope="module")
def texts():
    loader = importlib.machinery.SourceFileLoader("texts", SCRIPT)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("texts", loader))
    loader.exec_module(module)
    return module


def test_the_catalogue_has_all_texts_of_the_pages(texts):
    assert texts.CATALOGUE.read_text() == texts.written(texts.collected())


def test_no_text_is_in_the_pages_alone(texts):
    assert list(texts.unmarked()) == []


def test_a_text_that_is_not_looked_up_is_noticed(texts, monkeypatch):
    all_is = "tr`All is ${well ? tr`well` : 'lost for ever'}`"
    code = f"say('Nothing is there yet.'); say({all_is}); // 'a comment of ours'"
    monkeypatch.setattr(texts, "modules", lambda: [("js/a.js", code)])
    assert list(texts.unmarked()) == [
        "js/a.js: 'Nothing is there yet.' is in no tr or plural",
        "js/a.js: 'lost for ever' is in no tr or plural",
    ]
    assert [key for key, _, is_marked in texts.strings(code) if is_marked] == ["All is {1}", "well"]


def text_of(string):
    return string[0]


def test_what_browsers_get_of_a_module_lacks_nothing_but_comments(texts):
    module = b"// SPDX-License-Identifier: Apache-2.0\n// a\nf();\n/** b\n *  c */\ng(); // d\n"
    assert without_comments(module).split(b"\n")[1:] == [b"", b"f();", b"", b"", b"g(); // d", b""]
    assert without_comments(b"// Licence of others\n// a\n") == b"// Licence of others\n// a\n"
    for _, code in texts.modules():
        bare = without_comments(code.encode()).decode()
        assert list(map(text_of, texts.strings(bare))) == list(map(text_of, texts.strings(code)))
        assert bare.count("\n") == code.count("\n")


def test_a_language_says_what_it_lacks(texts, tmp_path):
    kept = {key: text for key, text in texts.collected().items() if key != "Orders"}
    file = tmp_path / "xx.json"
    file.write_text(json.dumps({**kept, "Ordres": "?"}))
    assert list(texts.missing(file)) == ["missing: Orders", "not in the pages: Ordres"]


@pytest.fixture(scope="module")
def page(texts):
    with browser(PATIENCE, (1440, 900)) as chromium:
        script = BRACKETS % json.dumps(texts.collected())
        chromium.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": script})
        yield chromium


def test_the_layout_page_speaks_the_language_of_its_address(page):
    with editor() as address:
        page.open(f"{address}?lang=xx")
        page.until("Boolean(page.store) && page.editor.view.width > 0")
        assert page.read("document.documentElement.lang") == "xx"
        assert page.read(ENGLISH) == []
        page.open(address)  # the tab keeps its language
        page.until("Boolean(page.store) && page.editor.view.width > 0")
        assert page.read(ENGLISH) == []


def test_the_what_if_page_speaks_the_language_of_its_address(page, tmp_path):
    with whatif(tmp_path / "kept") as address:
        page.open(f"{address}?lang=xx")
        page.until("document.getElementById('intro').checkVisibility()")
        assert page.read(ENGLISH) == []


def test_the_floor_speaks_the_language_of_its_address(page):
    with replay() as address:
        page.open(f"{address}?lang=xx")
        page.until("page.timeline.player.chunk && page.stage.frames")
        assert page.read(ENGLISH) == []
