# SPDX-License-Identifier: Apache-2.0
"""Tools: commands to robots, their mode, transports of storage units."""

import asyncio
import time
from typing import Annotated, Any, Literal

from pydantic import Field

from warehouse_assistant import hub_client
from warehouse_assistant.hub_client import Trouble
from warehouse_assistant.toolbox import Priority, Robot, Simulation, Toolbox, Unit
from warehouse_assistant.words import listed, plain, quoted, sentence

WAIT = 15.0  # for the end of a command [s, wall]
EVENT_PATIENCE = 3.0  # for the event of a new transport [s, wall]
X = Annotated[float, Field(ge=-1e5, le=1e5, description="x of a grid point [m]")]
Y = Annotated[float, Field(ge=-1e5, le=1e5, description="y of a grid point [m]")]


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    async def command(simulation: str, robot: int, body: dict[str, Any]) -> str:
        warehouse = await box.hub.simulation(simulation)
        path = f"robots/{robot}/commands"
        answer = await warehouse.send("POST", path, body, wait="end", timeout=WAIT)
        texts = listed((quoted(e["text"]) for e in answer["events"]), 4)
        if answer["outcome"] in ("accepted", "pending"):
            return f"kiva{robot} is at it: {texts or 'sent'}. recent_events shows how it ends."
        return f"kiva{robot}: {answer['outcome']}: {texts}."

    @box.changes("Send a robot somewhere", repeatable=True)
    async def send_robot(robot: Robot, x: X, y: Y, simulation: Simulation = "") -> str:
        """Drives a robot to a grid point, along x first, then along y."""
        return await command(simulation, robot, {"command": "mov", "x": x, "y": y})

    @box.changes("Turn a robot")
    async def turn_robot(
        robot: Robot,
        direction: Annotated[Literal["left", "right"], Field(description="by a quarter")],
        simulation: Simulation = "",
    ) -> str:
        """Turns a robot by a quarter."""
        turn = 1 if direction == "left" else -1
        return await command(simulation, robot, {"command": "rot", "direction": turn})

    @box.changes("Lift a storage unit", repeatable=True)
    async def lift_unit(robot: Robot, unit: Unit, simulation: Simulation = "") -> str:
        """Has a robot lift the storage unit above it."""
        body = {"command": "lift", "status": 1, "shelf_id": unit}
        return await command(simulation, robot, body)

    @box.changes("Put a storage unit down", repeatable=True)
    async def put_down_unit(robot: Robot, simulation: Simulation = "") -> str:
        """Has a robot put down the storage unit that it carries."""
        return await command(simulation, robot, {"command": "lift", "status": 0})

    @box.changes("Set who commands a robot", repeatable=True)
    async def set_robot_mode(
        robot: Robot,
        mode: Annotated[
            Literal["AUTOMATIC", "MANUAL", "OUT_OF_SERVICE"],
            Field(description="by the coordinator, by a person, or not at all"),
        ],
        simulation: Simulation = "",
    ) -> str:
        """Gives a robot to the coordinator or to a person, or takes it out of service."""
        warehouse = await box.hub.simulation(simulation)
        answer = await warehouse.send("POST", f"robots/{robot}/mode", {"mode": mode})
        return sentence(f"kiva{robot} is {mode}. {plain(answer['message'], 300)}".rstrip(". "))

    @box.changes("Transport a storage unit")
    async def transport_unit(
        unit: Unit,
        station: Annotated[str, Field(max_length=100, description="its goal, or empty")] = "",
        x: Annotated[float | None, Field(description="of a cell instead [m]")] = None,
        y: Annotated[float | None, Field(description="of a cell instead [m]")] = None,
        then: Annotated[
            Literal["STORE", "STAY"], Field(description="once released: back to store, or stay")
        ] = "STORE",
        priority: Priority = 0,
        simulation: Simulation = "",
    ) -> str:
        """Has a storage unit brought to a station or a cell by whichever robot suits best."""
        if bool(station) == (x is not None and y is not None):
            raise Trouble("Name either a station or both x and y; describe_warehouse has stations.")
        warehouse = await box.hub.simulation(simulation)
        goal: dict[str, Any] = {"station": station} if station else {"x": x, "y": y}
        body = {"storage_unit": unit, "then": then, "priority": priority} | goal
        number = (await warehouse.send("POST", "transports", body))["transport_id"]
        await _heard_of(warehouse, number)
        return (
            f"Transport {number} brings unit {unit}. It waits there until release_unit"
            f" {number}; transport_state shows its progress."
        )

    @box.reads("Show the progress of a transport")
    async def transport_state(
        transport: Annotated[int, Field(ge=1, le=2**53, description="its number")],
        simulation: Simulation = "",
    ) -> str:
        """Returns the progress of a transport, and the robot that has it."""
        warehouse = await box.hub.simulation(simulation)
        return _transport(await warehouse.get(f"transports/{transport}"))

    @box.changes("Release a transported unit")
    async def release_unit(
        transport: Annotated[int, Field(ge=1, le=2**53, description="its number")],
        simulation: Simulation = "",
    ) -> str:
        """Lets a storage unit leave the place to which a transport has brought it."""
        warehouse = await box.hub.simulation(simulation)
        answer = await warehouse.send("POST", f"transports/{transport}/release")
        return f"Transport {transport} is released. {plain(answer['message'], 300)}"


async def _heard_of(warehouse: hub_client.Simulation, transport: int) -> None:
    """Waits until the warehouse's API knows a transport: its event may come after the answer."""
    end = time.monotonic() + EVENT_PATIENCE
    while await warehouse.get_or_none(f"transports/{transport}") is None:
        if time.monotonic() > end:
            return
        await asyncio.sleep(0.05)


def _transport(row: dict[str, Any]) -> str:
    goal = quoted(row["station"]) if row["station"] else "a cell"
    text = f"Transport {row['id']}: {quoted(row['storage_unit'])} to {goal} is {row['state']}"
    text += f" since {row['since']:.0f} s"
    text += f", by {quoted(row['robot'])}" if row["robot"] else ", without a robot yet"
    return sentence(text + (f": {quoted(row['text'], 200)}" if row["text"] else ""))
