# SPDX-License-Identifier: Apache-2.0
"""Labels with QR codes for a station: of its totes, of the buttons of its screen, and of goods."""

import html
from collections.abc import Iterable, Sequence

import segno

# What codes stand for buttons, with the texts beside them; codes.js has the same.
COMMANDS = {
    "ALL": "All pieces are taken",
    "UNDO": "Undo",
    "SHORT": "Short: the bin is empty",
    "DAMAGED": "Damaged",
    "YES": "Yes",
    "NO": "No, back",
}
MOST_SKUS, LONGEST_SKU = 200, 80
PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light"><link rel="icon" href="/web/icon.svg">
<link rel="stylesheet" href="/web/design.css"><link rel="stylesheet" href="/web/labels.css">
</head><body><main>{body}</main></body></html>
"""
LABEL = '<li><img src="{picture}" alt=""><span><b>{text}</b><small>{code}</small></span></li>'


def page(station: str, totes: int, skus: Sequence[str] = ()) -> str:
    """Returns the page with a station's label, a label per tote, and the labels of some SKUs."""
    places = [(f"Tote {number}", f"{station}-{number}") for number in range(1, totes + 1)]
    commands = [(text, f"CMD-{name}") for name, text in COMMANDS.items()]
    parts = (("Totes", places), ("Buttons", commands), ("Goods", [(sku, sku) for sku in skus]))
    name = html.escape(station)
    body = (
        f"<h1>Labels of {name}</h1><p>Print this page; the station's scanner reads the codes.</p>"
    )
    body += "".join(_section(title, labels) for title, labels in parts if labels)
    return PAGE.format(title=f"{name}: labels", body=body)


def no_station(name: str) -> str:
    """Returns the page that says that there is no station of that name."""
    return page_of_fault(f"there is no station '{name}'")


def page_of_fault(text: str) -> str:
    """Returns a page that says why there are no labels."""
    link = '<a href="../../operations">All stations</a>'
    body = f"<h1>No labels</h1><p>{html.escape(text)}</p>{link}"
    return PAGE.format(title="No labels", body=body)


def fault_of(skus: Sequence[str]) -> str:
    """Returns what is wrong with the SKUs of requested labels; "": nothing."""
    if len(skus) > MOST_SKUS:
        return f"{len(skus)} SKUs are asked for; {MOST_SKUS} at most were expected"
    wrong = [sku for sku in skus if not 0 < len(sku) <= LONGEST_SKU or not sku.isprintable()]
    return f"'{wrong[0][:LONGEST_SKU]}' is not an SKU" if wrong else ""


def _section(title: str, labels: Iterable[tuple[str, str]]) -> str:
    shown = "".join(
        LABEL.format(picture=_picture(code), text=html.escape(text), code=html.escape(code))
        for text, code in labels
    )
    return f"<section><h2>{title}</h2><ul>{shown}</ul></section>"


def _picture(code: str) -> str:
    """Returns a QR code as the address of a picture, which is the picture itself."""
    return html.escape(segno.make(code, error="m", micro=False).svg_data_uri(scale=4, border=2))
