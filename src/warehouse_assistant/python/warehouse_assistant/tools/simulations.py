# SPDX-License-Identifier: Apache-2.0
"""Tools: what runs, starting, stopping and pausing it, its log."""

from typing import Annotated, Any, Literal

from pydantic import Field

from warehouse_assistant.hub_client import JOURNAL, NAME, SIMULATIONS, Trouble
from warehouse_assistant.toolbox import Simulation, Toolbox
from warehouse_assistant.words import count, duration, listed, plain, quoted, sentence

MOST_LOG = 6000  # characters of a log

Name = Annotated[
    str,
    Field(min_length=1, max_length=40, description="small letters, digits and '-', as my-small"),
]
Value = str | bool | int | float


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.reads("List simulations")
    async def list_simulations() -> str:
        """Lists the simulations of the hub with state, size and speed."""
        rows = (await box.hub.get(SIMULATIONS))["simulations"]
        if not rows:
            return "No simulation is there. start_simulation starts one, such as small."
        return "\n".join(map(_row, rows))

    @box.reads("List arguments of a simulation")
    async def simulation_arguments(
        search: Annotated[str, Field(max_length=60, description="a word; empty: all")] = "",
    ) -> str:
        """Lists the arguments that start_simulation takes, with their values."""
        about = await box.hub.get("/api/v1/simulation-arguments")
        lines = [_argument(a) for a in about["arguments"]]
        hits = [line for line in lines if search.lower() in line.lower()]
        worlds = listed(map(quoted, about.get("worlds", [])))
        if not hits:
            return f"No argument has {quoted(search)} in it. Leave `search` empty for all."
        return "\n".join([*hits, f"Worlds: {worlds}."] if not search else hits)

    @box.changes("Start a simulation")
    async def start_simulation(
        name: Name,
        size: Annotated[
            Literal["small", "medium", "large", "huge"], Field(description="4 to 1000 robots")
        ] = "small",
        shift: Annotated[bool, Field(description="with orders, stock and stations at work")] = True,
        arguments: Annotated[
            dict[str, Value] | None,
            Field(description="others by name, as layout, world, orders, realism, rtf"),
        ] = None,
    ) -> str:
        """Starts a warehouse under a new name, or one of this name that has stopped."""
        other = arguments or {}
        chosen = {} if {"layout", "world", "empty"} & other.keys() else {"size": size}
        body = {"name": name, "shift": shift} | chosen | other | {"name": name}
        rows = (await box.hub.get(SIMULATIONS))["simulations"]
        stopped = [r for r in rows if r["name"] == name and r["state"] in ("STOPPED", "FAILED")]
        if stopped:
            if _differs(stopped[0], body):
                raise Trouble(
                    f"{quoted(name)} was another warehouse: {_arguments(stopped[0])}. Start it"
                    " with these, choose another name, or forget it by stop_simulation."
                )
            row = await box.hub.send("POST", f"{SIMULATIONS}/{name}/start")
        else:
            row = await box.hub.send("POST", SIMULATIONS, body)
        return f"{_row(row)}\nIt needs some seconds until it runs; then ask describe_warehouse."

    @box.changes("Stop a simulation", destroys=True, repeatable=True)
    async def stop_simulation(
        name: Name,
        forget: Annotated[bool, Field(description="delete its log and recordings, too")] = False,
    ) -> str:
        """Ends a simulation and, with `forget`, deletes its files."""
        _check_name(name)
        query = {"forget": "true"} if forget else {}
        await box.hub.send("DELETE", f"{SIMULATIONS}/{name}", **query)
        return f"{quoted(name)} is stopped{' and forgotten' if forget else ''}."

    @box.changes("Insert a world")
    async def insert_world(
        name: Name,
        world: Annotated[
            str, Field(min_length=1, max_length=200, description="its name, as paper, or a path")
        ],
        x: Annotated[float, Field(ge=-1e5, le=1e5, description="where its origin comes [m]")] = 0.0,
        y: Annotated[float, Field(ge=-1e5, le=1e5, description="where its origin comes [m]")] = 0.0,
        yaw: Annotated[float, Field(ge=-7, le=7, description="turned by so much [rad]")] = 0.0,
    ) -> str:
        """Adds the models of a world to a simulation that runs, all of them or none."""
        _check_name(name)
        body = {"world": world, "x": x, "y": y, "yaw": yaw}
        answer = await box.hub.send("POST", f"{SIMULATIONS}/{name}/worlds", body)
        return _message(answer, "inserted")

    @box.changes("Save the world of a simulation")
    async def save_world(
        name: Name,
        world: Annotated[
            str, Field(min_length=1, max_length=40, description="its new name, as my-hall")
        ],
        replace: Annotated[bool, Field(description="replace a world of that name")] = False,
    ) -> str:
        """Saves the models of a simulation, where they stand now, as a world to start or insert."""
        _check_name(name)
        body = {"world": world, "replace": replace}
        return _message(await box.hub.send("POST", f"{SIMULATIONS}/{name}/save", body), "saved")

    @box.reads("List changes")
    async def list_changes(
        simulation: Annotated[str, Field(max_length=40, description="of it alone")] = "",
        limit: Annotated[int, Field(ge=1, le=200, description="largest count of entries")] = 20,
    ) -> str:
        """Lists the newest entries of the hub's journal: who asked for which change."""
        query = {"simulation": simulation, "limit": limit}
        rows = (await box.hub.get(JOURNAL, **query))["entries"]
        return "\n".join(map(_entry, reversed(rows))) or "Nothing was changed yet."

    @box.changes("Pause or speed up a simulation", repeatable=True)
    async def set_time(
        action: Annotated[
            Literal["pause", "resume", "speed"], Field(description="what becomes of time")
        ],
        factor: Annotated[
            float, Field(ge=0, le=1000, description="with speed: simulated s a s; 0: the most")
        ] = 1.0,
        simulation: Simulation = "",
    ) -> str:
        """Pauses a simulation, lets it go on, or sets how fast its time passes."""
        warehouse = await box.hub.simulation(simulation)
        body = {"factor": factor} if action == "speed" else None
        await warehouse.send("POST", f"simulation/{action}", body)
        pace = f"{factor:g} s a second" if factor else "as fast as it goes"
        done = {"pause": "is paused", "resume": "goes on", "speed": f"simulates {pace}"}[action]
        return f"{quoted(warehouse.name)} {done}."

    @box.reads("Read a simulation's log")
    async def simulation_log(
        name: Name,
        search: Annotated[str, Field(max_length=60, description="a word; empty: all")] = "",
    ) -> str:
        """Returns the last lines of a simulation's log, the newest first."""
        _check_name(name)
        text = await box.hub.text(f"{SIMULATIONS}/{name}/log")
        lines = [line for line in text.splitlines() if line.strip() and search in line]
        if not lines:
            return "The log has no such line. Leave `search` empty for all."
        newest = [quoted(line, 300) for line in reversed(lines[-200:])]
        return "\n".join(newest)[:MOST_LOG]


