# SPDX-License-Identifier: Apache-2.0
"""A whole shift from a description to its folder: what simulate and sweep run."""

import contextlib
import hashlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from warehouse_fleet.planners.planner_plugins import PlannerError
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError, text_of
from warehouse_layout.file.request import items_for
from warehouse_layout.generate import layout_choice
from warehouse_layout.place import file_check, placement
from warehouse_operations.fleets import availability, measured
from warehouse_operations.fleets.availability import RealismError
from warehouse_operations.fleets.building import world_of
from warehouse_operations.policies import Policies, PolicyError
from warehouse_operations.runs import bodies, event_file, layout_site
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs.director import Director
from warehouse_operations.runs.event_file import Event, EventError
from warehouse_operations.runs.operations import Operations
from warehouse_operations.runs.progress import ProgressBar
from warehouse_operations.runs.rawsim import InstanceError, read_instance
from warehouse_operations.runs.rawsim_settings import ShiftSettings, read_settings
from warehouse_operations.stock.demand import DemandError
from warehouse_operations.stock.site import Site
from warehouse_operations.store import check
from warehouse_operations.store.database import DatabaseError
from warehouse_operations.store.locks import FileLock, InUseError
from warehouse_operations.store.returning import SiteError

if TYPE_CHECKING:
    from kiva_plugin_cpp import World

MOST_SEED = 2**63 - 1
WriteReport = Callable[[Path, Sequence[runs.Run]], object]  # writes the report about runs
# Errors of an invalid description.
ERRORS = (
    DatabaseError,
    DemandError,
    EventError,
    InUseError,
    InstanceError,
    LayoutFileError,
    PlannerError,
    PolicyError,
    RealismError,
    SiteError,
    runs.RunError,
)


@dataclass(frozen=True)
class Description:
    """A shift to be simulated. size: a preset; else layout, a file or a preset, or instance."""

    size: str = "medium"
    layout: str = ""  # a .layout.yaml file
    robots: int = 0  # overrides the layout's or the preset's number; 0: does not override it
    units: int = 0  # storage units of a generated warehouse; 0: it is not generated
    stations: int = 0  # picking stations that are open, the first ones; 0: all
    instance: str = ""  # an .xinst or .xlayo file
    settings: str = ""  # an .xsett file
    seconds: float = 3600.0
    orders: str = "fill"
    policies: dict[str, Any] = field(default_factory=dict)
    planner: dict[str, Any] = field(default_factory=dict)  # see planner_plugins; {}: EPIBT
    seed: int = 1
    physics: bool = True
    realism: str = ""  # of World: a preset or a YAML file
    threads: int = 0  # that step the world, and that plan; 0: one, and all cores but one
    events: tuple[Event, ...] = ()  # what happens in the shift, by time

    @property
    def config(self) -> dict[str, Any]:
        """The configuration in run.json: with the seed, it determines the outcome."""
        return {
            "site": self.site_name,
            "orders": self.orders,
            "policies": self.chosen_policies.chosen,
            "physics": self.physics,
            "seconds": self.seconds,
            **({"robots": self.robots} if self.robots else {}),
            **({"units": self.units} if self.units else {}),
            **({"stations": self.stations} if self.stations else {}),
            **({"realism": self.realism} if self.realism else {}),
            **({"planner": self.planner} if self.planner else {}),
            **({"events": [event.to_json() for event in self.events]} if self.events else {}),
            **({"layout": self._fingerprint} if self.layout else {}),
        }

    @property
    def site_name(self) -> str:
        """The name of the warehouse."""
        if self.layout:
            return layout_choice.chosen(self.layout).title
        if self.units:
            return f"{self.robots} robots, {self.units} units"
        return Path(self.instance).stem if self.instance else self.size

    @property
    def _fingerprint(self) -> str:
        """The hash of the layout: a sweep reuses a run only if its layout is unchanged."""
        text = text_of(layout_choice.chosen(self.layout))
        return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()

    @property
    def chosen_policies(self) -> Policies:
        """The policies of the description, and of the layout for other roles.

        Raises PolicyError.
        """
        if not self.layout:
            return Policies(self.policies)
        return layout_site.merged(layout_choice.chosen(self.layout), Policies(self.policies))


def with_settings(description: Description) -> Description:
    """Returns the Description with its defaults replaced by the settings file."""
    if not description.settings:
        return description
    settings, default = read_settings(description.settings), Description()
    return replace(
        description,
        orders=settings.orders if description.orders == default.orders else description.orders,
        policies=settings.policies | description.policies,
    )


