# SPDX-License-Identifier: Apache-2.0
"""The tables of a warehouse's database, and how a database of an older version becomes a new one.

Times are simulated seconds of the run that a row belongs to. Stock is the sum of moves; `bin` holds
that sum, and its promised pieces.
"""

from collections.abc import Callable, Mapping
from typing import Any

from sqlalchemy import (
    BigInteger,
    CheckConstraint,
    Column,
    Float,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    insert,
    inspect,
    select,
    text,
    update,
)
from sqlalchemy.engine import Connection

VERSION = 4
metadata = MetaData()


class SchemaError(Exception):
    """Raised for an unusable database; says why."""


class EmptyError(SchemaError):
    """Raised for a database without tables."""


def _id(**options: Any) -> Column:
    return Column("id", Integer, primary_key=True, autoincrement=False, **options)


schema_version = Table("schema_version", metadata, Column("version", Integer, primary_key=True))

run = Table(
    "run",
    metadata,
    _id(),
    Column("began", String(40), nullable=False),  # wall clock, ISO 8601, UTC
    Column("ended", String(40)),
    Column("site", Text, nullable=False),
    Column("layout", Text),  # JSON: the stations with their places
    Column("seed", Integer, nullable=False),
    Column("orders", Text, nullable=False),
    Column("policies", Text, nullable=False),  # JSON
    Column("began_s", Float, nullable=False),  # simulated time of its begin, and the latest
    Column("simulated_s", Float, nullable=False),
    Column("kpis", Text),  # JSON
)

sku = Table(
    "sku",
    metadata,
    Column("sku", String(80), primary_key=True),
    Column("number", Integer, nullable=False, unique=True),
    Column("popularity", Float, nullable=False),
)

# in_service is 1 everywhere; databases of earlier versions have the column, too.
unit = Table("unit", metadata, _id(), Column("in_service", Integer, nullable=False))

bin_ = Table(
    "bin",
    metadata,
    _id(),
    Column("item", String(80), nullable=False, unique=True),
    Column("unit", ForeignKey("unit.id"), nullable=False),
    Column("sku", ForeignKey("sku.sku"), nullable=False),
    Column("quantity", Integer, nullable=False),
    Column("reserved", Integer, nullable=False),
    Column("capacity", Integer, nullable=False),  # 0: it has left the warehouse
    CheckConstraint("reserved >= 0 AND reserved <= quantity", name="reserved_in_stock"),
)

orders = Table(
    "orders",
    metadata,
    _id(),
    # The run of its times: the one in which it came, or the last one that took it over.
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("reference", String(200), nullable=False, index=True),
    Column("created", Float, nullable=False),
    Column("due", Float, nullable=False),
    Column("priority", Integer, nullable=False),
    Column("state", Integer, nullable=False, index=True),  # OrderState
    Column("station", String(80), nullable=False),
    Column("completed", Float),
)

