# SPDX-License-Identifier: Apache-2.0
"""Runs the simulation faster for a while, then as fast as before."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

from fastapi import HTTPException

DURATION = 60.0  # [s, wall]
SAME = 1e-6  # by which equal factors differ


class Boost:
    """Lives in an asyncio loop. `simulate(action, *args)` calls a method of Simulation."""

    def __init__(self) -> None:
        self._task: asyncio.Task[None] | None = None

    async def begin(self, simulate: Callable[..., Awaitable[Any]], factor: float) -> None:
        """Sets the target to `factor` for DURATION, unless it is that fast already."""
        before = (await simulate("state"))["target_factor"]
        if before == 0 or before >= factor:
            return
        await simulate("speed", factor)
        if self._task:
            self._task.cancel()
        self._task = asyncio.create_task(self._end(simulate, factor, before))

    async def _end(
        self, simulate: Callable[..., Awaitable[Any]], factor: float, before: float
    ) -> None:
        await asyncio.sleep(DURATION)
        with suppress(HTTPException):  # the world has ended
            now = (await simulate("state"))["target_factor"]
            if abs(now - factor) < SAME * factor:  # else a person has chosen another
                await simulate("speed", before)
