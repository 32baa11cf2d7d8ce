# SPDX-License-Identifier: Apache-2.0
"""The routes by which a page plays a recording, whether it still grows or lies in a file."""

from collections.abc import Callable, Sequence
from dataclasses import astuple
from typing import Any, Protocol

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from warehouse_viewer.json_text import JSONResponse
from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.chunk import Chunk, unpacked

KEPT = {"cache-control": "private, max-age=3600"}  # what never changes under its address
FRESH = {"cache-control": "no-store"}
MOST_MARKS = 400  # in an index: more can't be distinguished


class Recording(Protocol):
    """What can be played: memory.MemoryStore or file.FileRecording."""

    id: str
    about: dict[str, Any]
    cut: str

    @property
    def chunks(self) -> Sequence[Chunk]:
        """All chunks, the oldest first."""

    def chunk_data(self, number: int) -> bytes:
        """Returns a chunk's data, compressed. Raises KeyError or RecordingError."""

    def scene_data(self, number: int) -> bytes:
        """Returns a scene's JSON, compressed. Raises KeyError or RecordingError."""


class RecordingRoutes:
    """Serves a Recording. newest: returns the chunk that still grows, if there is one. forecasts:
    whether they can be asked for from its moments."""

    def __init__(
        self,
        recording: Recording,
        newest: Callable[[], Chunk | None] | None = None,
        forecasts: bool = False,
    ) -> None:
        self._recording, self._newest, self._forecasts = recording, newest, forecasts

    def routes(self) -> list[Route]:
        """Returns the routes, to be added to an application."""
        return [
            Route("/recording/index", self._index),
            Route("/recording/chunks/{number:int}", self._chunk),
            Route("/recording/scenes/{number:int}", self._scene),
        ]

    async def _index(self, _: Request) -> Response:
        chunks = list(self._recording.chunks)
        newest = self._newest() if self._newest else None
        about = {
            "id": self._recording.id,
            "live": self._newest is not None,
            "about": self._recording.about,
            "cut": self._recording.cut,
            "forecasts": self._forecasts,
            "open": newest.number if newest else 0,
        }
        chunks += [newest] if newest else []
        return JSONResponse(about | _times(chunks) | {"marks": _marks(chunks)}, headers=FRESH)

    async def _chunk(self, request: Request) -> Response:
        number = request.path_params["number"]
        newest = self._newest() if self._newest else None
        if newest and newest.number == number:
            return _packed(request, newest.data, "application/octet-stream", FRESH)
        return self._answer(request, self._recording.chunk_data, "application/octet-stream")

    async def _scene(self, request: Request) -> Response:
        return self._answer(request, self._recording.scene_data, "application/json")

    def _answer(self, request: Request, read: Callable[[int], bytes], kind: str) -> Response:
        number = request.path_params["number"]
        try:
            return _packed(request, read(number), kind, KEPT)
        except KeyError:
            return JSONResponse({"detail": f"there is no {number} in the recording any more"}, 404)
        except RecordingError as error:
            return JSONResponse({"detail": str(error)}, 500)


def _times(chunks: Sequence[Chunk]) -> dict[str, Any]:
    rows = [[chunk.number, chunk.scene, chunk.begin, chunk.end, chunk.wall] for chunk in chunks]
    ends = {"begin": chunks[0].begin, "end": chunks[-1].end} if chunks else {}
    return {"begin": 0.0, "end": 0.0, "chunks": rows} | ends


def _marks(chunks: Sequence[Chunk]) -> list[list[Any]]:
    """Returns [time, kind, model, text] of marks, the later ones if there are too many."""
    marks = [astuple(mark) for chunk in chunks for mark in chunk.marks if mark.time <= chunk.end]
    return [list(mark) for mark in marks[-MOST_MARKS:]]


def _packed(request: Request, data: bytes, kind: str, headers: dict[str, str]) -> Response:
    """Returns compressed data as they are, to a client that takes them so."""
    headers = headers | {"vary": "accept-encoding"}
    if "deflate" in request.headers.get("accept-encoding", ""):
        return Response(data, headers=headers | {"content-encoding": "deflate"}, media_type=kind)
    return Response(unpacked(data), headers=headers, media_type=kind)
