# SPDX-License-Identifier: Apache-2.0
"""Files of folders over HTTP, compressed for a browser that takes it."""

import functools
import gzip
import os
from pathlib import Path
from typing import Any

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.staticfiles import NotModifiedResponse, StaticFiles

KINDS = {  # that shrink, by suffix
    ".css": "text/css",
    ".html": "text/html",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
MOST_PACKED = 300  # files that are kept compressed


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
        self, full_path: Any, stat_result: os.stat_result, scope: Any, status_code: int = 200
    ) -> Response:
        """Returns the answer with a file, compressed if that helps (Starlette's hook)."""
        kind = KINDS.get(Path(full_path).suffix)
        headers = {"cache-control": self.CACHED}
        if kind:
            headers["vary"] = "accept-encoding"
        if not kind or not _takes_gzip(scope):
            response = super().file_response(full_path, stat_result, scope, status_code)
            response.headers.update(headers)
            return response
        version = stat_result.st_mtime_ns, stat_result.st_size
        headers |= {"content-encoding": "gzip", "etag": '"{:x}-{:x}-gzip"'.format(*version)}
        response = Response(_packed(str(full_path), version), status_code, headers, kind)
        if self.is_not_modified(response.headers, Headers(scope=scope)):
            return NotModifiedResponse(response.headers)
        return response


class FreshFiles(Files):
    """Such that a browser asks for again, so that page and server are of one version."""

    CACHED = "no-cache"


def _takes_gzip(scope):
    return "gzip" in Headers(scope=scope).get("accept-encoding", "")


@functools.lru_cache(MOST_PACKED)
def _packed(path, version):  # noqa: ARG001 (what tells one content from another)
    """A file's content, compressed once."""
    return gzip.compress(Path(path).read_bytes(), 9, mtime=0)
