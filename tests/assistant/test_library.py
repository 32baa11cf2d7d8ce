# SPDX-License-Identifier: Apache-2.0
"""The documentation, read from the source tree and from the pages that a hub serves."""

import asyncio

from warehouse_assistant.hub_client import Trouble
from warehouse_assistant.library import Library, of_markdown

PAGE = """<html><nav><h1>Menu</h1></nav><article><section id="a"><h1>Record a shift<a>¶</a></h1>
<p>What <em>happens</em> is kept.</p><script>no();</script><section><h2>On disk</h2>
<pre>record:=true</pre></section></section></article><footer><p>the end</p></footer></html>"""


class Pages:
    """A hub whose documentation is built."""

    async def text(self, path):
        """Returns the file at a path."""
        if path == "/docs/searchindex.js":
            return 'Search.setIndex({"docnames":["index","how-to/record","python/api"],"x":1})'
        assert path == "/docs/how-to/record.html"
        return PAGE


class NoPages:
    """A hub without."""

    async def text(self, path):
        """Raises Trouble, as for any path that is not there."""
        raise Trouble(path)


def library(hub):
    out = Library(hub)
    out._folder = None
    return out


def test_pages_of_a_hub_are_sections():
    async def read():
        pages = library(Pages())
        return await pages.sections(), await pages.search("how is a disk recorded")

    sections, hits = asyncio.run(read())
    assert [(s.page, s.heading, s.text) for s in sections] == [
        ("how-to/record", "Record a shift", "What happens is kept."),
        ("how-to/record", "On disk", "record:=true"),
    ]
    assert hits[0].heading == "On disk"


def test_documentation_that_is_not_built_is_named():
    async def read():
        await library(NoPages()).sections()

    try:
        asyncio.run(read())
    except Trouble as error:
        assert "make docs" in str(error)
    else:
        raise AssertionError("no Trouble")


def test_a_comment_of_the_shell_is_no_heading():
    text = "# One\n```bash\n# not one\nls\n```\n## Two\ntext\n"
    assert [s.heading for s in of_markdown("how-to/x", text)] == ["One", "Two"]
