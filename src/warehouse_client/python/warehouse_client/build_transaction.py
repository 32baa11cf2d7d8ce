# SPDX-License-Identifier: Apache-2.0
"""Atomic changes of the whole warehouse; physics is paused meanwhile."""

from typing import Any

from warehouse_client.engine import Engine

BUILDING = "warehouse/building"


class BuildTransaction:
    """`ros` is rospy, `engine` an engine.Engine.

    The parameter BUILDING outlives a builder that dies before it commits. It shows the next builder
    that the warehouse is half-built, and whether to resume physics.
    """

    def __init__(self, ros: Any, engine: Engine) -> None:
        self._ros, self._engine = ros, engine

    @property
    def is_unfinished(self) -> bool:
        """Returns whether a builder is at work, or died while building."""
        return is_building(self._ros)

    def begin(self, name: str) -> None:
        """Pauses physics, to build the warehouse of that name."""
        resumes = self._resumes()
        self._ros.set_param(BUILDING, {"warehouse": name, "resumes": resumes})
        self._engine.pause()

    def _resumes(self) -> bool:
        """Returns whether physics goes on afterwards, as it did before the build."""
        mark = self._ros.get_param(BUILDING, None)
        if isinstance(mark, dict) and "resumes" in mark:
            return bool(mark["resumes"])
        return not self._engine.is_paused()

    def commit(self) -> None:
        """Ends the build: the warehouse is whole. Physics goes on if it did before."""
        if self._resumes():
            self._engine.resume()
        self._ros.delete_param(BUILDING)


def is_building(ros: Any) -> bool:
    """Returns whether a builder is at work, or died while building."""
    return ros.has_param(BUILDING)
