# SPDX-License-Identifier: Apache-2.0
"""All simulations of the hub: limits, persistence, and a check of each once a second."""

import asyncio
import shutil
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from warehouse_sim.hub import insertion, saving, wish
from warehouse_sim.hub.guest import Guest
from warehouse_sim.hub.process import sweep
from warehouse_sim.hub.simulation import Simulation, State
from warehouse_sim.hub.wish import NAME, Wish, WishError
from warehouse_sim.hub.worlds import Worlds

INTERVAL, INTERVAL_STARTING = 1.0, 0.2  # between two checks [s, wall]
GRACE = 20.0  # for what a killed hub had started to end by itself [s, wall]
MOST_KEPT = 200  # simulations that are listed, STOPPED ones included


T = TypeVar("T")


class Conflict(RuntimeError):  # noqa: N818 (an answer)
    """Raised for a request that conflicts with the present state; says why."""


class Missing(LookupError):  # noqa: N818 (an answer)
    """Raised for an unknown simulation."""


@dataclass(frozen=True)
class Limits:
    """The limits of a hub's simulations, together and each."""

    most: int = 4  # simulations that run at once
    memory: int = 8000 << 20  # of each simulation [bytes]
    idle: float = 24 * 3600.0  # without requests to its pages before it is stopped [s, wall]


