# SPDX-License-Identifier: Apache-2.0
"""Checks that a database balances: every piece exists once, every task was done once and whole."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from sqlalchemy import text
from sqlalchemy.engine import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from warehouse_operations.store.engines import DatabaseError, path_of, reason

# Pieces picked from a unit or put into it, by the moves of a visit.
DONE_TO_UNIT = """COALESCE(SUM(CASE m.reason WHEN 'undone' THEN -ABS(m.quantity)
           ELSE ABS(m.quantity) END), 0)"""
# Number of an order's completions without those that were reopened, by its events.
COMPLETED = "COALESCE(SUM(CASE e.kind WHEN 3 THEN 1 WHEN 7 THEN -1 ELSE 0 END), 0)"
# Each rule selects impossible rows; their columns fill its sentence.
RULES = (
    (
        "bin {0} ({1}) holds {2} pieces of {3}; its moves add up to {4}",
        """SELECT b.id, b.item, b.quantity, b.sku, COALESCE(SUM(m.quantity), 0) FROM bin b
           LEFT JOIN move m ON m.bin = b.id AND m.sku = b.sku
           GROUP BY b.id, b.item, b.quantity, b.sku
           HAVING b.quantity <> COALESCE(SUM(m.quantity), 0)""",
    ),
    (
        "bin {0} holds {1}; moves of {2} there add up to {3} instead of 0",
        """SELECT b.id, b.sku, m.sku, SUM(m.quantity) FROM bin b JOIN move m ON m.bin = b.id
           WHERE m.sku <> b.sku GROUP BY b.id, b.sku, m.sku HAVING SUM(m.quantity) <> 0""",
    ),
    (
        "bin {0} ({1}): {2} of {3} pieces are reserved, it has room for {4}",
        """SELECT id, item, reserved, quantity, capacity FROM bin
           WHERE reserved < 0 OR reserved > quantity OR quantity > capacity""",
    ),
    (
        "bin {0}: after move {1} it would have held {2} pieces",
        """SELECT bin, id, held FROM (SELECT id, bin, SUM(quantity) OVER
           (PARTITION BY bin ORDER BY id) AS held FROM move) AS sums WHERE held < 0""",
    ),
    (
        "line {1} of order {0}: {2} of {3} are picked; moves say {4}",
        """SELECT l.order_id, l.number, l.picked, l.quantity, COALESCE(-SUM(m.quantity), 0)
           FROM order_line l LEFT JOIN move m
           ON m.order_id = l.order_id AND m.line = l.number AND m.reason IN ('pick', 'undone')
           GROUP BY l.order_id, l.number, l.picked, l.quantity
           HAVING l.picked <> COALESCE(-SUM(m.quantity), 0) OR l.picked > l.quantity""",
    ),
    (
        "move {0}: a pick of {1} that belongs to no order line",
        "SELECT id, sku FROM move WHERE reason = 'pick' AND order_id IS NULL",
    ),
    (
        "move {0} took {1}; the line {3} of order {2} asks for {4}",
        """SELECT m.id, m.sku, m.order_id, m.line, l.sku FROM move m JOIN order_line l
           ON m.order_id = l.order_id AND m.line = l.number WHERE m.sku <> l.sku""",
    ),
    (
        "order {0} is complete; {1} of its pieces were not picked",
        """SELECT o.id, SUM(l.quantity - l.picked) FROM orders o JOIN order_line l
           ON l.order_id = o.id WHERE o.state = 2
           GROUP BY o.id HAVING SUM(l.quantity - l.picked) <> 0""",
    ),
    (
        "order {0} is in state {1}; it was completed {2} times",
        f"""SELECT o.id, o.state, {COMPLETED}
           FROM orders o LEFT JOIN event e ON e.order_id = o.id AND e.kind IN (3, 7)
           GROUP BY o.id, o.state
           HAVING {COMPLETED}
           <> CASE WHEN o.state = 2 THEN 1 ELSE 0 END""",
    ),
    (
        "visit {0} has {1} pieces; its moves add up to {2}",
        f"""SELECT v.id, v.pieces, {DONE_TO_UNIT} FROM visit v
           LEFT JOIN move m ON m.visit = v.id GROUP BY v.id, v.pieces
           HAVING v.pieces <> {DONE_TO_UNIT}""",
    ),
    (
        "unit {0} is on {1} visits at once",
        """SELECT unit, COUNT(*) FROM visit WHERE ended IS NULL
           GROUP BY unit HAVING COUNT(*) > 1""",
    ),
)


def faults(engine: Engine, most: int = 20) -> list[str]:
    """Returns sentences about faults, up to `most` a rule; [] without any.

    Raises DatabaseError where values can't be read, as after damage to the file.
    """
    sentences = []
    with _reading(engine) as connection:
        for sentence, query in RULES:
            rows = connection.execute(text(query)).fetchmany(most)
            sentences += [sentence.format(*row) for row in rows]
    return sentences


def summary(engine: Engine) -> dict[str, Any]:
    """Returns the numbers of pieces, reservations, bins, moves, orders by state and visits.

    Raises DatabaseError where they can't be read.
    """
    queries = {
        "pieces": "SELECT COALESCE(SUM(quantity), 0) FROM bin",
        "reserved": "SELECT COALESCE(SUM(reserved), 0) FROM bin",
        "bins": "SELECT COUNT(*) FROM bin WHERE capacity > 0",
        "moves": "SELECT COUNT(*) FROM move",
        "orders": "SELECT COUNT(*) FROM orders",
        "completed": "SELECT COUNT(*) FROM orders WHERE state = 2",
        "visits": "SELECT COUNT(*) FROM visit",
    }
    with _reading(engine) as connection:
        return {name: connection.execute(text(q)).scalar() for name, q in queries.items()}


@contextmanager
def _reading(engine: Engine) -> Iterator[Connection]:
    """Opens a connection for reading; its errors name the database."""
    try:
        with engine.connect() as connection:
            yield connection
    except SQLAlchemyError as error:
        name = path_of(engine) or engine.url.render_as_string()
        raise DatabaseError(f"{name}: {reason(error)}") from error
