# SPDX-License-Identifier: Apache-2.0
"""Orders that a vehicle refuses (6.6.4): the master takes it in, and does not hammer."""

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.orders import content
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.errors import ErrorType
from warehouse_vda5050.topics import Kind

chapter = Chapter("errors")
case = chapter.case
MOST = 8  # orders to a vehicle that refuses each, in WINDOW
WINDOW = 20.0  # [s]
BACK_OFF = 0.5  # least time between a refusal and the next order [s]


def _refusing(stage: Stage, type: ErrorType, updates: bool = False) -> tuple[Actor, list[Entry]]:
    """Has all vehicles refuse by an error; returns one that did, and the orders it was sent in
    WINDOW. Raises Untestable."""
    if updates:
        stage.under_way(1)
    else:
        stage.idle()
    for actor in stage.actors:
        actor.vehicle.refusal = type.value, updates
    mark = stage.mark
    refused = stage.until(lambda: _refused(stage, mark), stage.settings.patience)
    if not refused:
        what = "update" if updates else "order"
        raise Untestable(f"the master sent no {what} within {stage.settings.patience:.0f} s")
    actor = next(a for a in stage.actors if a.name == refused[0].vehicle)
    stage.wait(WINDOW)
    return actor, stage.received(Kind.ORDER, mark, actor)


def _refused(stage: Stage, mark: int) -> list[Entry]:
    entries = stage.received(Kind.ORDER, mark)
    return [e for e in entries if not e.scene["accepted"].value and not e.missed]


def _demand_patience(stage: Stage, entries: list[Entry]) -> None:
    """Demands that what was refused is not sent again as it was, nor much else."""
    refused = [e for e in entries if not e.scene["accepted"].value]
    first = refused[0]
    again = [
        e
        for e in refused[1:]
        if content(e.value or {}) == content(first.value or {})
        and e.time > first.time + stage.settings.reaction
    ]
    demand(not again, "the refused order is sent again as it was")
    demand(len(refused) <= MOST, f"{len(refused)} orders in {WINDOW:.0f} s; {MOST} at most")


def _goes_on(stage: Stage, actor: Actor) -> None:
    actor.vehicle.refusal = None
    stage.an_order(stage.mark, actor)


@case("order", "6.6.4.2")
def order(stage: Stage) -> None:
    """A master whose order was refused by orderError does not send it again as it was, and does
    not hammer."""
    _, entries = _refusing(stage, ErrorType.ORDER)
    _demand_patience(stage, entries)


@case("validation", "6.6.4.1")
def validation(stage: Stage) -> None:
    """A master whose order was refused by validationError does not send it again as it was."""
    _, entries = _refusing(stage, ErrorType.VALIDATION)
    _demand_patience(stage, entries)


@case("no_route", "6.6.4")
def no_route(stage: Stage) -> None:
    """A master whose order was refused by noRouteError does not send it again as it was."""
    _, entries = _refusing(stage, ErrorType.NO_ROUTE)
    _demand_patience(stage, entries)


@case("update", "6.6.4.3")
def update(stage: Stage) -> None:
    """A master whose update was refused by orderUpdateError does not send it again as it was."""
    _, entries = _refusing(stage, ErrorType.ORDER_UPDATE, updates=True)
    _demand_patience(stage, entries)


@case("goes_on", "6.6.4")
def goes_on(stage: Stage) -> None:
    """A refusal is not the end: a vehicle that takes orders again is sent one."""
    actor, _ = _refusing(stage, ErrorType.ORDER)
    _goes_on(stage, actor)


@case("waits", "6.6.4", strict=True)
def waits(stage: Stage) -> None:
    """After a refusal some time passes before the next order, and more after each."""
    _, entries = _refusing(stage, ErrorType.ORDER)
    refused = [e for e in entries if not e.scene["accepted"].value]
    gaps = [b.time - a.time for a, b in zip(refused, refused[1:])]
    demand(all(gap >= BACK_OFF for gap in gaps), f"orders came {min(gaps, default=0):.2f} s apart")
    third = len(gaps) // 3
    rises = third == 0 or sum(gaps[-third:]) >= 0.9 * sum(gaps[:third])
    demand(rises, f"the times between orders are {', '.join(f'{gap:.1f}' for gap in gaps)} s")
