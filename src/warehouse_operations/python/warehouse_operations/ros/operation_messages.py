# SPDX-License-Identifier: Apache-2.0
"""Converts orders, stock, stations and figures of a shift to messages."""

from collections.abc import Iterable, Sequence
from types import SimpleNamespace
from typing import Any

import rospy
from std_msgs.msg import Header

from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.message_enums import OrderEventKind, StationMode
from warehouse_msgs import msg
from warehouse_operations.fleets.floor_heat import FloorHeat
from warehouse_operations.ros.fleet_log import FleetLog
from warehouse_operations.shift.order_book import OrderBook
from warehouse_operations.shift.tally import INTERVAL, Tally
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.stations import Visit, WorkStation

SHOWN = 60  # intervals of the throughput: an hour


def header(now: float) -> Header:
    """Returns a Header of a simulated time [s]."""
    return Header(stamp=rospy.Time.from_sec(now))


def order_event(
    now: float,
    order: Order,
    kind: OrderEventKind,
    sku: str,
    quantity: int,
    station: str,
    unit: int,
    text: str,
) -> msg.OrderEvent:
    """Returns an OrderEvent; now [s]."""
    return msg.OrderEvent(
        header=header(now),
        order_id=order.order_id,
        kind=kind,
        sku=sku,
        quantity=quantity,
        station=station,
        shelf_id=unit,
        text=text,
    )


def stored_order_event(row: Any) -> msg.OrderEvent:
    """Returns the OrderEvent of a row of the table event."""
    about = row.order_id, row.kind, row.sku, row.quantity, row.station, row.shelf_id, row.text
    return msg.OrderEvent(header(row.stamp), *about)


def order_status(order: Order) -> msg.OrderStatus:
    """Returns the OrderStatus of an Order."""
    return _order_status(order, order.order_id, order.lines)


def stored_order_status(row: Any, lines: Sequence[Any]) -> msg.OrderStatus:
    """Returns the OrderStatus of rows of the tables orders and order_line."""
    return _order_status(row, row.id, lines)


def _order_status(order: Any, order_id: int, lines: Sequence[Any]) -> msg.OrderStatus:
    return msg.OrderStatus(
        order_id=order_id,
        reference=order.reference,
        state=order.state,
        station=order.station,
        priority=order.priority,
        created=order.created,
        due=order.due,
        completed=order.completed or 0.0,
        lines=[msg.OrderLine(line.sku, line.quantity) for line in lines],
        picked=[line.picked for line in lines],
    )


def stock_place(bin_: Bin) -> msg.StockPlace:
    """Returns the StockPlace of a Bin, or of its row in the database."""
    return msg.StockPlace(
        bin_.item, bin_.unit, bin_.sku, bin_.quantity, bin_.reserved, bin_.capacity
    )


def station_states(stations: Iterable[WorkStation], now: float) -> msg.StationStates:
    """Returns the StationStates at `now` [s]."""
    states = [_station_state(station, now) for station in stations]
    return msg.StationStates(header=header(now), stations=states)


def _station_state(station: WorkStation, now: float) -> msg.StationState:
    here = station.here
    inbound = [visit for visit in station.coming if visit is not here]
    return msg.StationState(
        name=station.name,
        kind=station.kind,
        open=station.is_open,
        mode=station.mode,
        shelf_id=here.unit if here else 0,
        inbound=[visit.unit for visit in inbound],
        orders=list(station.orders),
        slots=station.capacity,
        picks=_tasks(here) if here else [],
        pieces=station.pieces,
        busy_fraction=station.busy_fraction(now),
        waiting=station.waiting(now),
        totes=_totes(station),
        inbound_orders=[
            visit.picks[0].line.order.order_id if visit.picks else 0 for visit in inbound
        ],
    )


def _totes(station: WorkStation) -> list[msg.Tote]:
    """Returns the totes that a person sees; [] at a station that works by itself."""
    if station.mode != StationMode.MANUAL:
        return []
    return [_tote(order) for order in station.totes]


def _tote(order: Order) -> msg.Tote:
    return msg.Tote(
        position=order.tote,
        order_id=order.order_id,
        reference=order.reference,
        lines_left=sum(line.open > 0 for line in order.lines),
        pieces_left=order.pieces,
        pieces=sum(line.quantity for line in order.lines),
    )


def _tasks(visit: Visit) -> list[msg.StationPick]:
    return [
        msg.StationPick(
            pick.line.sku,
            pick.quantity,
            pick.bin.item,
            pick.line.order.order_id,
            pick.line.order.reference,
            pick.sequence,
            pick.line.order.tote,
        )
        for pick in visit.picks
    ] + [
        msg.StationPick(bundle.sku, bundle.quantity, bundle.bin.item, 0, "", bundle.sequence, 0)
        for bundle in visit.puts
    ]


def throughput(tally: Tally, before: tuple[Any, ...], now: float) -> msg.Throughput:
    """Returns the Throughput up to `now` [s]; before: stored.throughput of the earlier runs."""
    last = int(now // INTERVAL)
    began, *counts_before = before
    first = max(int(began // INTERVAL), last + 1 - SHOWN)
    counts = zip(counts_before, (tally.picked_in, tally.stored_in, tally.completed_in))
    series = (
        [max(0, earlier.get(i, 0) + count.get(i, 0)) for i in range(first, last + 1)]
        for earlier, count in counts
    )
    begin = max(first * INTERVAL, began)
    return msg.Throughput(header(now), INTERVAL, begin, now, *series)


def heat_map(heat: FloorHeat, plan: FloorPlan, now: float) -> msg.HeatMap:
    """Returns the HeatMap at `now` [s]."""
    x, y = plan.point_of(0)
    size = plan.spacing, plan.passable.shape[1]
    return msg.HeatMap(header(now), heat.seconds(now), x, y, *size, *heat.maps())


def fleet_figures(robot_count: int, state: msg.CoordinatorState, log: FleetLog) -> Any:
    """Returns the fleet's figures for kpis.of_shift; state: the coordinator's."""
    return SimpleNamespace(
        robot_count=robot_count,
        distance_m=log.distance_m,
        collisions=state.collisions,
        blocked=state.blocked,
        watchdog=state.watchdog,
        plan_ms=[],
        executed_over_planned=state.executed_over_planned,
        failures=log.failures,
        people=log.people,
    )


def planning(state: msg.CoordinatorState) -> dict[str, float]:
    """Returns the plan_ms of kpis.json; state: the coordinator's."""
    return {"p50": state.plan_p50, "p99": state.plan_p99, "max": state.plan_p99}


def kpis_message(
    values: dict[str, Any], book: OrderBook, stock_level: float, now: float
) -> msg.Kpis:
    """Returns the Kpis at `now` [s]; values: the content of kpis.json."""
    values = dict(values)
    plan_ms = values.pop("plan_ms")
    for name in ("order_turnover_s", "order_throughput_s"):
        values[name] = msg.Quantiles(**values[name])
    return msg.Kpis(
        header=header(now),
        **{"availability": 1.0} | values,
        **{f"plan_{name}": value for name, value in plan_ms.items()},
        orders_waiting=len(book.backlog),
        orders_at_stations=len(book.orders) - len(book.backlog),
        orders_late=sum(0 < order.due < now for order in book.orders.values()),
        stock_level=stock_level,
    )
