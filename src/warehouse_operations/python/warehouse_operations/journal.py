# SPDX-License-Identifier: Apache-2.0
"""What a shift writes down; this one writes nothing. database.DatabaseJournal keeps it."""


class Journal:
    """Hears of everything that changes; commit() ends what belongs together."""

    def move(self, now, one, quantity, reason, line, station, visit):
        """Stock went into or out of a Bin."""

    def order(self, order):
        """An Order is new, or its state has changed."""

    def line(self, line):
        """Pieces of an order's Line were picked."""

    def assigned(self, order):
        """A station has taken an Order on."""

    def unassigned(self, order, now):
        """A station has given it back."""

    def visit(self, visit):
        """A Visit is new, or has come further."""

    def unit(self, unit, in_service):
        """A storage unit goes out of service, or comes back."""

    def event(self, now, kind, order_id, sku, quantity, station, unit, text):
        """Something happened to an order."""

    def commit(self, shift):
        """All that was told since the last call is one consistent state."""

    def flush(self):
        """Waits until everything that was committed is kept."""
