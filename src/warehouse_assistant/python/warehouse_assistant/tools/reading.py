# SPDX-License-Identifier: Apache-2.0
"""Tools: the documentation, and the rest of long replies."""

from typing import Annotated

from pydantic import Field

from warehouse_assistant.hub_client import Trouble
from warehouse_assistant.toolbox import Toolbox

MOST_SECTIONS, EXCERPT = 6, 1200  # of a search; characters of the best


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.reads("Search the documentation")
    async def search_documentation(
        words: Annotated[str, Field(min_length=2, max_length=200, description="what to look for")],
    ) -> str:
        """Finds sections of the documentation, and returns the best of them."""
        hits = await box.library.search(words)
        if not hits:
            return "The documentation has none of these words. Try others, or fewer."
        best, *others = hits[:MOST_SECTIONS]
        more = "\n".join(f"- {s.page}: {s.heading}" for s in others)
        text = best.text if len(best.text) <= EXCERPT else f"{best.text[:EXCERPT]}…"
        return f"{best.page}: {best.heading}\n{text}\n\nAlso (read_documentation):\n{more}"

    @box.reads("Read a page of the documentation")
    async def read_documentation(
        page: Annotated[str, Field(min_length=1, max_length=100, description="as how-to/http")],
        heading: Annotated[str, Field(max_length=200, description="a section; empty: all")] = "",
    ) -> str:
        """Returns a page of the documentation, or a section of it."""
        if not heading:
            return await box.library.page(page)
        for section in await box.library.sections():
            if section.page == page and heading.lower() in section.heading.lower():
                return f"{section.heading}\n{section.text}"
        raise Trouble("There is no such section. Leave `heading` empty, or search_documentation.")

    @box.reads("Go on with a long reply")
    async def more(
        key: Annotated[str, Field(max_length=20, description="the key that a reply ended with")],
    ) -> str:
        """Returns the next part of a reply that was too long."""
        rest = box.replies.rest(key)
        if rest is None:
            raise Trouble("This key is not known any more. Ask the same again.")
        return rest
