# SPDX-License-Identifier: Apache-2.0
"""Simulated robots that go on from the checkpoint of a world, under another controller."""

from collections.abc import Callable
from dataclasses import replace

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    DROPPING,
    FETCHING,
    LIFTING,
    OPEN,
    STORING,
    WAITING,
    Transport,
)
from warehouse_operations.fleets.fleet_now import FleetNow, TransportNow
from warehouse_operations.fleets.world_fleet import WorldFleet
from warehouse_operations.stock.site import Site


class ForkedWorld(WorldFleet):
    """Robots, units and items as they are in a checkpoint, with the transports of a fleet.

    The ways that robots were on are not forked: as under a coordinator that was restarted they
    stop, within seconds, and are sent on. number: of the run, each of which has other failures.
    """

    def __init__(
        self, checkpoint: bytes, now: FleetNow, site: Site, seed: int, number: int
    ) -> None:
        from kiva_plugin_cpp import World

        world = World.preset("empty", threads=1)
        world.restore(checkpoint)
        world.draw_failures_anew(number + 1)
        super().__init__(world, site, seed, threads=1, takes_over_at=world.time)
        self._now = now
        for station in now.closed:
            self.transports.is_open[station] = False

    def resume(self, _repair: Callable[[], float] = lambda: 0.0) -> None:
        """Goes on with the transports of the fleet. The world knows when robots are repaired."""
        now, book = self._now, self.transports.book
        for under_way in now.transports:
            robot = self.robots.index(under_way.kiva_id)
            if robot == NOWHERE or under_way.step == OPEN:
                book.restore(replace(under_way, step=OPEN).transport())
                continue
            transport = under_way.transport()
            book.restore(transport, robot)
            self._send(transport, under_way)
        book.add_events(now.events)
        for kiva_id, each in now.robots.items():
            if not each.in_service:
                self.set_in_service(kiva_id, False)

    def _send(self, transport: Transport, under_way: TransportNow) -> None:
        """Sends the robot of a transport where its step leads."""
        robots, robot, step = self.robots, transport.robot, transport.step
        here, place = self._now.robots[under_way.kiva_id].cell, under_way.place
        if place != NOWHERE:
            self.transports.book.keep(transport, place)
        if step == FETCHING:
            robots.send(robot, self.transports.cell_of_unit[transport.shelf])
        elif step == BRINGING:
            is_place = self.plan.storage.flat[transport.cell]
            robots.send(robot, transport.cell, transport.cell if is_place else place)
        elif step == STORING:
            robots.send(robot, place, place)
        else:
            robots.send(robot, here, place)
        robots.busy[robot] = step in (LIFTING, WAITING, DROPPING)
        if step in (LIFTING, DROPPING):
            transport.attempts = 1
        elif step == WAITING and transport.leave:
            self.transports.leave(transport)
