# SPDX-License-Identifier: Apache-2.0
"""Rows to be written to the database of a warehouse."""

from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np
from sqlalchemy import Table, bindparam, insert, update
from sqlalchemy.engine import Connection

from warehouse_operations.store import schema

TABLES = (  # in the order in which rows may refer to each other
    schema.run,
    schema.sku,
    schema.unit,
    schema.bin_,
    schema.orders,
    schema.order_line,
    schema.assignment,
    schema.visit,
    schema.move,
    schema.event,
    schema.heat,
    schema.report,
)
PLAIN = frozenset((int, float, str, bool, bytes, type(None)))  # types of most values


class Rows:
    """Collects rows to be inserted and changes of existing rows, by table and key.

    A key is a value, or a tuple where the primary key has several columns.
    """

    def __init__(self) -> None:
        self.inserts: dict[Table, dict[Any, dict[str, Any]]] = defaultdict(dict)
        self.updates: dict[Table, dict[Any, dict[str, Any]]] = defaultdict(dict)

    def __bool__(self) -> bool:
        return bool(self.inserts or self.updates)

    def insert(self, table: Table, key: Any, **values: Any) -> None:
        """Adds a row with the values by column."""
        self.inserts[table][key] = _without_numpy(values)

    def update(self, table: Table, key: Any, **values: Any) -> None:
        """Changes values by column of a row, pending or existing."""
        self._update(table, key, _without_numpy(values))

    def _update(self, table: Table, key: Any, values: dict[str, Any]) -> None:
        known = self.inserts[table] if key in self.inserts.get(table, ()) else self.updates[table]
        known.setdefault(key, {}).update(values)

    def merge(self, later: "Rows") -> None:
        """Adds later rows and changes to these."""
        for table, rows in later.inserts.items():
            self.inserts[table].update(rows)
        for table, rows in later.updates.items():
            for key, values in rows.items():
                self._update(table, key, values)

    def write(self, connection: Connection) -> None:
        """Writes all rows in the transaction of a connection."""
        for table in TABLES:
            names = [column.name for column in table.primary_key]
            if table in self.inserts:
                connection.execute(
                    insert(table),
                    [_named(names, key) | row for key, row in self.inserts[table].items()],
                )
            # Changes of the same columns are one statement.
            alike: dict[tuple[str, ...], list[dict[str, Any]]] = defaultdict(list)
            for key, row in self.updates.get(table, {}).items():
                alike[tuple(row)].append(
                    {f"key_{n}": v for n, v in _named(names, key).items()} | row
                )
            for columns, rows in alike.items():
                where = [table.c[name] == bindparam(f"key_{name}") for name in names]
                values = {column: bindparam(column) for column in columns}
                connection.execute(update(table).where(*where).values(values), rows)


def _without_numpy(values: dict[str, Any]) -> dict[str, Any]:
    """Replaces numpy's types in place, which psycopg2 writes as numpy 2 shows them."""
    if PLAIN.issuperset(map(type, values.values())):
        return values
    for name, value in values.items():
        if isinstance(value, np.generic):
            values[name] = value.item()
    return values


def _named(names: Sequence[str], key: Any) -> dict[str, Any]:
    return dict(zip(names, key if isinstance(key, tuple) else (key,)))
