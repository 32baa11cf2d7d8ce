# SPDX-License-Identifier: Apache-2.0
"""The page /layout and what it asks of its server."""

import asyncio
import os
import sys
import typing
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.file.request import LIMITS, MOST_STATIONS, PRESETS, RequestError, resolve
from warehouse_layout.file.request import Request as Preset
from warehouse_layout.generate import generated
from warehouse_viewer.editor import checking, drawing_json, opening
from warehouse_viewer.json_text import JSONResponse, dumps
from warehouse_viewer.server.site import LAYOUT

PAGE = LAYOUT.path
MOST_TRIALS = 2  # at a time: each keeps a core busy
TRIAL = [sys.executable, "-m", "warehouse_viewer.editor.trial"]

Answer = dict[str, Any]


class Editor:
    """What the page asks. file: the one that it edits, if any; builds: whether the HTTP API of a
    running warehouse is behind the same address, starts: that of a hub; compares: whether the page
    /whatif is."""

    def __init__(
        self,
        file: Path | None = None,
        builds: bool = False,
        compares: bool = False,
        starts: bool = False,
    ) -> None:
        self._file, self._builds, self._compares, self._starts = file, builds, compares, starts
        self._saves = bool(file and file.name.endswith(layout_file.SUFFIX))
        self._trials = 0

    def routes(self) -> list[Route]:
        """Returns what the page asks, to be added to an application."""
        return [
            Route(f"{PAGE}/about", self._about),
            Route(f"{PAGE}/check", _answering(_check), methods=["POST"]),
            Route(f"{PAGE}/read", _answering(_read), methods=["POST"]),
            Route(f"{PAGE}/new", _answering(_new), methods=["POST"]),
            Route(f"{PAGE}/file", _answering(self._write), methods=["PUT"]),
            Route(f"{PAGE}/try", self._try, methods=["POST"]),
        ]

    async def _about(self, _: Request) -> Response:
        about: Answer = {
            "presets": {n: _counts(p) for n, p in PRESETS.items() if p.robots},
            "limits": LIMITS | {"stations": MOST_STATIONS},
            "builds": self._builds,
            "compares": self._compares,
            "starts": self._starts,
            "file": str(self._file.resolve()) if self._file else "",
            "saves": self._saves,
        }
        if self._file and self._file.exists():
            try:
                file, about["told"] = opening.read(self._file)
                about["drawing"] = drawing_json.of_file(file)
            except (OSError, ValueError) as error:
                about["error"] = str(error)
        return JSONResponse(about, headers={"cache-control": "no-store"})

    def _write(self, text: str) -> Answer:
        """Writes the file that is edited, whole or not at all."""
        if not self._saves:
            raise LayoutFileError("this server writes no file; download it instead")
        assert self._file
        layout_file.parse(text, checking.NAME)
        beside = self._file.with_name(f".{self._file.name}.part")
        try:
            beside.write_text(text, encoding="utf-8")
            os.replace(beside, self._file)
        except OSError as error:
            raise LayoutFileError(f"{self._file}: {error.strerror}") from error
        return {"message": f"saved {self._file.name}"}

    async def _try(self, request: Request) -> Response:
        text = await request.body()
        if self._trials >= MOST_TRIALS:
            return JSONResponse({"detail": "robots work elsewhere already; try again soon"}, 409)
        return StreamingResponse(self._lines(text), media_type="application/x-ndjson")

    async def _lines(self, text: bytes) -> AsyncIterator[bytes]:
        """Yields the lines of a trial, which ends with its request."""
        self._trials += 1
        try:
            async for line in _trial(text):
                yield line
        finally:
            self._trials -= 1


async def _trial(text: bytes) -> AsyncIterator[bytes]:
    pipe = asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(
        *TRIAL, stdin=pipe, stdout=pipe, limit=1 << 26
    )  # the last line holds the heat of every cell
    assert process.stdin and process.stdout
    try:
        process.stdin.write(text)
        process.stdin.write_eof()
        last = b""
        async for last in process.stdout:
            yield last
        if not last.startswith((b'{"result"', b'{"error"')):
            yield dumps({"error": "the trial ended early"}).encode() + b"\n"
        await process.wait()
    finally:
        if process.returncode is None:
            process.kill()


def _counts(request: Preset) -> Answer:
    return {
        "robots": request.robots,
        "units": request.shelves,
        "items": request.items,
        "stations": request.belts,
    }


def _answering(work: Callable[..., Answer]) -> Callable[[Request], Any]:
    """Returns an endpoint that calls `work`, in a thread, with the fields of the request's body."""

    async def endpoint(request: Request) -> Response:
        try:
            fields = _fields(await request.json(), work)
            return JSONResponse(await asyncio.to_thread(work, **fields))
        except (LayoutFileError, RequestError) as error:
            detail = checking.text_of(error) if isinstance(error, LayoutFileError) else str(error)
            return JSONResponse({"detail": detail}, 409)
        except (TypeError, ValueError) as error:
            return JSONResponse({"detail": f"the request is wrong: {error}"}, 422)

    return endpoint


def _fields(asked: object, work: Callable[..., Answer]) -> Answer:
    """Returns the arguments of `work` from a request's body. Raises TypeError."""
    kinds = typing.get_type_hints(work)
    kinds.pop("return")
    if not isinstance(asked, dict) or asked.keys() != kinds.keys():
        raise TypeError(f"the fields {', '.join(kinds)} were expected")
    for name, kind in kinds.items():
        if not isinstance(asked[name], typing.get_origin(kind) or kind):
            raise TypeError(f"{name} is {asked[name]!r}")
    return asked


def _check(text: str) -> Answer:
    return checking.checked(text)


def _read(files: dict[str, str]) -> Answer:
    """Returns the drawing of files in base64, by name, and what could not be carried over."""
    file, notes = opening.opened(files)
    return {"drawing": drawing_json.of_file(file), "told": notes}


def _new(robots: int, units: int, items: int, stations: int) -> Answer:
    """Returns the drawing of a generated warehouse."""
    return drawing_json.of_file(_generated(robots, units, items, stations))


def _generated(robots: int, units: int, items: int, stations: int) -> LayoutFile:
    request = resolve("", robots, items, units)
    if not (robots and units and 1 <= stations <= MOST_STATIONS):
        raise RequestError(
            f"robots, storage units and 1 to {MOST_STATIONS} picking stations were expected"
        )
    return generated.file_of(type(request)(robots, units, items, stations))
