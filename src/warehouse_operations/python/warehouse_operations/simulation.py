# SPDX-License-Identifier: Apache-2.0
"""A whole shift from a description to its folder: what simulate and sweep run."""

import contextlib
from dataclasses import dataclass, field, replace
from pathlib import Path

from warehouse_operations import check, report, runs
from warehouse_operations.building import world_of
from warehouse_operations.database import DatabaseError
from warehouse_operations.demand import DemandError
from warehouse_operations.locks import FileLock, InUseError
from warehouse_operations.operations import Operations
from warehouse_operations.policies import Policies, PolicyError
from warehouse_operations.rawsim import InstanceError, read_instance, read_settings
from warehouse_operations.returning import SiteError
from warehouse_operations.site import Site

MOST_SEED = 2**63 - 1
# What a wrong description can raise.
ERRORS = (
    DatabaseError,
    DemandError,
    InUseError,
    InstanceError,
    PolicyError,
    SiteError,
    runs.RunError,
)


@dataclass(frozen=True)
class Description:
    """A shift to be simulated. size: a preset; else instance, an .xinst file."""

    size: str = "medium"
    instance: str = ""
    settings: str = ""  # an .xsett file
    seconds: float = 3600.0
    orders: str = "fill"
    policies: dict = field(default_factory=dict)
    seed: int = 1
    physics: bool = True
    realism: str = ""  # of World: a preset or a YAML file

    @property
    def config(self):
        """What run.json tells of it: all that decides about the outcome but the seed."""
        return {
            "site": Path(self.instance).stem if self.instance else self.size,
            "orders": self.orders,
            "policies": Policies(self.policies).chosen,
            "physics": self.physics,
            "seconds": self.seconds,
            **({"realism": self.realism} if self.realism else {}),
        }


def with_settings(description):
    """The Description with what its settings file says, where that says more than the default."""
    if not description.settings:
        return description
    told, default = read_settings(description.settings), Description()
    return replace(
        description,
        orders=told.orders if description.orders == default.orders else description.orders,
        policies=told.policies | description.policies,
    )


def open_operations(description, database=None):
    """The Operations of a Description; raises one of ERRORS."""
    if description.instance:
        site = read_instance(description.instance)
        if description.settings:
            told = read_settings(description.settings)
            site = replace(site, level=told.level or site.level)
        world = None
        if description.physics:
            with _told_as_ours():
                world, site = world_of(site, description.seed, description.realism)
    else:
        world = _preset(description)
        site = Site.of_world(world, description.size)
    return Operations(
        world,
        site=site,
        orders=description.orders,
        seed=description.seed,
        policies=Policies(description.policies),
        database=database,
        physics=description.physics,
    )


def simulate(description, folder, database=None, progress=None):
    """Runs a shift and writes its folder; returns the Run and what is wrong with it, sentences.

    database: None: a new one in the folder.
    """
    folder = Path(folder)
    with contextlib.ExitStack() as held:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            held.enter_context(FileLock(folder))
        except OSError as error:
            raise runs.RunError(f"{folder}: {error.strerror}") from error
        return _simulate(description, folder, database or _new_database(folder), progress)


def _new_database(folder):
    path = folder / runs.DATABASE
    with FileLock(path):
        for suffix in ("", "-wal", "-shm"):
            Path(f"{path}{suffix}").unlink(missing_ok=True)
    return path


def _simulate(description, folder, database, progress):
    with open_operations(description, str(database)) as ops:
        ops.run(seconds=description.seconds, progress=progress)
        if progress:
            progress.end(ops)
        engine = ops.database.engine
        ops.shift.journal.commit(ops.shift)
        ops.database.flush()
        with ops.database.reading():
            faults = check.faults(engine)
        run = runs.write(folder, ops, description.config, description.seed)
        stuck = ops.fleet.stuck
    report.write(folder / runs.REPORT, [run])
    if run.kpis["collisions"]:
        faults.append(f"{run.kpis['collisions']} collisions")
    if stuck:
        faults.append(f"{stuck} robots are stuck")
    return run, faults


def _preset(description):
    from kiva_plugin_cpp import World

    with _told_as_ours():
        return World.preset(
            description.size, seed=description.seed, realism=description.realism or None
        )


@contextlib.contextmanager
def _told_as_ours():
    """An unknown preset, or a file of realism that is wrong, is one of ERRORS."""
    try:
        yield
    except (ValueError, FileNotFoundError) as error:
        raise InstanceError(str(error)) from error
