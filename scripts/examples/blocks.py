# SPDX-License-Identifier: Apache-2.0
"""Blocks of pages, and what comments before them tell of how they are run."""

import os
import re
import shutil
import textwrap
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
NOTE = re.compile(r"<!-- example: (.*?) -->")
BLOCK = re.compile(
    r"(?P<notes>(?:^ *<!-- example: .*? -->\s*)*)"
    r"^(?P<indent> *)```(?P<language>[^\n]*)\n(?P<text>.*?)^ *```$",
    re.M | re.S,
)
NOTES = (
    "skip",
    "needs",
    "file",
    "beside",
    "ready",
    "before",
    "start",
    "stop",
    "wait",
    "expect",
    "patience",
)
SHOWN = ("text", "dot", "mermaid")  # drawings, formulas and output: there is nothing to run


class Example(NamedTuple):
    """A block of a page, with the notes of the comments before it."""

    page: Path
    line: int
    language: str
    text: str
    notes: dict[str, str]

    @property
    def place(self) -> str:
        return f"{os.path.relpath(self.page, ROOT)}:{self.line}"


class SkippedError(Exception):
    """Why an example is not run."""


def pages() -> list[Path]:
    """Returns README and all pages of doc/."""
    return [ROOT / "README.md", *sorted((ROOT / "doc").rglob("*.md"))]


def examples(of: Iterable[Path]) -> Iterator[Example]:
    """Yields the blocks of pages, in order. Raises ValueError where a note is not known."""
    for page in of:
        text = page.read_text()
        for match in BLOCK.finditer(text):
            if match["language"].startswith("{"):  # a directive of Sphinx
                continue
            line = text.count("\n", 0, match.start("language")) + 1
            body = textwrap.dedent(match["text"])
            example = Example(page, line, match["language"], body, {})
            example.notes.update(_note(example, note) for note in NOTE.findall(match["notes"]))
            yield example


def _note(example, text):
    name, _, value = text.partition(":")
    if name not in NOTES:
        raise ValueError(f"{example.place}: example: {name}: one of {', '.join(NOTES)} expected")
    return name, value.strip()


def check(example: Example) -> None:
    """Raises SkippedError where a page says that a block is not run, or what it needs is missing.

    Writes a block with the note `file` to that file.
    """
    for need in example.notes.get("needs", "").split():
        files = [*ROOT.glob(need), *Path().glob(need)] if "/" in need else []
        if not files and not shutil.which(need):
            raise SkippedError(f"{need} is not installed")
    if name := example.notes.get("file"):
        Path(name).write_text(example.text)
    if reason := example.notes.get("skip"):
        raise SkippedError(reason)
