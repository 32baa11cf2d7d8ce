# SPDX-License-Identifier: Apache-2.0
"""The pages' font: Inter, of which only the characters that pages show go over the network."""

import functools
import io

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from warehouse_viewer.shared_files import FONT

# Latin with accents, punctuation, arrows, minus, and the signs beside states.
CHARACTERS = [
    *range(0x20, 0x7F),
    *range(0xA0, 0x180),
    *range(0x2010, 0x2028),
    0x2030,
    *range(0x2190, 0x2194),
    *(0x2212, 0x25A0, 0x25B2, 0x25B6, 0x25C6, 0x25CB, 0x25CF),
]
FEATURES = ["kern", "calt", "ccmp", "locl", "mark", "tnum"]  # tnum: figures of one width
CACHED = "private, max-age=604800"


def serve(_: Request) -> Response:
    """Answers with the font as WOFF2; 404 where it is not installed: the system's is taken."""
    if not FONT.exists():
        return PlainTextResponse(f"no {FONT}", 404)
    return Response(_packed(), media_type="font/woff2", headers={"cache-control": CACHED})


@functools.cache
def _packed() -> bytes:
    from fontTools import subset  # noqa: PLC0415 (a wheel has neither the font nor this)

    options = subset.Options(flavor="woff2", layout_features=FEATURES)
    font = subset.load_font(FONT, options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(unicodes=CHARACTERS)
    subsetter.subset(font)
    out = io.BytesIO()
    subset.save_font(font, out, options)
    return out.getvalue()
