# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API's answers are made from."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NoReturn

from fastapi import Depends, HTTPException
from fastapi.requests import HTTPConnection

from warehouse_client.tracking import Tracked
from warehouse_msgs.msg import CoordinatorState, StationStates
from warehouse_viewer.api import catalogue, operations_json
from warehouse_viewer.api.boost import Boost
from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.api.command_log import CommandLog
from warehouse_viewer.api.schemas.models import Robot
from warehouse_viewer.api.transport_book import TransportBook
from warehouse_viewer.page.activities import wait_too_long
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.source import AwayError, RefusedError
from warehouse_viewer.ros.commander import Commander
from warehouse_viewer.ros.coordination import NONE_RUNS, Coordination
from warehouse_viewer.ros.emergency_stop import EmergencyStop
from warehouse_viewer.ros.feed import Feed
from warehouse_viewer.ros.operations_client import OperationsClient
from warehouse_viewer.ros.simulation import Simulation
from warehouse_viewer.watch.monitor import Monitor

SUMMARY = ("coordinator", "fleet", "performance")  # of the feed's topics
PATIENCE = 3.0  # for messages that are on their way [s, wall]


@dataclass(frozen=True)
class ApiBackend:
    """What the API's answers are made from. Methods raise HTTPException with the reason."""

    feed: Feed
    journal: Journal
    simulation: Simulation
    commander: Commander
    coordination: Coordination
    transports: TransportBook
    operations: OperationsClient
    changes: ChangeBook
    monitor: Monitor
    stop: EmergencyStop
    commands: CommandLog
    boost: Boost = field(default_factory=Boost)

    async def wait_for_positions(self) -> None:
        """Waits until it is known where everything is."""
        self.feed.subscribe()
        if not await _until(lambda: self.feed.has_positions):
            raise HTTPException(503, "no message comes from the world; is it running?")

    async def wait_for_summary(self) -> None:
        """Waits a moment for the messages that figures are made from."""
        self.feed.subscribe(SUMMARY)
        with suppress(AwayError):
            runs = await asyncio.to_thread(self.coordination.runs)
            names = SUMMARY if runs else set(SUMMARY) - {"coordinator"}
            await _until(lambda: all(self.feed[name] for name in names))

    async def change(self, action: str, *args: Any) -> Any:
        """Calls a method of Simulation that adds or removes models, and returns its answer.

        Afterwards every request of the API sees the new models.
        """
        # Subscribed before the change, so that no older message passes for a new one.
        await self.wait_for_positions()
        objects, fleet = self.feed["objects"], self.feed["fleet"]
        answer = await self.simulate(action, *args)
        standing = await self.simulate("standing")
        if standing.is_paused:
            # A paused world publishes no robots that come or go, except to a new subscriber.
            self.feed.resubscribe("fleet")
        await _until(lambda: self.feed.reflects(standing, objects, fleet))
        return answer

    async def robots(self) -> list[Robot]:
        """Returns every robot."""
        await self.wait_for_positions()
        waiting = wait_too_long(self.feed.coordinator)
        return catalogue.robots(self.feed["fleet"], waiting)

    async def robot(self, number: int) -> Robot:
        """Returns the robot of that number; 404 if there is none."""
        robots = [r for r in await self.robots() if r.id == number]
        if not robots:
            raise HTTPException(404, f"no robot kiva{number}")
        return robots[0]

    async def things(self, kind: str) -> Tracked:
        """Returns where all "storage_units" or "items" are."""
        await self.wait_for_positions()
        return catalogue.things(kind, *(self.feed.objects_and_states or self._no_things()))

    def _no_things(self) -> NoReturn:
        raise HTTPException(503, "the world is being rebuilt; ask again")

    def stations(self, message: StationStates) -> list[dict[str, Any]]:
        """Returns the stations of a message as JSON."""
        rows = operations_json.stations(message)
        return [row | self.monitor.station(station) for row, station in zip(rows, message.stations)]

    async def simulate(self, action: str, *args: Any) -> Any:
        """Calls a method of Simulation."""
        return await self.call(getattr(self.simulation, action), *args)

    async def coordinate(self, action: str, *args: Any) -> Any:
        """Calls a method of Coordination."""
        return await self.call(getattr(self.coordination, action), *args)

    async def coordinator(self) -> CoordinatorState:
        """Returns the newest CoordinatorState; 404 if no coordinator runs."""
        await self.wait_for_positions()
        runs = await self.coordinate("runs")
        if not runs or not await _until(lambda: self.feed.coordinator):
            raise HTTPException(404, NONE_RUNS)
        return self.feed.coordinator

    async def call(self, function: Callable[..., Any], *args: Any) -> Any:
        """Calls a blocking function: 409 if it is refused, 503 if nothing answers."""
        try:
            return await asyncio.to_thread(function, *args)
        except RefusedError as error:
            raise HTTPException(409, str(error)) from error
        except AwayError as error:
            raise HTTPException(503, str(error)) from error


async def _until(condition: Callable[[], object]) -> bool:
    """Returns whether the condition comes true within PATIENCE."""
    for _ in range(int(PATIENCE / 0.05)):
        if condition():
            return True
        await asyncio.sleep(0.05)
    return False


async def backend_of(connection: HTTPConnection) -> ApiBackend:
    """Returns the backend of the application that a request came to."""
    return connection.app.state.backend


BACKEND = Depends(backend_of)  # a default of the routes' functions
