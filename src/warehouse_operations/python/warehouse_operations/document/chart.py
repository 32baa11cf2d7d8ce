# SPDX-License-Identifier: Apache-2.0
"""A chart in a report: its finding, the drawing, and the figures behind it as a table."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

from warehouse_operations.document import canvas, page, tokens
from warehouse_operations.document.canvas import Canvas, Margins


@dataclass(frozen=True)
class Chart:
    """A chart and its words.

    title: its finding or its subject. quantity: the drawn quantity with its unit. head and rows:
    the table behind it. note: how to read it. key: HTML between title and drawing.
    """

    title: str
    quantity: str
    draw: Callable[[Canvas], None]
    height: float  # [px]
    margins: Margins
    head: Sequence[str] = ()
    rows: Sequence[Sequence[str]] = ()
    note: str = ""
    key: str = ""

    def html(self, width: float = 0) -> str:
        """Returns the chart for a page, in one width [px] or in both widths of pages."""
        description = f"{self.title}. {self.quantity}."
        parts = self.draw, self.height, self.margins, description
        drawn = canvas.single(parts[0], width, *parts[1:]) if width else canvas.drawing(*parts)
        note = f'<p class="note">{escape(self.note)}</p>' if self.note else ""
        table = page.behind(self.head, self.rows, self.title) if self.rows else ""
        return (
            f"<figure><figcaption><h3>{escape(self.title)}</h3>"
            f'<p class="quantity">{escape(self.quantity)}</p></figcaption>{self.key}{drawn}{note}'
            f"{table}</figure>"
        )


def letter(number: int) -> str:
    """Returns the letter of a configuration, from 0: A … Z, AA …"""
    first, last = divmod(number, 26)
    return (letter(first - 1) if first else "") + chr(ord("A") + last)


def key(labels: Sequence[str]) -> str:
    """Returns the key of configurations: letter, colour and name."""
    names = tokens.names_of_series(len(labels))
    parts = (
        f'<span><b style="color:var(--{name})">{letter(i)}</b>{escape(label)}</span>'
        for i, (name, label) in enumerate(zip(names, labels))
    )
    return f'<p class="key">{"".join(parts)}</p>'
