# SPDX-License-Identifier: Apache-2.0
"""Parameters and described answers that several routes share."""

from typing import Any

from fastapi import Path, Query

from warehouse_viewer.api.schemas.base import INT32, MOST_ROWS, Problem

SENT = (400, 409, 413)  # problems of every request with a body

LIMIT = Query(100, ge=1, le=MOST_ROWS, description="rows in the answer")
OFFSET = Query(0, ge=0, le=INT32, description="rows to leave out before them")
NUMBER = Path(ge=1, le=INT32, description="the number in the model's name")
TEXT = Query("", max_length=100, description="a part of the name")


def problems(*codes: int) -> dict[int | str, dict[str, Any]]:
    """Returns the descriptions of the answers beside the good one: these, and what every request
    can get."""
    return {code: {"model": Problem} for code in (*codes, 401, 403, 429, 503)}
