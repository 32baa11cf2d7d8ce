# SPDX-License-Identifier: Apache-2.0
"""The pages' font: Inter, reduced to the characters that pages show."""

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from warehouse_layout.drawing import page_font

CACHED = "private, max-age=604800"


def serve(_: Request) -> Response:
    """Answers with the font as WOFF2; 404 where it is not installed: the system's is taken."""
    if not page_font.FONT.exists():
        return PlainTextResponse(f"no {page_font.FONT}", 404)
    return Response(page_font.woff2(), media_type="font/woff2", headers={"cache-control": CACHED})
