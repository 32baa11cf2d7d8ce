# SPDX-License-Identifier: Apache-2.0
"""Words of Markdown that all pages are made of."""

import re
from collections.abc import Iterable, Sequence

GENERATED = "*This page is generated from the code.*"


def page(title: str, *parts: str) -> str:
    """Returns a page of its title and parts, with blank lines between."""
    return "\n\n".join([f"# {title}", *(part.strip("\n") for part in parts if part), GENERATED, ""])


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Returns a table; cells are Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell(text) for text in line) + " |" for line in lines)


def cell(text: str) -> str:
    """Returns a text that can stand in a table: in one line, with bars escaped."""
    return re.sub(r"\s+", " ", str(text)).replace("|", r"\|").strip()


def code(text: object) -> str:
    """Returns a text as code, an empty one as nothing."""
    return f"`{text}`" if str(text) else ""


def block(text: str, language: str = "") -> str:
    """Returns a block of code."""
    return f"```{language}\n{text.strip(chr(10))}\n```"


def prose(text: str) -> str:
    """Returns a comment or docstring as Markdown, in which no character is taken for markup."""
    parts = re.split(r"(`[^`]*`)", text.strip())
    return "".join(
        part if i % 2 else re.sub(r"([<*_\[\]])", r"\\\1", part) for i, part in enumerate(parts)
    )
