# SPDX-License-Identifier: Apache-2.0
"""Which bin new stock goes to."""


class Random:
    def choose(self, bundle, candidates, view):
        return candidates[view.rng.integers(len(candidates))]


class Emptiest:
    """On the emptiest unit, its emptiest bin."""

    def choose(self, bundle, candidates, view):
        return max(candidates, key=lambda one: (view.room(one.unit), one.room, -one.bin_id))


class SameSku:
    """With others of its SKU, the fullest bin that has room; else the emptiest."""

    def choose(self, bundle, candidates, view):
        return max(
            candidates,
            key=lambda one: (one.sku == bundle.sku and not one.empty, -one.room, -one.bin_id),
        )


class Turnover:
    """What is asked for often on units near the stations, what is not far away."""

    def choose(self, bundle, candidates, view):
        wanted = view.popularity_rank(bundle.sku)

        def distance(one):
            cell = view.cell(one.unit)
            return abs(float(view.place_rank([cell])[0]) - wanted) if cell is not None else 1.0

        return min(candidates, key=lambda one: (distance(one), one.bin_id))


NAMES = {
    "random": Random,
    "emptiest": Emptiest,
    "same sku": SameSku,
    "turnover": Turnover,
}
