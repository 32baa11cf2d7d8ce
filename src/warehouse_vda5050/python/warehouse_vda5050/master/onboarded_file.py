# SPDX-License-Identifier: Apache-2.0
"""The file beside the file of robots, in which the master keeps what was changed while it ran:
robots that were added, and null for those of the other file that were removed."""

import os
from pathlib import Path
from typing import Any

import yaml

from warehouse_layout.file import user_file
from warehouse_vda5050.master import robots_file
from warehouse_vda5050.master.robots_file import RemoteRobot, RobotsFileError

HEAD = "# Written by the VDA 5050 master: vehicles that were added or removed while it ran.\n"


class OnboardedFile:
    """The robots of a file of robots, and of the file beside it. `path` need not exist if it is
    `optional`. Raises RobotsFileError."""

    def __init__(self, path: Path, optional: bool = False) -> None:
        self._of_person = [] if optional and not path.exists() else robots_file.read(path)
        self.path = path.with_name(f"{path.stem}.onboarded.yaml")
        self._entries = self._read() if self.path.exists() else {}

    def _read(self) -> dict[int, Any]:
        try:
            entries = yaml.safe_load(user_file.read_text(self.path))
        except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
            raise RobotsFileError(f"{self.path}: {error}") from error
        if entries is not None and not isinstance(entries, dict):
            raise RobotsFileError(f"{self.path}: robots by number were expected")
        return entries or {}

    def robots(self) -> list[RemoteRobot]:
        """Returns the robots that are there now."""
        entries = {robot.number: robot.entry() for robot in self._of_person}
        entries |= self._entries
        rows = {number: entry for number, entry in entries.items() if entry is not None}
        return robots_file.robots_of(self.path, rows)

    def add(self, robot: RemoteRobot) -> None:
        """Keeps a robot. Raises OSError, with nothing changed."""
        self._write({**self._entries, robot.number: robot.entry()})

    def remove(self, number: int) -> None:
        """Keeps that a robot is not there any more. Raises OSError, with nothing changed."""
        entries = {n: entry for n, entry in self._entries.items() if n != number}
        if any(robot.number == number for robot in self._of_person):
            entries[number] = None
        self._write(entries)

    def _write(self, entries: dict[int, Any]) -> None:
        """Replaces the file as a whole: a crash leaves the old one."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        new = self.path.with_name(self.path.name + ".new")
        with new.open("w", encoding="utf-8") as file:
            file.write(HEAD + yaml.safe_dump(entries, sort_keys=True))
            file.flush()
            os.fsync(file.fileno())
        new.replace(self.path)
        self._entries = entries
