# SPDX-License-Identifier: Apache-2.0
"""The measured motion of robots and the measured pace of stations, as a realism has them.

Sections `motion` (also of simulated robots) and `service` (of stations alone) of a realism file,
which `calibrate` writes (doc/how-to/calibrate.md).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from warehouse_fleet.robots.kinematics import MOTION
from warehouse_layout.file.station_settings import StationSettingError, check_setting
from warehouse_operations.fleets.availability import RealismError, content_of
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.site import Site

MOTION_LIMITS = {"speed": 10.0, "acceleration": 100.0}  # as of the world; times: 1000 s
SECTIONS = ("motion", "service")
# The settings of a station, by their names in a file.
SERVICE = {
    "seconds_a_piece": "piece_s",
    "pick_seconds": "pick_s",
    "seconds_a_line": "line_s",
    "seconds_a_bundle": "bundle_s",
}
STATIONS = "stations"  # those that differ, by name


@dataclass(frozen=True)
class Measured:
    """What was measured. motion: by the names of a file. service: as Settings names it, of all
    stations; by_station: of those that differ."""

    motion: Mapping[str, float] = field(default_factory=dict)
    service: Mapping[str, float] = field(default_factory=dict)
    by_station: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def at(self, site: Site) -> Site:
        """Returns a Site with what was measured, in place of its own settings."""
        names = [station.name for station in site.plan.stations]
        measured = {
            name: {**self.service, **self.by_station.get(name, {})}
            for name in names
            if self.service or name in self.by_station
        }
        own = site.settings.by_station
        by_station = {
            name: {**own.get(name, {}), **measured.get(name, {})} for name in {*own, *measured}
        }
        settings: Settings = replace(site.settings, by_station=by_station)
        kinematics = site.kinematics.measured(self.motion)
        return replace(site, settings=settings, kinematics=kinematics)


def read(realism: str) -> Measured:
    """Returns what the realism of a name or file measured; "": nothing. Raises RealismError."""
    return of_content(content_of(realism) or {}, realism) if realism else Measured()


def of_content(data: Any, realism: str = "realism") -> Measured:
    """Returns what the sections of a realism measured. Raises RealismError with its name."""
    if not isinstance(data, dict):
        raise RealismError(f"{realism}: sections with parameters were expected")
    motion, service = (_numbers(data, section, realism) for section in SECTIONS)
    stations = service.pop(STATIONS, {})
    if not isinstance(stations, dict) or not all(isinstance(v, dict) for v in stations.values()):
        raise RealismError(f"{realism}: service: {STATIONS}: settings by station were expected")
    return Measured(
        {key: _motion(key, value, realism) for key, value in motion.items()},
        _service(service, f"{realism}: service"),
        {
            str(name): _service(settings, f"{realism}: service: {name}")
            for name, settings in stations.items()
        },
    )


def _numbers(data: Mapping[str, Any], section: str, realism: str) -> dict[str, Any]:
    values = data.get(section, False)
    if isinstance(values, bool) or values is None:
        return {}
    if not isinstance(values, dict):
        raise RealismError(f"{realism}: {section} is {values!r}; true, false or parameters")
    return dict(values)


def _motion(key: str, value: Any, realism: str) -> float:
    if key not in MOTION:
        raise RealismError(f"{realism}: motion: unknown {key!r}; it takes {', '.join(MOTION)}")
    most = MOTION_LIMITS.get(key, 1000.0)
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not (math.isfinite(value) and 0 <= value <= most):
        raise RealismError(
            f"{realism}: motion: {key} is {value!r}; a number from 0 to {most:g} was expected"
        )
    return float(value)


def _service(values: Mapping[str, Any], where: str) -> dict[str, float]:
    """Returns settings of a station by their names in Settings."""
    out: dict[str, float] = {}
    for key, value in values.items():
        if key not in SERVICE:
            raise RealismError(f"{where}: unknown {key!r}; it takes {', '.join(SERVICE)}")
        try:
            # A bundle's time has the bounds of a piece's.
            setting: Any = check_setting(key.replace("bundle", "piece"), value)
        except StationSettingError as error:
            raise RealismError(f"{where}: {error}") from error
        if isinstance(setting, tuple):
            setting, deviation = setting
            if key == "seconds_a_piece":
                out["piece_sd"] = deviation
        out[SERVICE[key]] = float(setting)
    return out
