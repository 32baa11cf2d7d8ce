# SPDX-License-Identifier: Apache-2.0
"""Files of folders over HTTP, compressed for a browser that takes it."""

import functools
import gzip
import os
import re
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import NamedTuple

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.staticfiles import NotModifiedResponse, StaticFiles
from starlette.types import Scope

KINDS = {  # that shrink, by suffix
    ".css": "text/css",
    ".html": "text/html",
    ".js": "text/javascript",
    ".json": "application/json",
    ".svg": "image/svg+xml",
}
MOST_PACKED = 300  # files that are kept compressed
# Comments of our own modules that have a line, or lines, to themselves.
COMMENT = re.compile(rb"^[ \t]*(?://[^\n]*|/\*\*(?:(?!\*/).)*\*/[ \t]*)$", re.M | re.S)
OWN = b"// SPDX-License-Identifier: Apache-2.0\n"
QUALITY = 9  # of Brotli; 11 saves another 8 % and takes 3 s for the largest file

try:
    import brotli
except ImportError:  # a wheel does without
    brotli = None


class Packing(NamedTuple):
    """A way to compress, by its name in HTTP."""

    name: str
    pack: Callable[[bytes], bytes]


# The best first. Browsers take Brotli from this machine and over TLS alone.
PACKINGS = [
    *([Packing("br", functools.partial(brotli.compress, quality=QUALITY))] if brotli else []),
    Packing("gzip", functools.partial(gzip.compress, compresslevel=9, mtime=0)),
]


class Files(StaticFiles):
    """Files of a folder. What can be no name of a file is not found. A browser may keep them for an
    hour."""

    CACHED = "private, max-age=3600"

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        """Returns a file's path and status, ("", None) if there is none (Starlette's hook)."""
        try:
            return super().lookup_path(path)
        except (ValueError, OSError):  # a zero byte; too long
            return "", None

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """Returns the answer with a file, compressed if that helps (Starlette's hook)."""
        kind = KINDS.get(Path(full_path).suffix)
        headers = {"cache-control": self.CACHED}
        if kind:
            headers["vary"] = "accept-encoding"
        packing = _taken(scope) if kind else None
        if not packing:
            response = super().file_response(full_path, stat_result, scope, status_code)
            response.headers.update(headers)
            return response
        version = stat_result.st_mtime_ns, stat_result.st_size
        tag = f'"{version[0]:x}-{version[1]:x}-{packing.name}"'
        headers |= {"content-encoding": packing.name, "etag": tag}
        body = _packed(str(full_path), version, packing)
        response = Response(body, status_code, headers, kind)
        if self.is_not_modified(response.headers, Headers(scope=scope)):
            return NotModifiedResponse(response.headers)
        return response


class FreshFiles(Files):
    """Files that a browser revalidates, so that page and server are of one version."""

    CACHED = "no-cache"


def _taken(scope: Scope) -> Packing | None:
    """The best packing that the browser takes; None if it takes none."""
    accepted = Headers(scope=scope).get("accept-encoding", "").split(",")
    names = {part.partition(";")[0].strip() for part in accepted}
    return next((packing for packing in PACKINGS if packing.name in names), None)


@functools.lru_cache(MOST_PACKED)
def _packed(path: str, version: Hashable, packing: Packing) -> bytes:  # noqa: ARG001 (part of the cache's key)
    """A file's content, compressed once."""
    content = Path(path).read_bytes()
    return packing.pack(without_comments(content) if path.endswith(".js") else content)


def without_comments(module: bytes) -> bytes:
    """A module of ours as browsers get it: each line stays at its number."""
    if not module.startswith(OWN):
        return module
    return OWN + COMMENT.sub(lambda match: b"\n" * match[0].count(b"\n"), module[len(OWN) :])