def remarks(description: Description) -> list[str]:
    """Returns sentences about settings in its files that a shift does not follow.

    Raises one of ERRORS.
    """
    sentences: list[str] = []
    settings = read_settings(description.settings) if description.settings else None
    if settings:
        sentences += settings.not_followed
    if description.instance:
        site = read_instance(description.instance)
        chosen = _of_settings(site, settings) if settings else site
        sentences += _left_out(description.instance, chosen)
        for_bodies, steps = bodies.floor_for(site)
        if description.physics:
            sentences += bodies.not_driven(description.instance, site, steps)
        elif jams := bodies.jams(description.instance, for_bodies):
            sentences.append(f"{jams}; ideal robots, which pass through each other, work there")
    if description.layout:
        file = layout_choice.chosen(description.layout)
        texts = file_check.remarks(file) if description.physics else _of_bodies(file)
        sentences += [f"{description.layout}: {text}" for text in texts]
    return sentences


def _of_bodies(file: LayoutFile) -> list[str]:
    """Returns sentences about obstacles for robots with bodies alone; [] if the layout is
    impossible for ideal robots as well."""
    faults = file_check.faults(file)
    return [fault.text for fault in faults] if all(fault.is_of_bodies for fault in faults) else []


def _left_out(path: str, site: Site) -> list[str]:
    """Returns a sentence about SKUs of an instance that no pod holds a bundle of."""
    goods = site.goods
    if not goods or len(goods.skus) == len(goods.kinds.weights):
        return []
    count, most = len(goods.kinds.weights), max(goods.limits.values(), default=0.0)
    return [
        f"{path}: {count - len(goods.skus)} of {count} SKUs are left out: no pod"
        f" holds a bundle of them, at a Capacity of {most:g} at most; RAWSim-O ends with an error"
        " where it draws one at the begin"
    ]


def open_operations(description: Description, database: str | None = None) -> Operations:
    """Opens the shift of a Description; raises one of ERRORS."""
    if not description.events:
        return _open_operations(description, database)
    whole, spare = with_spare_robots(description)
    ops = _open_operations(whole, database)
    try:
        robots = sorted(ops.site.robots)
        Director(ops, description.events, robots[len(robots) - spare :], description.seed)
    except EventError:
        ops.close()
        raise
    return ops


def with_spare_robots(description: Description) -> tuple[Description, int]:
    """Returns a Description with the robots of all its events, and the number of those that come
    later. Raises EventError."""
    spare = event_file.most_added(description.events)
    if not spare:
        return description, 0
    if description.instance:
        event = next(event for event in description.events if event.kind == "robots")
        raise event.fault("adds some; an instance has its own, a layout or a size was expected")
    robots = description.robots
    if not robots:
        file = layout_choice.chosen(description.layout or description.size)
        robots = len(placement.place(file, description.seed).robots)
    return replace(description, robots=robots + spare), spare


def _open_operations(description: Description, database: str | None = None) -> Operations:
    world: World | None
    if description.robots and description.instance:
        raise InstanceError("robots: an instance has its own; a layout or a size was expected")
    if description.instance:
        site = read_instance(description.instance)
        if description.settings:
            site = _of_settings(site, read_settings(description.settings))
        _check_bundles(description.instance, site)
        world = None
        if description.physics:
            site, _ = bodies.floor_for(site)
            if jams := bodies.jams(description.instance, site):
                raise InstanceError(
                    f"{jams}; simulate without physics: ideal robots, which pass through each"
                    " other, work there"
                )
            with _errors_as_ours():
                world, site = world_of(site, **_options(description))
    elif description.units:
        world = _generated(description)
        site = Site.of_world(world, description.site_name)
    elif description.layout or description.robots:
        file = layout_choice.chosen(description.layout or description.size)
        if not description.physics and _of_bodies(file):
            world, robots = None, description.robots or None
            site = Site.of_layout(placement.place(file, description.seed, robots), file.title)
        else:
            world = _of_layout(description)
            site = Site.of_world(world, file.title)
        site = layout_site.of_file(site, file)
    else:
        world = _preset(description)
        site = Site.of_world(world, description.size)
    if description.settings:
        site = replace(site, sizes=read_settings(description.settings).sizes)
    site = measured.read(description.realism).at(site)
    check_stations(description, site)
    if description.planner and not description.physics:
        raise PlannerError("planner: ideal robots pass through each other; physics was expected")
    ops = Operations(
        world,
        site=site,
        orders=description.orders,
        seed=description.seed,
        policies=description.chosen_policies,
        database=database,
        physics=description.physics,
        threads=description.threads,
        planner=description.planner or None,
        availability=None if description.physics else availability.read(description.realism),
    )
    if description.stations:
        ops.shift.open_picking(description.stations)
    return ops


