# SPDX-License-Identifier: Apache-2.0
"""Which orders and bins have changed, for those who follow a shift live."""


class ChangeJournal:
    """Passes what a shift writes down on to another Journal, and remembers what it was about."""

    def __init__(self, journal):
        self._journal = journal
        self._orders, self._bins = {}, {}

    def __getattr__(self, name):
        return getattr(self._journal, name)

    def order(self, order):
        self._note(order)
        self._journal.order(order)

    def line(self, line):
        self._note(line.order)
        self._journal.line(line)

    def assigned(self, order):
        self._note(order)
        self._journal.assigned(order)

    def unassigned(self, order, now):
        self._note(order)
        self._journal.unassigned(order, now)

    def commit(self, shift):
        self._bins.update((one.bin_id, one) for one in shift.inventory.changed)
        self._journal.commit(shift)

    def take_orders(self):
        """The Orders that have changed since the last call."""
        orders, self._orders = self._orders, {}
        return list(orders.values())

    def take_bins(self):
        """Likewise the Bins, of which a commit was told."""
        bins, self._bins = self._bins, {}
        return list(bins.values())

    def _note(self, order):
        self._orders[order.order_id] = order
