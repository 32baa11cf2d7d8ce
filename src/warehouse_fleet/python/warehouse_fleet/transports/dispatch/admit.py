# SPDX-License-Identifier: Apache-2.0
"""Admits units to stations: lifts those for which there is room."""

from typing import TYPE_CHECKING

from warehouse_fleet.transports.dispatch import carry
from warehouse_fleet.transports.transport_book import LIFTING, READY, Transport

if TYPE_CHECKING:
    from warehouse_fleet.transports.transports import Transports


def run(work: "Transports") -> None:
    """Lifts units for whose station there is room, in the order in which their robots came. None is
    lifted for a station whose lane can't be entered, passed and left now."""
    book = work.book
    if not book.ready:
        return
    waiting, book.ready = book.ready, []
    for transport in waiting:
        if transport.step != READY:
            continue
        station = transport.station
        is_full = station and book.inbound[station] >= work.capacity[station]
        if is_full or not _is_beneath(work, transport) or work.is_cut_off(transport):
            book.ready.append(transport)
            continue
        transport.attempts = 0
        carry.begin_lift(work, transport, LIFTING)


def _is_beneath(work: "Transports", transport: Transport) -> bool:
    robots, robot = work.robots, transport.robot
    return bool(robots.stands[robot] and robots.cell[robot] == robots.goal[robot])
