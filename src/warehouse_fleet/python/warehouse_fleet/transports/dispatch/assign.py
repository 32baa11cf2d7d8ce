# SPDX-License-Identifier: Apache-2.0
"""Assigns robots to open transports."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.dispatch import carry
from warehouse_fleet.transports.transport_book import Kind, Transport

if TYPE_CHECKING:
    from warehouse_fleet.transports.transports import Transports

FETCHED = 4  # units of a station that are fetched before they may be lifted


def run(work: "Transports") -> None:
    """Gives open transports to robots without work, a few more than stations have room for."""
    if not work.book.open:
        return
    robots = work.robots
    able = ~robots.stalled & ~robots.lifts_not & ~work.charging.kept()
    free = np.flatnonzero(work.without_work() & able)
    asked = _fetchable(work) if free.size else []
    for transport, robot in work.match_robots(asked, free) if asked else ():
        work.book.assign(transport, int(robot), work.traffic.time)
        work.publish_event(transport, Kind.ASSIGNED)
        carry.send(work, transport, work.units.cell_of[transport.shelf])


def _fetchable(work: "Transports") -> list[Transport]:
    """Returns the transports that may have a robot now, the most urgent first."""
    found, fetched = [], work.book.fetched.copy()
    for transport in work.book.open:
        station = transport.station
        is_full = station and fetched[station] >= FETCHED
        if not is_full and work.units.cell_of[transport.shelf] != NOWHERE:
            fetched[station] += 1
            found.append(transport)
    return found


def nearest_robots(
    work: "Transports", asked: list[Transport], free: np.ndarray
) -> Iterator[tuple[Transport, int]]:
    """Yields each transport with the nearest robot that is free, the most urgent first."""
    for transport in asked[: len(free)]:
        cell = work.units.cell_of[transport.shelf]
        robot = free[work.distance(cell, work.robots.cell[free]).argmin()]
        free = free[free != robot]
        yield transport, int(robot)
