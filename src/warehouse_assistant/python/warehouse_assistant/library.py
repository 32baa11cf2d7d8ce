# SPDX-License-Identifier: Apache-2.0
"""The documentation as sections of text, of the source tree's folder doc or the hub's /docs/."""

import asyncio
import re
from collections.abc import Iterator
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

from warehouse_assistant.hub_client import HubClient, Trouble

ROOMS = ("tutorials", "how-to", "explanation", "reference")
PAGE = re.compile(rf"(?:{'|'.join(ROOMS)})/[\w-]+")
WORD = re.compile(r"[a-z0-9_]{2,}")
# Words of questions that name no subject.
IDLE = frozenset(
    (
        *("how", "what", "why", "when", "which", "where", "who", "do", "does", "is", "are", "can"),
        *("to", "the", "an", "in", "of", "it", "my", "and"),
    )
)
AT_ONCE = 4  # pages requested at the same time
HEADINGS = ("h1", "h2", "h3")
BLOCKS = ("p", "li", "pre", "tr", "dt", "dd", "div", *HEADINGS)


@dataclass(frozen=True)
class Section:
    """A part of a page with its heading."""

    page: str  # such as how-to/http
    heading: str
    text: str


class Library:
    """All sections, read at the first request."""

    def __init__(self, hub: HubClient, folder: Path | None = None) -> None:
        self._hub, self._folder = hub, folder or _source_folder()
        self._lock = asyncio.Lock()
        self._sections: list[Section] = []

    async def sections(self) -> list[Section]:
        """Returns all sections, in the order of their pages. Raises Trouble without any."""
        async with self._lock:
            if not self._sections:
                self._sections = await self._read()
        return self._sections

    async def _read(self) -> list[Section]:
        if self._folder:
            return await asyncio.to_thread(lambda folder: [*_of_folder(folder)], self._folder)
        try:
            index = await self._hub.text("/docs/searchindex.js")
        except Trouble as error:
            raise Trouble(
                "The documentation is not built here. Run make docs, then ask again."
            ) from error
        names = re.search(r'"?docnames"?:\s*\[(.*?)\]', index)
        pages = PAGE.findall(names[1]) if names else []
        limit = asyncio.Semaphore(AT_ONCE)

        async def read(page: str) -> list[Section]:
            async with limit:
                return _of_html(page, await self._hub.text(f"/docs/{page}.html"))

        every = await asyncio.gather(*map(read, sorted(set(pages))))
        return [section for sections in every for section in sections]

    async def page(self, name: str) -> str:
        """Returns a page as text. Raises Trouble."""
        sections = [s for s in await self.sections() if s.page == name]
        if not sections:
            raise Trouble("There is no such page. Ask search_documentation for pages.")
        return "\n\n".join(f"# {s.heading}\n{s.text}" for s in sections)

    async def pages(self) -> list[str]:
        """Returns the names of all pages. Raises Trouble."""
        return list(dict.fromkeys(section.page for section in await self.sections()))

    async def search(self, words: str) -> list[Section]:
        """Returns sections that contain the words, the best first. Raises Trouble."""
        terms = {_stem(word) for word in WORD.findall(words.lower()) if word not in IDLE}
        scored = [(_score(section, terms), section) for section in await self.sections()]
        ranked = sorted((pair for pair in scored if pair[0]), key=lambda pair: -pair[0])
        return [section for _, section in ranked]


def _stem(word: str) -> str:
    return word[:-1] if len(word) > 3 and word.endswith("s") else word


def _score(section: Section, terms: set[str]) -> float:
    """Returns the score of a section: by the number of different terms in it, those in the heading
    most."""
    heading, text = f"{section.page} {section.heading}".lower(), section.text.lower()
    score = 0.0
    for term in terms:
        times = text.count(term)
        score += 4 * (term in heading) + times / (times + 2)
    hits = sum(term in heading or term in text for term in terms)
    return score * hits / max(1, len(terms))


def _source_folder() -> Path | None:
    """Returns the folder doc of the source tree to which this module belongs, if it does."""
    parents = Path(__file__).resolve().parents
    folders = (parent / "doc" for parent in parents if (parent / "doc" / "how-to").is_dir())
    return next(folders, None)


def _of_folder(folder: Path) -> Iterator[Section]:
    for room in ROOMS:
        for file in sorted((folder / room).glob("*.md")):
            yield from of_markdown(f"{room}/{file.stem}", file.read_text("utf-8"))


def of_markdown(page: str, text: str) -> Iterator[Section]:
    """Yields the sections of a page in Markdown; a `#` in a code block is no heading."""
    heading, lines, is_code = page, list[str](), False
    for line in text.splitlines():
        is_code ^= line.lstrip().startswith("```")
        match = None if is_code else re.match(r"#{1,3} (.*)", line)
        if match:
            if any(lines):
                yield Section(page, heading, "\n".join(lines).strip())
            heading, lines = match[1], []
        else:
            lines.append(line)
    if any(lines):
        yield Section(page, heading, "\n".join(lines).strip())


def _of_html(page: str, text: str) -> list[Section]:
    reader = _Reader(page)
    reader.feed(text)
    reader.close()
    return reader.sections()


class _Reader(HTMLParser):
    """The text of a page's article, by its headings."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self._page = page
        self._parts: list[tuple[str, list[str]]] = []
        self._heading: list[str] | None = None
        self._skipped = 0
        self._depth = 0  # within the article

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Notes where the article, its headings and paragraphs begin (HTMLParser's hook)."""
        if tag == "article":
            self._depth += 1
        elif tag in ("script", "style", "nav"):
            self._skipped += 1
        elif tag in HEADINGS:
            self._heading = []
        elif tag in BLOCKS and self._parts:
            self._parts[-1][1].append("\n")

    def handle_endtag(self, tag: str) -> None:
        """Notes where they end (HTMLParser's hook)."""
        if tag == "article":
            self._depth -= 1
        elif tag in ("script", "style", "nav"):
            self._skipped -= 1
        elif tag in HEADINGS and self._heading is not None:
            heading = "".join(self._heading).replace("¶", "").replace("#", "").strip()
            if self._depth > 0:
                self._parts.append((heading, []))
            self._heading = None

    def handle_data(self, data: str) -> None:
        """Takes text (HTMLParser's hook)."""
        if self._skipped > 0:
            return
        if self._heading is not None:
            self._heading.append(data)
        elif self._parts and self._depth > 0:
            self._parts[-1][1].append(data)

    def sections(self) -> list[Section]:
        """Returns what was read."""
        texts = ((h, re.sub(r"\s*\n\s*", "\n", "".join(text)).strip()) for h, text in self._parts)
        return [Section(self._page, heading, text) for heading, text in texts if text]
