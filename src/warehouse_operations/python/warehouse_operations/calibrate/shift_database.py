# SPDX-License-Identifier: Apache-2.0
"""The recording that the database of a shift is: pieces, units at stations, failures.

Stamps are simulated. Gaps are between moves of stock from the same unit at the same station.
"""

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from sqlalchemy import select
from sqlalchemy.engine import Connection
from sqlalchemy.exc import SQLAlchemyError

from warehouse_operations.calibrate.recording import (
    NOWHERE,
    Arrival,
    CalibrationError,
    Piece,
    Recording,
    require,
)
from warehouse_operations.fleets.availability import HOUR
from warehouse_operations.stock.inventory import Reason
from warehouse_operations.store import schema
from warehouse_operations.store.engines import MAGIC, make_engine, path_of, reason
from warehouse_operations.store.moment import check_version

PICKS, PUTS = Reason.PICK.value, Reason.PUT.value


def read(url: str) -> Recording:
    """Returns the Recording of the last run of a database. Raises CalibrationError or
    DatabaseError."""
    engine = make_engine(url)
    path = path_of(engine)
    require(not path or Path(path).is_file(), f"{url}: there is no such file")
    try:
        with engine.connect() as connection:
            check_version(connection, url)
            return _recording(connection, url)
    except SQLAlchemyError as error:
        raise CalibrationError(
            f"{url}: {reason(error)}; a whole database of a shift was expected"
        ) from error
    finally:
        engine.dispose()


def is_database(path: Path) -> bool:
    """Returns whether a file begins as an SQLite database does."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def _recording(connection: Connection, url: str) -> Recording:
    run = connection.execute(select(schema.run).order_by(schema.run.c.id.desc()).limit(1)).first()
    require(run is not None, f"{url}: no shift was run in it")
    assert run is not None
    visits = connection.execute(select(schema.visit).where(schema.visit.c.run == run.id)).all()
    move = schema.move.c
    moves = select(move.stamp, move.visit, move.quantity, move.reason, move.order_id, move.line)
    moves = moves.where(move.run == run.id, move.visit.is_not(None)).order_by(move.id)
    rows = connection.execute(moves).all()
    require(bool(rows), f"{url}: nothing was picked or put in; a shift at work was expected")
    out = Recording(sources=[f"{url}: {len(visits)} units at stations, {len(rows)} moves"])
    by_station: dict[str, list[Any]] = defaultdict(list)
    visit_of = {visit.id: visit for visit in visits}
    for row in rows:
        if row.visit in visit_of:
            by_station[visit_of[row.visit].station].append(row)
    for station, its in by_station.items():
        _station(out, station, its, visit_of)
    _failures(out, run)
    return out


def _station(out: Recording, station: str, rows: Sequence[Any], visits: dict[int, Any]) -> None:
    """Adds what was done at a station."""
    picks = [row for row in rows if row.reason == PICKS]
    puts = [row for row in rows if row.reason == PUTS]
    for before, after in zip(picks, picks[1:]):
        if before.visit == after.visit:
            new = (before.order_id, before.line) != (after.order_id, after.line)
            gap = after.stamp - before.stamp
            out.pieces.append(Piece(station, gap, -after.quantity, new))
    for before, after in zip(puts, puts[1:]):
        if before.visit == after.visit:
            out.bundles.append(Piece(station, after.stamp - before.stamp))
    out.arrivals.extend(_arrivals(station, picks, visits))


def _arrivals(station: str, picks: Sequence[Any], visits: dict[int, Any]) -> Iterator[Arrival]:
    """Yields how units came to a station at which pieces were taken."""
    last: Any = None
    for row in picks:
        visit = visits[row.visit]
        if last is None or last.visit != row.visit:
            idle = visit.arrived - last.stamp if last is not None else NOWHERE
            left = visits[last.visit].released if last is not None else None
            # A unit that had waited in the lane set out as soon as the one before left.
            waited = left is not None and left > visit.lifted and visit.arrived > left
            new = last is None or (last.order_id, last.line) != (row.order_id, row.line)
            yield Arrival(
                station,
                row.stamp - visit.arrived,
                idle,
                -row.quantity,
                new,
                visit.arrived - left if waited else NOWHERE,
            )
        last = row


def _failures(out: Recording, run: Any) -> None:
    """Adds the failures of the figures of a run that is over; those of one that is not are not
    in its database."""
    figures = json.loads(run.kpis) if run.kpis else {}
    hours = figures.get("robots", 0) * figures.get("simulated_s", 0.0) / HOUR
    count = int(figures.get("failures", 0))
    if count and hours:
        out.robot_hours = hours
        out.failures = [""] * count
        out.repairs = [figures["mttr_s"]] * count
