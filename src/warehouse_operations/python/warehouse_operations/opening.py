# SPDX-License-Identifier: Apache-2.0
"""How a shift begins: with new stock, or with what a database has kept."""

import numpy as np

from warehouse_operations.assortment import stocked
from warehouse_operations.demand import make_demand
from warehouse_operations.policies import Policies
from warehouse_operations.returning import changes, layout_of
from warehouse_operations.shift import Shift
from warehouse_operations.whereabouts import Whereabouts


def open_shift(
    site,
    transports,
    *,
    orders="fill",
    seed=1,
    policies=None,
    database=None,
    settings=None,
    travel=None,
    now=0.0,
):
    """A Shift in a Site over transports.

    database: a Database whose warehouse the shift goes on with, or in
    which it begins one; None: nothing is kept. now: simulated time [s]. Raises SiteError,
    DemandError, PolicyError, DatabaseError.
    """
    journal = stored = None
    if not isinstance(policies, Policies):
        policies = Policies(policies)
    if database:
        from warehouse_operations import stored as keeping
        from warehouse_operations.database_journal import DatabaseJournal

        with database.reading():
            stored = keeping.read(database.engine, now)
            journal = DatabaseJournal(
                database,
                seed=seed,
                orders=str(orders),
                policies=policies.chosen,
                site=site.name,
                layout=layout_of(site),
                now=now,
            )
    # A run that goes on has its own chance, or the same orders would come again.
    runs = () if journal is None else (journal.run_id,)
    chance = np.random.SeedSequence(seed if runs in ((), (1,)) else (seed, *runs))
    stock_rng, demand_rng, policy_rng = (np.random.default_rng(one) for one in chance.spawn(3))
    if stored:
        changed = changes(site, stored, database.url)
        assortment = stored.assortment
        stock = [(one, 0) for one in (*stored.bins, *changed.new)]
    else:
        assortment, stock = stocked(site.items, stock_rng, site.skus, level=site.level)
    kinds = [station.kind for station in site.plan.stations]
    count = kinds.count("PICK"), kinds.count("REPLENISH")
    shift = Shift(
        transports,
        assortment,
        [one for one, _ in stock],
        floor=Whereabouts(site.plan, site.robots, site.units, travel),
        policies=policies,
        demand=make_demand(
            orders, assortment, count, demand_rng, now, sum(one.capacity for one, _ in stock)
        ),
        settings=settings or site.settings,
        journal=journal,
        rng=policy_rng,
        now=now,
    )
    if stored:
        with database.reading():
            journal.resume(stored)
        journal.take_in(changed.new, changed.moved)
        shift.resume(stored, changed)
        journal.gone(changed.gone)
    else:
        if journal:
            journal.begin(shift)
        shift.begin(stock)
    return shift
