# SPDX-License-Identifier: Apache-2.0
"""A shift at a moment, from which many runs go on: its fork.

A fork holds the whole shift (orders open and promised, stock, visits, work in hand, what comes) as
bytes, and its fleet as plain data. What surrounds a shift is no part of it, and each run has its
own: robots, ways, records, and generators of random numbers.
"""

import hashlib
import io
import pickle
import types
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.fleets.fleet_now import FleetNow
from warehouse_operations.fleets.forked_fleet import Pace
from warehouse_operations.shift.journal import Journal
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock.demand import alike
from warehouse_operations.stock.order_file import OrderDraft
from warehouse_operations.stock.travel import Travel

PROTOCOL = 5
HASH: type = type(hashlib.blake2b())
VALUES: type = type({}.values())
# Parts that a run has of its own.
TRANSPORTS, TRAVEL, PLAN, JOURNAL = "transports", "travel", "plan", "journal"
OWN_ROOMS = ("shift", "stock", "policies")


class ForkError(Exception):
    """Raised where a shift can't be forked; says why."""


@dataclass(frozen=True)
class Fork:
    """A shift at a time [s], and its fleet. shift: as bytes. began: its begin [s]. ways_back: how
    long units took back into storage lately [s]. recent: orders like which others come, where
    nothing else says what comes. pace: of robots from now on. world: a checkpoint, for simulated
    robots; empty: they are ideal."""

    time: float
    began: float
    shift: bytes
    fleet: FleetNow
    ways_back: tuple[float, ...] = ()
    recent: tuple[OrderDraft, ...] = ()
    pace: Pace = Pace()
    world: bytes = b""

    @property
    def size(self) -> int:
        """The size as it is sent to a run [bytes]."""
        return len(self.packed())

    def packed(self) -> bytes:
        """Returns the fork as compressed bytes."""
        return zlib.compress(pickle.dumps(self, PROTOCOL), 1)


def of_shift(shift: Shift, fleet: FleetNow, recent: Sequence[OrderDraft] = ()) -> Fork:
    """Returns the fork of a shift with its fleet, which both go on as if nothing had happened.

    Raises ForkError where a policy of one's own holds what can't be copied.
    """
    file = io.BytesIO()
    try:
        _Pickler(file, shift).dump(shift)
    except (TypeError, AttributeError, pickle.PicklingError) as error:
        raise ForkError(f"the shift can't be copied: {error}") from error
    return Fork(
        shift.now, shift.began, file.getvalue(), fleet, tuple(shift.tally.ways_back), tuple(recent)
    )


def shift_of(fork: Fork, parts: Mapping[str, Any], seed: tuple[int, ...]) -> Shift:
    """Returns the shift of a fork: as it was, with the parts of a run, and chance of its own.

    parts: TRANSPORTS, TRAVEL and PLAN.
    """
    shift = _Unpickler(io.BytesIO(fork.shift), parts, seed).load()
    assert isinstance(shift, Shift)
    rng = np.random.default_rng((*seed, 0))
    if fork.recent:
        shift.demand = alike(fork.recent, fork.began, shift.now, rng)
    elif shift.demand:
        shift.demand.draw_anew(rng, shift.now)
    return shift


def part(name: str, number: int = 0) -> Any:
    """Stands for a part that a run has of its own; an _Unpickler gives it."""
    raise ForkError(f"a fork is read by shift_of() alone ({name}, {number})")


def nothing(*_: Any) -> None:
    """Does nothing, in place of a call that leads out of a shift."""


def new_hash() -> Any:
    """Returns the hash of a run, without events."""
    return hashlib.blake2b(digest_size=8)


class _Pickler(pickle.Pickler):
    """Writes a shift without its surroundings."""

    def __init__(self, file: io.BytesIO, shift: Shift) -> None:
        super().__init__(file, PROTOCOL)
        self._transports, self._journal = shift.transports, shift.journal
        self._generators: dict[int, int] = {}

    def reducer_override(self, obj: Any) -> Any:
        """Returns how an object is written; NotImplemented: as it is."""
        kind = type(obj)
        if obj is self._transports:
            return part, (TRANSPORTS,)
        if obj is self._journal:
            return part, (JOURNAL,)
        if kind is Travel:
            return part, (TRAVEL,)
        if kind is FloorPlan:
            return part, (PLAN,)
        if kind is np.random.Generator:
            return part, ("rng", self._generators.setdefault(id(obj), len(self._generators) + 1))
        if kind is HASH:
            return new_hash, ()
        if kind is VALUES:
            return tuple, (list(obj),)
        if kind is types.FunctionType and "<" in obj.__qualname__:
            return part, ("nothing",)
        if kind is types.MethodType and not _is_own(obj.__self__):
            return part, ("nothing",)
        return NotImplemented


def _is_own(owner: Any) -> bool:
    """Returns whether an object belongs to a shift."""
    room = type(owner).__module__.split(".")
    return len(room) > 1 and room[0] == __name__.split(".")[0] and room[1] in OWN_ROOMS


class _Parts:
    """The parts of a run, by name; the generators among them by number."""

    def __init__(self, parts: Mapping[str, Any], seed: tuple[int, ...]) -> None:
        self._parts, self._seed = dict(parts) | {JOURNAL: Journal(), "nothing": nothing}, seed
        self._generators: dict[int, np.random.Generator] = {}

    def __call__(self, name: str, number: int = 0) -> Any:
        if name != "rng":
            return self._parts[name]
        if number not in self._generators:
            self._generators[number] = np.random.default_rng((*self._seed, number))
        return self._generators[number]


class _Unpickler(pickle.Unpickler):
    """Reads a shift, with the parts of a run."""

    def __init__(self, file: io.BytesIO, parts: Mapping[str, Any], seed: tuple[int, ...]) -> None:
        super().__init__(file)
        self._parts = _Parts(parts, seed)

    def find_class(self, module: str, name: str) -> Any:
        """Returns what a name stands for."""
        if module == __name__ and name == part.__name__:
            # No method of this object: its memo would refer to it and all that was read, a cycle
            # that Python does not find.
            return self._parts
        return super().find_class(module, name)
