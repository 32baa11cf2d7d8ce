# SPDX-License-Identifier: Apache-2.0
"""Inter, the font of pages and reports: only the characters that they show, as WOFF2."""

import base64
import functools
import io
from pathlib import Path

FONT = Path("/usr/share/fonts/truetype/inter-vf/Inter-roman.var.ttf")  # of fonts-inter-variable
# Latin with accents, punctuation, arrows, minus, and the signs beside states.
CHARACTERS = (
    *range(0x20, 0x7F),
    *range(0xA0, 0x180),
    *range(0x2010, 0x2028),
    0x2030,
    *range(0x2190, 0x2194),
    *(0x2212, 0x2264, 0x2265, 0x25A0, 0x25B2, 0x25B6, 0x25BD, 0x25C6, 0x25CB, 0x25CF),
)
# What a report is written in: for what a name has beyond these there is the reader's own font.
WRITTEN = (*range(0x20, 0x7F), *range(0xA0, 0x100), *(0x2013, 0x2014, 0x2019, 0x2026, 0x2212))
FEATURES = ("kern", "calt", "ccmp", "locl", "mark", "tnum")  # tnum: figures of one width


@functools.cache
def woff2(characters: tuple[int, ...] = CHARACTERS) -> bytes:
    """Returns the font with these characters, code points. Raises OSError if there is none."""
    from fontTools import subset  # noqa: PLC0415 (a wheel has neither the font nor this)

    options = subset.Options(flavor="woff2", layout_features=list(FEATURES))
    font = subset.load_font(FONT, options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=characters)
    subsetter.subset(font)
    out = io.BytesIO()
    subset.save_font(font, out, options)
    return out.getvalue()


@functools.cache
def face() -> str:
    """Returns a rule of CSS with the font in it; "" where it is not installed.

    A page that is handed on then has the reader's own.
    """
    try:
        content = base64.b64encode(woff2(WRITTEN)).decode()
    except (ImportError, OSError):
        return ""
    return (
        "@font-face{font-family:Inter;font-weight:100 900;"
        f'src:url(data:font/woff2;base64,{content}) format("woff2")}}'
    )
