# SPDX-License-Identifier: Apache-2.0
"""Figures for Prometheus."""

import asyncio
from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import Response

METRICS: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/plain": {"schema": {"type": "string"}}}}
}

router = APIRouter()


@router.get("/metrics", response_class=Response, responses=METRICS)
async def get_metrics(request: Request) -> Response:
    """Figures for Prometheus."""
    state = request.app.state
    await state.backend.wait_for_summary()
    accepted = request.headers.get("accept", "")
    text, kind = await asyncio.to_thread(state.metrics.text, accepted)
    return Response(text, headers={"content-type": kind})