def _of_settings(site: Site, settings: ShiftSettings) -> Site:
    """Returns the Site of an instance with the stock of a settings file."""
    goods = site.goods
    if goods and settings.kinds:
        goods = replace(goods, kinds=settings.kinds)
    items = goods.items() if goods else site.items
    return replace(site, level=settings.level or site.level, goods=goods, items=items)


def _check_bundles(path: str, site: Site) -> None:
    """Raises InstanceError where no bundle fits on any pod."""
    if site.goods and not site.goods.skus:
        most = max(site.goods.limits.values(), default=0.0)
        raise InstanceError(
            f"{path}: no bundle of any SKU fits on a pod of Capacity {most:g}; a Capacity for the"
            " lightest at least was expected"
        )


def check_stations(description: Description, site: Site) -> None:
    """Raises InstanceError for more open stations than there are."""
    count = sum(station.kind == "PICK" for station in site.plan.stations)
    if description.stations > count:
        raise InstanceError(
            f"stations is {description.stations}; {site.name} has {count} for picking"
        )


def simulate(
    description: Description,
    folder: str | Path,
    database: str | Path | None = None,
    progress: ProgressBar | None = None,
    observe: Callable[[Operations], None] | None = None,
    write_report: WriteReport | None = None,
) -> tuple[runs.Run, list[str]]:
    """Runs a shift and writes its folder; returns the Run and its faults, sentences.

    database: None: a new one in the folder. observe: called at the begin and after each cycle.
    write_report: as reports.report.write; None: no report.
    """
    folder = Path(folder)
    with _locked(folder):
        kept = database or _new_database(folder)
        run, faults = _simulate(description, folder, kept, progress, observe)
        if write_report:
            write_report(folder / runs.REPORT, [run])
        return run, faults


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = FileLock(folder)
    except OSError as error:
        raise runs.RunError(f"{folder}: {error.strerror}") from error
    with lock:
        yield


def _new_database(folder: Path) -> Path:
    path = folder / runs.DATABASE
    with FileLock(path):
        for suffix in ("", "-wal", "-shm"):
            Path(f"{path}{suffix}").unlink(missing_ok=True)
    return path


def _simulate(
    description: Description,
    folder: Path,
    database: str | Path,
    progress: ProgressBar | None,
    observe: Callable[[Operations], None] | None,
) -> tuple[runs.Run, list[str]]:
    with open_operations(description, str(database)) as ops:
        ops.run(seconds=description.seconds, progress=progress, observe=observe)
        if progress:
            progress.end(ops)
        kept: Any = ops.database
        ops.shift.commit()
        kept.flush()
        with kept.reading():
            faults = check.faults(kept.engine)
        run = runs.write(folder, ops, description.config, description.seed)
        stuck = ops.fleet.stuck
    if run.kpis["collisions"]:
        faults.append(f"{run.kpis['collisions']} collisions")
    if stuck:
        faults.append(f"robots that are stuck: {stuck}")
    return run, faults


def _of_layout(description: Description) -> "World":
    from kiva_plugin_cpp import World

    with _errors_as_ours():
        return World.layout(
            description.layout or description.size,
            robots=description.robots or None,
            **_options(description),
        )


def _generated(description: Description) -> "World":
    from kiva_plugin_cpp import World

    if not description.robots:
        raise InstanceError("units without robots; both were expected")
    if description.layout:
        raise InstanceError(
            "units: a layout has its own; leave out the layout to have a warehouse generated"
        )
    with _errors_as_ours():
        return World.create(
            robots=description.robots,
            shelves=description.units,
            items=items_for(description.units),
            **_options(description),
        )


def _preset(description: Description) -> "World":
    from kiva_plugin_cpp import World

    with _errors_as_ours():
        return World.preset(description.size, **_options(description))


def _options(description: Description) -> dict[str, Any]:
    """Returns the options of any World of a Description."""
    return {
        "seed": description.seed,
        "threads": description.threads or 1,
        "realism": description.realism or None,
    }


@contextlib.contextmanager
def _errors_as_ours() -> Iterator[None]:
    """Converts the error of an unknown preset or an invalid realism into one of ERRORS."""
    try:
        yield
    except LayoutFileError:
        raise
    except (ValueError, FileNotFoundError) as error:
        raise InstanceError(str(error)) from error