order_line = Table(
    "order_line",
    metadata,
    Column("order_id", ForeignKey("orders.id"), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("sku", ForeignKey("sku.sku"), nullable=False),
    Column("quantity", Integer, nullable=False),
    Column("picked", Integer, nullable=False),
    CheckConstraint("picked >= 0 AND picked <= quantity", name="picked_in_order"),
)

assignment = Table(
    "assignment",
    metadata,
    _id(),
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("order_id", ForeignKey("orders.id"), nullable=False, index=True),
    Column("station", String(80), nullable=False),
    Column("stamp", Float, nullable=False),
    Column("ended", Float),  # when the station gave the order back
)

visit = Table(
    "visit",
    metadata,
    _id(),
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("transport_id", Integer, nullable=False),
    Column("unit", ForeignKey("unit.id"), nullable=False),
    Column("station", String(80), nullable=False),
    Column("requested", Float, nullable=False),
    Column("lifted", Float),
    Column("arrived", Float),
    Column("released", Float),
    Column("ended", Float),
    Column("outcome", String(20), nullable=False),  # stored, failed, cancelled, interrupted
    Column("pieces", Integer, nullable=False),
)

move = Table(
    "move",
    metadata,
    _id(),
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("stamp", Float, nullable=False),
    Column("bin", ForeignKey("bin.id"), nullable=False),
    Column("sku", ForeignKey("sku.sku"), nullable=False),
    Column("quantity", Integer, nullable=False),  # below 0: taken out
    Column("reason", String(20), nullable=False),
    Column("order_id", Integer),
    Column("line", Integer),
    Column("visit", ForeignKey("visit.id")),
    ForeignKeyConstraint(["order_id", "line"], ["order_line.order_id", "order_line.number"]),
    Index("move_by_bin", "bin"),
    Index("move_by_line", "order_id", "line"),
)

event = Table(
    "event",
    metadata,
    _id(),
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("stamp", Float, nullable=False),
    Column("kind", Integer, nullable=False),  # OrderEventKind
    Column("order_id", ForeignKey("orders.id"), nullable=False, index=True),
    Column("sku", String(80), nullable=False),
    Column("quantity", Integer, nullable=False),
    Column("station", String(80), nullable=False),
    Column("shelf_id", Integer, nullable=False),
    Column("text", Text, nullable=False),
)

# Robots' drives and waits in the last hour, a row for each twelfth of it; rows are reused.
heat = Table(
    "heat",
    metadata,
    Column("slot", Integer, primary_key=True, autoincrement=False),
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("began_s", Float, nullable=False),
    Column("maps", LargeBinary, nullable=False),  # FloorHeat's of that time, compressed
)

# Reports of people at stations with an id (code): a repetition gets the same answer.
report = Table(
    "report",
    metadata,
    _id(),
    Column("run", ForeignKey("run.id"), nullable=False),
    Column("stamp", Float, nullable=False),
    Column("code", String(80), nullable=False),
    Column("station", String(80), nullable=False),
    Column("order_id", Integer, nullable=False),  # 0: pieces were put in
    Column("item", String(80), nullable=False),
    Column("sequence", BigInteger, nullable=False),
    Column("quantity", Integer, nullable=False),
    Column("outcome", Integer, nullable=False),
    Column("done", Integer, nullable=False),  # pieces taken, put in or written off
    Column("message", Text, nullable=False),
)

# From each older version to the next: a function of a connection.
MIGRATIONS: dict[int, Callable[[Connection], object]] = {
    1: heat.create,
    2: lambda connection: connection.execute(text("ALTER TABLE run ADD COLUMN layout TEXT")),
    3: report.create,
}


def prepare(
    connection: Connection,
    version: int = VERSION,
    migrations: Mapping[int, Callable[[Connection], object]] | None = None,
    makes: bool = True,
) -> None:
    """Creates the tables, or brings those of an older version up to date; raises SchemaError.

    makes: whether to create them in a database without any.
    """
    migrations = MIGRATIONS if migrations is None else migrations
    tables = set(inspect(connection).get_table_names())
    if schema_version.name not in tables:
        # A file belongs to one program; a server's database may be shared.
        is_file = connection.dialect.name == "sqlite"
        taken = sorted(tables if is_file else tables & set(metadata.tables))
        if taken:
            more = f" and {len(taken) - 5} more" if taken[5:] else ""
            raise SchemaError(
                f"the database has tables of another program: {', '.join(taken[:5])}{more}"
            )
        if not makes:
            raise EmptyError("there is no warehouse in it")
        metadata.create_all(connection)
        connection.execute(insert(schema_version).values(version=version))
        return
    versions = connection.execute(select(schema_version.c.version)).scalars().all()
    if len(versions) != 1 or not isinstance(versions[0], int) or versions[0] < 1:
        words = ", ".join(map(str, versions)) or "none"
        raise SchemaError(f"the schema version is {words}; 1 to {version} was expected")
    (current,) = versions
    if current > version:
        raise SchemaError(
            f"the database is of schema version {current}; this program knows {version} and older"
        )
    for step in range(current, version):
        migrations[step](connection)
        connection.execute(update(schema_version).values(version=step + 1))
    _check_tables(connection)


def _check_tables(connection: Connection) -> None:
    """Raises SchemaError if a table or a column is missing."""
    there = inspect(connection)
    names = set(there.get_table_names())
    for table in metadata.sorted_tables:
        if table.name not in names:
            raise SchemaError(f"the table '{table.name}' is missing")
        columns = {column["name"] for column in there.get_columns(table.name)}
        if lacking := sorted(set(table.columns.keys()) - columns):
            raise SchemaError(f"the table '{table.name}' has no column {', '.join(lacking)}")
