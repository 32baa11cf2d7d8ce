# SPDX-License-Identifier: Apache-2.0
"""The part of a layout file about shifts: settings of stations, policies and initial stock."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError, StationEntry
from warehouse_layout.file.request import LIMITS
from warehouse_layout.place.placement import stock_of, weights_of
from warehouse_operations.fleets import measured
from warehouse_operations.fleets.availability import RealismError
from warehouse_operations.fleets.measured import Measured
from warehouse_operations.policies import Policies, PolicyError, beside
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.site import Site, Stock


def of_file(site: Site, file: LayoutFile) -> Site:
    """Returns the Site of a warehouse that was built of a layout file, with the file's stock and
    settings.

    What the file says of a station goes before what its measured file does. Raises LayoutFileError
    for a stock file, a file of SKUs or a measured file that is wrong.
    """
    site = _measured(file).at(site)
    # Units may be gone by now: bins whose items are missing are left out.
    rows = stock_of(file, LIMITS["shelves"])
    # The items are numbered by the rows of the stock.
    stock = [Stock(f"item{i}", row.sku, row.quantity) for i, row in enumerate(rows, start=1)]
    return replace(
        site,
        name=site.name or file.title,
        settings=replace(site.settings, by_station=_merged(site, settings_of(file))),
        stock=stock,
        weights=weights_of(file),
    )


def _measured(file: LayoutFile) -> Measured:
    """Returns what the measured file of a layout says. Raises LayoutFileError."""
    if not file.measured:
        return Measured()
    try:
        return measured.read(str(file.beside_file(file.measured)))
    except RealismError as error:
        raise LayoutFileError(f"{file.path or file.title}: measured: {error}") from error


def _merged(site: Site, own: Settings) -> dict[str, dict[str, Any]]:
    """Returns the settings of each station: those of a file over those of a site."""
    names = {**site.settings.by_station, **own.by_station}
    return {
        name: {**site.settings.by_station.get(name, {}), **own.by_station.get(name, {})}
        for name in names
    }


def settings_of(file: LayoutFile) -> Settings:
    """Returns the Settings of a file's stations."""
    return Settings(by_station={station.name: _of(station) for station in file.stations})


def _of(entry: StationEntry) -> dict[str, Any]:
    """Returns the settings of a station by their names in Settings."""
    names = {
        "capacity": "slots",
        "seconds_a_piece": "bundle_s" if entry.kind == "replenish" else "piece_s",
        "pick_seconds": "pick_s",
        "seconds_a_line": "line_s",
    }
    settings = {names.get(name, name): value for name, value in entry.settings.items()}
    for name in ("piece_s", "bundle_s"):
        if isinstance(pace := settings.get(name), tuple):  # mean and deviation
            settings |= {name: pace[0]} | ({"piece_sd": pace[1]} if name == "piece_s" else {})
    return settings | ({"replenishes": True} if entry.kind == "both" else {})


def policies_of(file: LayoutFile) -> Policies:
    """Returns the policies of a layout file. Raises PolicyError with its name."""
    return Policies(_policies(file), f"{file.path or file.title}: policies")


def _policies(file: LayoutFile) -> dict[str, Any]:
    return beside(dict(file.policies), Path(file.path or ".").parent)


def merged(file: LayoutFile, policies: Policies) -> Policies:
    """Returns the policies, and for the roles that they leave out those of a layout file.

    Raises PolicyError.
    """
    policies_of(file)
    return Policies({**_policies(file), **policies.choices})


def fault(file: LayoutFile) -> str:
    """Returns the fault in the policies of a layout file, a sentence; "" without one."""
    try:
        policies_of(file)
    except PolicyError as error:
        return str(error)
    return ""
