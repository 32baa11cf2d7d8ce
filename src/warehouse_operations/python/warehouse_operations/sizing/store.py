# SPDX-License-Identifier: Apache-2.0
"""The store of points' shifts: a folder, each file named by a hash of the inputs."""

import hashlib
import json
from dataclasses import asdict
from pathlib import Path

from warehouse_layout.file import user_file
from warehouse_operations.sizing.point import SERIES, Point, Record

VERSION = 2  # of the files; those of other versions are simulated again


class Store:
    """The shifts in a folder. files: those of orders and stock, whose content counts; or ""."""

    def __init__(self, folder: Path, *files: str) -> None:
        self._folder = folder
        self._files = b"".join(user_file.read_bytes(file) for file in files if file)

    def get(self, point: Point) -> Record | None:
        """Returns the Record of a Point; None where it is missing or can't be read."""
        try:
            text = self._path(point).read_text(encoding="utf-8")
            record = Record(**json.loads(text))
            whole = point.run_in + point.minutes
            complete = all(len(record.series[name]) == whole for name in SERIES)
        except (OSError, ValueError, TypeError, KeyError):
            return None
        return record if complete else None

    def put(self, point: Point, record: Record) -> None:
        """Keeps the Record of a Point: all of it, or nothing. Raises OSError."""
        path = self._path(point)
        path.parent.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(".new")
        unfinished.write_text(json.dumps(record.to_json()), encoding="utf-8")
        unfinished.replace(path)

    def _path(self, point: Point) -> Path:
        decisive = json.dumps([VERSION, asdict(point)], sort_keys=True).encode() + self._files
        key = hashlib.sha256(decisive).hexdigest()[:16]
        kind = "physics" if point.physics else "ideal"
        name = f"{point.stations}-stations-{point.robots}-robots-{kind}-seed-{point.seed}-{key}"
        return self._folder / f"{name}.json"
