# SPDX-License-Identifier: Apache-2.0
"""Files of folders over HTTP."""

from pathlib import Path

from starlette.staticfiles import StaticFiles

from warehouse_sim import files

PACKED = files.share() / "three"  # in a wheel
THREE = PACKED if PACKED.is_dir() else Path("/usr/share/javascript/three")  # of libjs-three
FRESH = {"cache-control": "no-cache"}


class Files(StaticFiles):
    """Files of a folder. What can be no name of a file is not found."""

    def lookup_path(self, path):
        try:
            return super().lookup_path(path)
        except (ValueError, OSError):  # a zero byte; too long
            return "", None


class FreshFiles(Files):
    """Such that a browser asks for again, so that page and server are of one version."""

    def file_response(self, *args, **kwargs):
        response = super().file_response(*args, **kwargs)
        response.headers.update(FRESH)
        return response