def _check_name(name: str) -> None:
    if not NAME.fullmatch(name):
        raise Trouble(f"{quoted(name)} is no simulation's name. Ask list_simulations.")


def _entry(row: dict[str, Any]) -> str:
    where = f" ({quoted(row['simulation'], 40)})" if row["simulation"] else ""
    state = "" if row["done"] else "refused, "
    return (
        f"{plain(row['wall'][:19], 30)} {plain(row['kind'], 20)} {quoted(row['who'])}:"
        f" {plain(row['action'], 80)}{where} {quoted(row['arguments'], 200)}:"
        f" {state}{quoted(row['outcome'], 120)}"
    )


def _message(answer: Any, otherwise: str) -> str:
    text = answer.get("message", "") if isinstance(answer, dict) else ""
    return sentence(plain(text, 300) or f"done: {otherwise}")


def _arguments(row: dict[str, Any]) -> str:
    return listed(f"{plain(k, 40)}={quoted(v, 60)}" for k, v in row["arguments"].items())


def _differs(row: dict[str, Any], body: dict[str, Any]) -> bool:
    had = {"name": row["name"], "shift": "false"} | row["arguments"]
    asked = {k: str(v).lower() if isinstance(v, bool) else str(v) for k, v in body.items()}
    return any(had.get(key) != value for key, value in asked.items())


def _row(row: dict[str, Any]) -> str:
    text = f"{quoted(row['name'])}: {row['state']}, {_arguments(row) or 'default arguments'}"
    if row["state"] in ("RUNNING", "PAUSED"):
        text += (
            f", {count(row['robots'], 'robot')}, real-time factor {row['rtf']:.2g},"
            f" up {duration(row['uptime_s'])}"
        )
    return text + (f", because {quoted(row['reason'], 300)}" if row.get("reason") else "")


def _argument(argument: dict[str, Any]) -> str:
    choices = [choice for choice in argument.get("choices", []) if choice]
    values = f" ({listed(choices)})" if choices else ""
    default = f"; default {quoted(argument['default'])}" if argument["default"] else ""
    return f"{argument['name']}{values}: {plain(argument['documentation'], 200)}{default}"
