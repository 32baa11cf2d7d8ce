# SPDX-License-Identifier: Apache-2.0
"""The parts of a report's page as HTML: one file that refers to no other."""

from collections.abc import Iterable, Sequence
from datetime import datetime
from html import escape

from warehouse_operations.document.style import css

MOST_ROWS = 500  # of a table: the figures behind a chart may be longer than anyone reads
LONG = 42  # characters of a fact
Cells = Sequence[str]


def document(title: str, kind: str, about: str, first: str, rest: str) -> str:
    """Returns a whole page.

    kind and about are texts above the first sheet; first and rest are HTML. `first` is printed on a
    sheet of its own.
    """
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<meta name="color-scheme" content="light dark"><title>{escape(title)}</title>'
        f"<style>{css()}</style></head>\n<body><main>"
        f'<div class="first"><p class="kind"><span>{escape(kind)}</span>'
        f"<span>{escape(about)}</span></p>\n{first}</div>\n{rest}\n</main></body></html>\n"
    )


def opening(question: str, answer: str, is_bad: bool = False) -> str:
    """Returns the question that a report answers, and the answer; texts."""
    bad = " warning" if is_bad else ""
    return f'<h1>{escape(question)}</h1><p class="answer{bad}">{escape(answer)}</p>'


def big(figures: Iterable[tuple[str, str, str]]) -> str:
    """Returns the main figures: (figure, an addition to it, its name)."""
    cells = (
        f"<div><dt>{escape(words)}</dt><dd>{escape(figure)}"
        f"{f' <small>{escape(more)}</small>' if more else ''}</dd></div>"
        for figure, more, words in figures
    )
    return f'<dl class="big">{"".join(cells)}</dl>'


def section(title: str, content: str, note: str = "", is_short: bool = False) -> str:
    """Returns a part of a page below its title. is_short: it is never printed on two sheets."""
    note = f'<p class="note">{escape(note)}</p>' if note else ""
    short = ' class="short"' if is_short else ""
    return f"<section{short}><h2>{escape(title)}</h2>{note}{content}</section>"


def facts(pairs: Iterable[tuple[str, str]]) -> str:
    """Returns terms with their facts, such as assumptions, in two columns. A long fact takes the
    whole line.
    """
    ordered = sorted(pairs, key=lambda pair: len(pair[1]) > LONG)
    return f'<dl class="facts">{"".join(_fact(*pair) for pair in ordered)}</dl>'


def _fact(term: str, fact: str) -> str:
    long = ' class="long"' if len(fact) > LONG else ""
    return f"<dt{long}>{escape(term)}</dt><dd{long}>{escape(fact)}</dd>"


def sentences(texts: Iterable[str]) -> str:
    """Returns a list of sentences."""
    return f"<ul>{''.join(f'<li>{escape(text)}</li>' for text in texts)}</ul>"


def table(head: Cells, rows: Iterable[Cells], label: str) -> str:
    """Returns a table, the first cell of each row its name; label: its accessible
    name."""
    heads = "".join(
        f'<th scope="col">{escape(cell)}</th>' if cell else "<td></td>" for cell in head
    )
    lines = (
        f'<tr><th scope="row">{escape(name)}</th>'
        f"{''.join(f'<td>{escape(cell)}</td>' for cell in cells)}</tr>"
        for name, *cells in rows
    )
    head_row = f"<thead><tr>{heads}</tr></thead>" if any(head) else ""
    return (
        f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(label)}">'
        f"<table>{head_row}<tbody>{''.join(lines)}</tbody></table></div>"
    )


def behind(head: Cells, rows: Sequence[Cells], label: str) -> str:
    """Returns the figures behind a chart as a table that opens."""
    left = len(rows) - MOST_ROWS
    more = f"<p>… and {left:,} more rows.</p>" if left > 0 else ""
    return (
        f"<details><summary>As a table</summary>{table(head, rows[:MOST_ROWS], label)}{more}"
        "</details>"
    )


def row(parts: Iterable[str]) -> str:
    """Returns parts beside each other, where there is room."""
    return f'<div class="row">{"".join(parts)}</div>'


def today() -> str:
    """Returns a date as reports write it."""
    return datetime.now().strftime("%-d %B %Y")
