# SPDX-License-Identifier: Apache-2.0
"""Opens a shift: with new stock, or with the stock and orders that a database holds."""

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_operations.policies import Policies
from warehouse_operations.runs import first_stock
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock import days, orders_text
from warehouse_operations.stock.assortment import Assortment, listed, stocked
from warehouse_operations.stock.demand import make_demand
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.order_file import DemandError, lines_by_sku
from warehouse_operations.stock.protocols import Requests
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.site import Site
from warehouse_operations.stock.stored_warehouse import Stored
from warehouse_operations.stock.travel import Travel
from warehouse_operations.stock.whereabouts import Whereabouts
from warehouse_operations.store.returning import changes, layout_of

if TYPE_CHECKING:
    from warehouse_operations.store.database import Database
    from warehouse_operations.store.database_journal import DatabaseJournal


def open_shift(
    site: Site,
    transports: Requests,
    *,
    orders: str = "fill",
    seed: int = 1,
    policies: Policies | Mapping[str, Any] | None = None,
    database: "Database | None" = None,
    settings: Settings | None = None,
    travel: Travel | None = None,
    now: float = 0.0,
) -> Shift:
    """Returns a new Shift at a Site, over transports.

    orders: see demand.make_demand. policies: the chosen ones by role. database: a shift continues
    its warehouse, or writes a new one into an empty database; None: no records. now: simulated time
    [s]. Raises SiteError, DemandError, PolicyError, DatabaseError.
    """
    journal: DatabaseJournal | None = None
    stored: Stored | None = None
    if not isinstance(policies, Policies):
        policies = Policies(policies)
    if database:
        from warehouse_operations.store import database_journal
        from warehouse_operations.store import stored as keeping

        with database.reading():
            stored = keeping.read(database.engine, now)
            journal = database_journal.DatabaseJournal(
                database,
                seed=seed,
                orders=str(orders),
                policies=policies.chosen,
                site=site.name,
                layout=layout_of(site),
                now=now,
            )
    # A continued run draws from another seed, or the same orders would come again.
    runs = () if journal is None else (journal.run_id,)
    chance = np.random.SeedSequence(seed if runs in ((), (1,)) else (seed, *runs))
    stock_rng, demand_rng, policy_rng = (np.random.default_rng(seeds) for seeds in chance.spawn(3))
    if stored and database:
        changed = changes(site, stored, database.url)
        assortment = stored.assortment
        stock = [(bin_, 0) for bin_ in (*stored.bins, *changed.new)]
    else:
        assortment, stock = _new_stock(str(orders), site, stock_rng)
    settings = settings or site.settings
    picks = [station.kind == "PICK" for station in site.plan.stations]
    refilling = [settings.of(station.name).replenishes for station in site.plan.stations]
    count = sum(picks), len(picks) - sum(picks) + sum(refilling)
    shift = Shift(
        transports,
        assortment,
        [bin_ for bin_, _ in stock],
        floor=Whereabouts(site.plan, site.robots, site.units, travel),
        policies=policies,
        demand=make_demand(
            orders,
            assortment,
            count,
            demand_rng,
            now,
            sum(bin_.capacity for bin_, _ in stock),
            site.sizes,
        ),
        settings=settings,
        journal=journal,
        rng=policy_rng,
        now=now,
        goods=site.goods,
    )
    if stored and database and journal:
        with database.reading():
            journal.resume(stored)
        journal.take_in(changed.new, changed.moved)
        shift.resume(stored, changed)
        journal.gone(changed.gone)
    else:
        if journal:
            journal.begin(assortment, shift.inventory.bins.values())
        shift.begin(stock)
    if journal:  # the initial state is written before the first change
        shift.commit()
        journal.flush()
    return shift


def assortment_of(orders: str, site: Site, rng: np.random.Generator) -> Assortment:
    """Returns the SKUs with which a new shift at a Site begins. Raises DemandError."""
    return _new_stock(orders, site, rng)[0]


def _new_stock(
    orders: str, site: Site, rng: np.random.Generator
) -> tuple[Assortment, list[tuple[Bin, int]]]:
    if site.stock:
        return listed(site.items, site.stock, rng)
    own = _own_skus(orders, site)
    if site.goods:
        assortment = own or first_stock.assortment(site.goods, rng)
        return assortment, first_stock.stocked(site.goods, site.items, rng, site.level, assortment)
    return stocked(site.items, rng, site.skus, level=site.level, own=own)


def _own_skus(orders: str, site: Site) -> Assortment | None:
    """Returns the SKUs of a file of orders, where a drawn stock would lack some of them; or None.

    Raises DemandError.
    """
    file = orders_text.file_of(orders)
    if not file:
        return None
    day = orders_text.day_of(orders)
    own = days.assortment_of(day) if day else Assortment.of_lines(lines_by_sku(file))
    if not day and all(re.fullmatch(r"sku-[1-9]\d*", sku) for sku in own.skus):
        return None  # those that are drawn
    if len(own.skus) > len(site.items):
        raise DemandError(
            f"{file}: {len(own.skus)} SKUs are asked for; there are {len(site.items)} bins (items),"
            " one of each SKU at least was expected"
        )
    return own
