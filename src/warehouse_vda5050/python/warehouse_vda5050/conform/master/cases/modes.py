# SPDX-License-Identifier: Apache-2.0
"""Who commands a vehicle (6.10.6, operating modes), where it is, what it reports as broken."""

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.cases.actions import instant_actions
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.errors import Error, ErrorLevel
from warehouse_vda5050.model import OperatingMode
from warehouse_vda5050.topics import Kind

chapter = Chapter("modes")
case = chapter.case
ASKING = ("stateRequest", "factsheetRequest", "logReport")  # which command nothing
LOW = 3.0  # charge with which no vehicle should carry something [%]


def _in_mode(stage: Stage, mode: OperatingMode) -> None:
    actor = stage.idle()
    actor.report(mode=mode)
    stage.no_orders(actor, f"came in operatingMode {mode.value}")
    stage.goes_on(actor)


@case("manual", "6.10.6")
def manual(stage: Stage) -> None:
    """A vehicle in MANUAL is sent no order, and orders again when it is in AUTOMATIC."""
    _in_mode(stage, OperatingMode.MANUAL)


@case("service", "6.10.6")
def service(stage: Stage) -> None:
    """A vehicle in SERVICE is sent no order."""
    _in_mode(stage, OperatingMode.SERVICE)


@case("teach_in", "6.10.6")
def teach_in(stage: Stage) -> None:
    """A vehicle in TEACHIN is sent no order."""
    _in_mode(stage, OperatingMode.TEACHIN)


@case("manual_under_way", "6.10.6")
def manual_under_way(stage: Stage) -> None:
    """A vehicle that a person takes over under way has no order any more, and is sent none."""
    actor = stage.under_way()
    actor.report(mode=OperatingMode.MANUAL)
    stage.no_orders(actor, "came after it went MANUAL under way")
    stage.goes_on(actor)


@case("manual_actions", "6.10.6")
def manual_actions(stage: Stage) -> None:
    """A vehicle in MANUAL is sent no instant actions, but questions."""
    actor = stage.idle()
    actor.report(mode=OperatingMode.MANUAL)
    stage.wait(stage.settings.reaction)
    mark = stage.mark
    stage.wait(stage.settings.watch)
    entries = stage.received(Kind.INSTANT_ACTIONS, mark, actor)
    kinds = {str(a.get("actionType")) for e in entries for a in instant_actions(e)} - {*ASKING}
    demand(not kinds, f"{', '.join(sorted(kinds))} came in MANUAL")


@case("semiautomatic", "6.10.6")
def semiautomatic(stage: Stage) -> None:
    """A vehicle in SEMIAUTOMATIC is under the master's control: it is sent orders."""
    actor = stage.idle()
    actor.report(mode=OperatingMode.SEMIAUTOMATIC)
    stage.wait(stage.settings.reaction)
    stage.an_order(stage.mark, actor)


@case("lost", "6.10.6")
def lost(stage: Stage) -> None:
    """A vehicle that does not know where it is is sent no order."""
    actor = stage.idle()
    actor.report(localized=False)
    stage.no_orders(actor, "came while positionInitialized was false")
    stage.goes_on(actor)


@case("pushed", "6.6.1")
def pushed(stage: Stage) -> None:
    """After a person has pushed a vehicle, its next order begins where it stands now."""
    actor = _with_a_way(stage)
    here = actor.robot.x, actor.robot.y
    places = [(p.x, p.y) for p in actor.floor.places if (p.x, p.y) != here]
    actor.push(*places[-1])
    stage.wait(stage.settings.reaction)
    entry = stage.an_order(stage.mark, actor, accepted=False)
    demand(entry.scene["accepted"].value, "it does not begin there: the vehicle refuses it")


def _with_a_way(stage: Stage) -> Actor:
    actor = stage.idle()
    if len(actor.floor.places) < 2:
        raise Untestable("the master has sent no order with two nodes")
    return actor


@case("fatal", "6.10.5")
def fatal(stage: Stage) -> None:
    """A vehicle with an error FATAL needs a person first, and is sent no order."""
    actor = stage.idle()
    error = Error("motorError", ErrorLevel.FATAL, "the drive has no torque")
    actor.report(errors=(error,))
    stage.no_orders(actor, "came while it reported an error FATAL")
    stage.goes_on(actor)


@case("warning", "6.10.5", strict=True)
def warning(stage: Stage) -> None:
    """An error WARNING resolves itself: the order under way is not cancelled for it."""
    actor = stage.under_way()
    order = actor.vehicle.state().order_id
    mark = stage.mark
    actor.report(errors=(Error("wheelSlip", ErrorLevel.WARNING, "the wheels slip"),))
    stage.wait(stage.settings.reaction)
    cancels = [
        action
        for entry in stage.received(Kind.INSTANT_ACTIONS, mark, actor)
        for action in instant_actions(entry)
        if action.get("actionType") == "cancelOrder"
    ]
    demand(not cancels, f"order {order} was cancelled for a warning")


@case("battery_low", "6.10.6", strict=True)
def battery_low(stage: Stage) -> None:
    """A vehicle with an all but empty battery is sent no pick or drop."""
    actor = stage.idle()
    actor.drain(LOW)
    stage.wait(stage.settings.reaction)
    mark = stage.mark
    stage.wait(2 * stage.settings.watch)
    for entry in stage.received(Kind.ORDER, mark, actor):
        for node in (entry.value or {}).get("nodes", ()):
            kinds = [action.get("actionType") for action in node.get("actions", ())]
            demand("pick" not in kinds, f"a pick came with {LOW:g} % of charge")