class Simulations:
    """The simulations of a folder. Coroutines belong to one asyncio loop.

    `environment` is that of the processes; `worlds` has worlds that were saved. `ended` is called
    with the name of a simulation that ended without a request, and the reason.
    """

    def __init__(
        self,
        folder: Path,
        limits: Limits,
        environment: Mapping[str, str],
        worlds: Worlds,
        ended: Callable[[str, str], object] = lambda _name, _reason: None,
    ) -> None:
        self._folder, self._limits, self.worlds = folder, limits, worlds
        self._ended = ended
        self._environment = dict(environment)
        self._all: dict[str, Simulation] = {}
        self._locks: dict[str, asyncio.Lock] = {}
        # Checks and stops wait for processes; requests for pages have the loop's own threads.
        self._threads = ThreadPoolExecutor(limits.most + 4, thread_name_prefix="simulation")
        folder.mkdir(parents=True, exist_ok=True)
        for file in sorted(folder.glob("*/simulation.json")):
            with suppress(OSError, ValueError):
                known = Wish.from_json(file.read_text())
                if known.name == file.parent.name and NAME.fullmatch(known.name):
                    self._all[known.name] = Simulation(known, file.parent)

    def rows(self) -> list[dict[str, Any]]:
        """Returns all simulations as the API lists them, running ones first."""
        ordered = sorted(self._all.values(), key=lambda s: (not s.lives, s.wish.name))
        return [simulation.row() for simulation in ordered]

    def folders(self) -> list[tuple[str, Path]]:
        """Returns the name and the folder of each simulation that was started here."""
        own = (s for s in [*self._all.values()] if not isinstance(s, Guest))
        return [(simulation.wish.name, simulation.folder) for simulation in own]

    def __getitem__(self, name: str) -> Simulation:
        """Returns the simulation of that name. Raises Missing."""
        try:
            return self._all[name]
        except KeyError:
            raise Missing(f"there is no simulation '{name[:40]}'") from None

    async def _in_thread(self, action: Callable[..., T], *arguments: object) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._threads, action, *arguments)

    def _lock(self, name: str) -> asyncio.Lock:
        return self._locks.setdefault(name, asyncio.Lock())

    async def create(self, body: Mapping[str, Any]) -> Simulation:
        """Starts the simulation that a request's body describes.

        Raises WishError where the body is wrong, Conflict where the name is taken or the limit of
        simulations is reached, OSError.
        """
        asked = await self._in_thread(wish.read, self._with_saved_world(body), self._folder)
        async with self._lock(asked.name):
            if asked.name in self._all:
                text = "another name, or DELETE it with ?forget=true"
                raise Conflict(f"there is a simulation '{asked.name}' already; {text}")
            self._check_room()
            if len(self._all) >= MOST_KEPT:
                raise Conflict(f"{MOST_KEPT} simulations are kept; delete some with ?forget=true")
            folder = self._folder / asked.name
            folder.mkdir(exist_ok=True)
            simulation = self._all[asked.name] = Simulation(asked, folder)
            simulation.state = State.STARTING  # counts from now on
            try:
                simulation.wish = await self._in_thread(wish.written, asked, folder)
                await self._in_thread(simulation.start, self._environment)
            except BaseException:
                del self._all[asked.name]
                shutil.rmtree(folder, ignore_errors=True)
                raise
        return simulation

    def _with_saved_world(self, body: Mapping[str, Any]) -> Mapping[str, Any]:
        """Returns the body of a request in which a saved world is named by its path."""
        world = body.get("world")
        return (
            body if not isinstance(world, str) else {**body, "world": self.worlds.resolved(world)}
        )

    async def join(self, name: str, body: Mapping[str, Any]) -> Simulation:
        """Lists a warehouse that runs elsewhere on this machine, at the body's `address`.

        Raises WishError, Conflict if the name is taken.
        """
        if not NAME.fullmatch(name):
            raise wish.WishError("name", "small letters, digits and '-' were expected")
        guest = Guest(name, body.get("address"))
        known = self._all.get(name)
        if known and not isinstance(known, Guest):
            raise Conflict(f"there is a simulation '{name}' already")
        self._all[name] = guest
        return guest

    def _check_room(self) -> None:
        living = [s.wish.name for s in self._all.values() if s.lives and not isinstance(s, Guest)]
        if len(living) >= self._limits.most:
            names = ", ".join(sorted(living))
            raise Conflict(f"{len(living)} simulations run ({names}), and no more may; stop one")

    async def start_again(self, name: str) -> Simulation:
        """Starts a simulation that does not run. Raises Missing, Conflict, OSError."""
        async with self._lock(name):
            simulation = self[name]
            if simulation.lives:
                raise Conflict(f"'{name}' runs already")
            self._check_room()
            await self._in_thread(simulation.start, self._environment)
            return simulation

    async def stop(self, name: str, forget: bool = False) -> Simulation:
        """Ends a simulation; `forget`: and deletes its log, recordings and databases.

        Raises Missing, Conflict for one that was started elsewhere.
        """
        async with self._lock(name):
            simulation = self[name]
            if isinstance(simulation, Guest):
                raise Conflict(f"'{name}' was started elsewhere; end it there, by Ctrl-C")
            if simulation.lives or simulation.process:
                await self._in_thread(simulation.stop, State.STOPPED, "", not forget)
            if forget:
                del self._all[name]
                await self._in_thread(shutil.rmtree, simulation.folder, True)
            return simulation

    async def restart(self, name: str) -> Simulation:
        """Ends a simulation that runs, and starts it again. Raises Missing, Conflict, OSError."""
        if self[name].lives:
            await self.stop(name)
        return await self.start_again(name)

    async def insert(self, name: str, body: Mapping[str, Any]) -> str:
        """Adds the models of a world to a running simulation; returns what was added.

        Raises Missing, Conflict if something stands there or it does not run, WishError.
        """
        async with self._lock(f"insert {name}"):
            simulation = self._running(name)
            return await self._in_thread(insertion.insert, simulation, self._with_saved_world(body))

    async def save_world(self, name: str, body: Mapping[str, Any]) -> dict[str, Any]:
        """Saves the world of a simulation that runs under a name; returns what was saved.

        Raises Missing, Conflict, Taken, WishError, OSError.
        """
        if unknown := sorted(body.keys() - {"world", "replace"}):
            raise WishError(unknown[0][:100], "world and replace were expected")
        async with self._lock(f"insert {name}"):
            simulation = self._running(name)
            path = self.worlds.new_path(body.get("world"), body.get("replace", False))
            return await self._in_thread(saving.save, simulation, path)

    async def keep_recording(self, name: str) -> int:
        """Keeps the last hour of a simulation that runs; returns its size [bytes].

        Raises Missing, Conflict, OSError.
        """
        async with self._lock(f"keep {name}"):
            return await self._in_thread(self._running(name).keep_recording)

    def _running(self, name: str) -> Simulation:
        simulation = self[name]
        if isinstance(simulation, Guest):
            raise Conflict(f"'{name}' was started elsewhere; the hub does not change it")
        if not simulation.viewer or simulation.process is None:
            raise Conflict(f"'{name}' is {simulation.state.value}; it must run")
        return simulation

    async def watch(self) -> None:
        """Checks all simulations until it is cancelled; first ends what a killed hub left."""
        grace = time.monotonic() + GRACE
        while True:
            if grace and time.monotonic() > grace:
                grace = 0.0
                await self._in_thread(self._end_orphans)
            await asyncio.gather(*map(self._look, [*self._all.values()]))
            starting = any(s.state is State.STARTING for s in self._all.values())
            await asyncio.sleep(INTERVAL_STARTING if starting else INTERVAL)

    def _end_orphans(self) -> None:
        """Kills processes of simulations that this hub did not start."""
        for name, folder in self.folders():
            if self._all[name].process is None and not self._lock(name).locked():
                sweep(folder)

    async def _look(self, simulation: Simulation) -> None:
        name = simulation.wish.name
        if not simulation.lives or self._lock(name).locked():
            return
        async with self._lock(name):
            await self._in_thread(simulation.look, self._limits.memory)
            if isinstance(simulation, Guest):
                if simulation.is_gone:
                    del self._all[name]
                return
            idle = time.monotonic() - simulation.used
            if simulation.lives and idle > self._limits.idle:
                hours = self._limits.idle / 3600
                reason = f"its pages were not asked for in {hours:g} hours"
                await self._in_thread(simulation.stop, State.STOPPED, reason)
            if not simulation.lives:
                await self._in_thread(self._ended, name, simulation.reason)

    async def close(self) -> None:
        """Ends all simulations at once."""
        living = [s.wish.name for s in self._all.values() if s.process]
        await asyncio.gather(*map(self.stop, living))
        self._threads.shutdown()
