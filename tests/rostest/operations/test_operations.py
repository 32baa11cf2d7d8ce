#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Orders over ROS: submitted, picked, told, confirmed by hand, and kept when the node dies."""

import unittest

import rospy
import rostest
from rostest_support.node_test import Listener, call, kill, latched, pid, sends, wait_until
from rostest_support.page_test import ask
from sqlalchemy import func, select, update
from std_srvs.srv import Empty

from gazebo_msgs.srv import DeleteModel
from warehouse_msgs.msg import (
    Kpis,
    OrderEvent,
    OrderLine,
    StationStates,
    Throughput,
    TransportEvent,
)
from warehouse_msgs.srv import (
    CancelOrder,
    ConfirmPick,
    FindOrders,
    ReportShort,
    SetStation,
    SetStationRequest,
    SubmitOrder,
    Transport,
)
from warehouse_operations.stock.orders import OrderState
from warehouse_operations.store import check, schema
from warehouse_operations.store.database import open_engine

AUTOMATIC, MANUAL = SetStationRequest.AUTOMATIC, SetStationRequest.MANUAL
LONG = 120.0  # [s, wall]
EVENTS = "/warehouse/order_events"


def submit(*lines, reference=""):
    lines_of_order = [OrderLine(sku, quantity) for sku, quantity in lines]
    return call("/warehouse/submit_order", SubmitOrder, reference=reference, lines=lines_of_order)


def station(name, condition=lambda station: True):
    def holds(message):
        return condition({station.name: station for station in message.stations}[name])

    states = latched("/warehouse/stations", StationStates, holds)
    return {station.name: station for station in states.stations}[name]


def bring_a_unit(station):
    """The transport of a unit that no client has asked for yet."""
    for unit in range(1, 25):
        answer = call("/warehouse/transport", Transport, shelf_id=unit, station=station)
        if answer.accepted:
            return answer.transport_id
    raise AssertionError("all units are under way")


def picked(engine):
    """Pieces, by what the database has."""
    move = schema.move.c
    with engine.connect() as connection:
        return -connection.execute(
            select(func.sum(move.quantity)).where(move.reason == "pick")
        ).scalar()


def completed(engine, orders):
    """How many of the orders are complete, by what the database has."""
    row = schema.orders.c
    is_complete = row.id.in_(orders) & (row.state == OrderState.COMPLETED)
    with engine.connect() as connection:
        return connection.execute(select(func.count()).where(is_complete)).scalar()


def notices():
    return " | ".join(ask("/notices")[1].get("notices", ()))


def set_station(name, is_open, mode):
    return call("/warehouse/set_station", SetStation, name, is_open, mode)


class Operations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.events = Listener(EVENTS, OrderEvent)

    def setUp(self):
        rospy.wait_for_service("/warehouse/submit_order", LONG)
        self.until_it_tells()

    def until_it_tells(self):
        """Until events of orders go to this test: its subscriber counts a publisher before that one
        knows of it."""
        me = rospy.get_name()
        wait_until(lambda: sends("/operations", me, EVENTS), "the publisher of orders", LONG)

    def events_of(self, order_id, kind):
        return [e for e in self.events.messages if (e.order_id, e.kind) == (order_id, kind)]

    def wait_for(self, order_id, kind):
        wait_until(lambda: self.events_of(order_id, kind), f"order {order_id}: {kind}", LONG)
        return self.events_of(order_id, kind)[0]

    def test_1_an_order_is_picked_and_told(self):
        answer = submit(("sku-1", 1), ("sku-2", 2), reference="A-1")
        self.assertTrue(answer.accepted, answer.message)
        completed = self.wait_for(answer.order_id, OrderEvent.COMPLETED)
        self.assertTrue(completed.station.startswith("pick"), completed)
        picked = self.events_of(answer.order_id, OrderEvent.PICKED)
        self.assertEqual(sorted(event.sku for event in picked), ["sku-1", "sku-2", "sku-2"])
        self.assertTrue(all(event.shelf_id > 0 for event in picked))
        kpis = latched("/warehouse/kpis", Kpis, lambda kpis: kpis.orders_completed)
        self.assertEqual((kpis.items_picked, kpis.collisions), (3, 0))

    def test_2_what_can_not_be_is_refused(self):
        answer = submit(("sku-none", 1))
        self.assertEqual((answer.order_id, answer.accepted), (0, False))
        self.assertIn("there is no SKU 'sku-none'", answer.message)
        self.assertFalse(call("/warehouse/cancel_order", CancelOrder, 10**6).success)
        self.assertFalse(set_station("nowhere", True, AUTOMATIC).success)
        self.assertFalse(set_station("pick1", True, 7).success)

    def test_3_a_person_confirms_and_finds_too_few(self):
        self.assertTrue(set_station("pick1", True, MANUAL).success)
        self.assertTrue(set_station("pick2", False, AUTOMATIC).success)
        order = submit(("sku-3", 2))
        there = station("pick1", lambda state: state.picks)
        pick = there.picks[0]
        self.assertEqual((pick.sku, pick.quantity, pick.order_id), ("sku-3", 2, order.order_id))
        self.assertIn(order.order_id, there.orders)
        self.assertFalse(call("/warehouse/confirm_pick", ConfirmPick, "pick1", "sku-3", 9).success)
        self.assertTrue(call("/warehouse/confirm_pick", ConfirmPick, "pick1", "sku-3", 1).success)
        short = call("/warehouse/report_short", ReportShort, "pick1", "sku-3", 1, False)
        self.assertTrue(short.success, short.message)
        self.wait_for(order.order_id, OrderEvent.SHORT)
        self.assertTrue(set_station("pick1", True, AUTOMATIC).success)
        self.assertTrue(set_station("pick2", True, AUTOMATIC).success)
        self.wait_for(order.order_id, OrderEvent.COMPLETED)

    def test_4_over_http(self):
        order = {"reference": "web-1", "lines": [{"sku": "sku-5", "quantity": 2}]}
        status, answer = ask("/orders", order)
        self.assertEqual(status, 201, answer)
        number = answer["order_id"]
        self.wait_for(number, OrderEvent.COMPLETED)
        wait_until(lambda: ask(f"/orders/{number}")[1]["state"] == "COMPLETED", "it is kept")
        orders = ask("/orders?search=web-1&state=COMPLETED")[1]
        self.assertEqual((orders["total"], orders["orders"][0]["order_id"]), (1, number))
        self.assertEqual(
            orders["orders"][0]["lines"], [{"sku": "sku-5", "quantity": 2, "picked": 2}]
        )
        self.assertEqual(ask("/orders?search=sku-5")[1]["total"], 1)
        stock = ask("/stock?sku=sku-5")[1]
        self.assertEqual(sum(place["quantity"] for place in stock["places"]), stock["pieces"])
        stations = {station["name"]: station for station in ask("/stations")[1]["stations"]}
        self.assertEqual(stations["pick1"]["mode"], "AUTOMATIC")
        self.assertGreaterEqual(ask("/kpis")[1]["orders_completed"], 1)
        for path, body, expected in (
            ("/orders", {"lines": [{"sku": "sku-none", "quantity": 1}]}, 409),
            ("/orders", {"lines": []}, 422),
            ("/orders", {"lines": [{"sku": "sku-5", "quantity": 0}]}, 422),
            ("/stations/pick1/confirm", {"sku": "sku-5", "quantity": 1}, 409),
            ("/stations/nowhere/short", {"sku": "sku-5", "quantity": 1}, 409),
        ):
            self.assertEqual(ask(path, body)[0], expected, path)
        self.assertEqual(ask("/orders/999999")[0], 404)
        self.assertEqual(ask(f"/orders/{number}", method="DELETE")[0], 409)

    def test_5_killed_it_comes_back_and_goes_on(self):
        orders = [submit((f"sku-{i}", 1)).order_id for i in range(1, 9)]
        self.wait_for(orders[0], OrderEvent.ASSIGNED)
        transports = Listener("/warehouse/transports", TransportEvent)
        self.addCleanup(transports.close)
        asked = []
        # It can't have kept all that it had asked for.
        kill("/operations", lambda: asked.append(bring_a_unit("pick1")))
        engine = open_engine(rospy.get_param("~database"))
        self.until_all_are_complete(engine, orders)
        self.assertEqual(check.faults(engine), [])
        wait_until(
            lambda: any(
                (event.transport_id, event.kind) == (asked[0], TransportEvent.STORED)
                for event in transports.messages
            ),
            "the station lets the unit go",
            LONG,
        )
        # What was picked before is not forgotten.
        latched(
            "/warehouse/throughput",
            Throughput,
            lambda throughput: sum(throughput.items_picked) == picked(engine),
        )

    def test_6_time_goes_back_and_it_goes_on(self):
        orders = [submit((f"sku-{i}", 1)).order_id for i in range(1, 5)]
        self.wait_for(orders[0], OrderEvent.ASSIGNED)
        before, node = rospy.get_time(), pid("/operations")
        call("/gazebo/reset_simulation", Empty)
        wait_until(lambda: rospy.get_time() < before, "time goes back")
        engine = open_engine(rospy.get_param("~database"))
        self.until_all_are_complete(engine, orders)
        self.assertEqual(pid("/operations"), node)
        throughput = latched("/warehouse/throughput", Throughput)
        self.assertLessEqual(throughput.end, rospy.get_time())
        self.assertEqual(check.faults(engine), [])

    def test_7_what_it_can_not_take_is_refused_or_told_and_it_goes_on(self):
        order = {"reference": "evil", "lines": [{"sku": "sku-1", "quantity": 2**31 - 1}]}
        status, answer = ask("/orders", order)
        self.assertEqual(status, 409, answer)
        self.assertIn("pieces; all bins of the warehouse together hold", str(answer))
        answer = call("/warehouse/find_orders", FindOrders, 2**64 - 1, "", -1, False, 1, 0)
        self.assertEqual(answer.total, 0)
        (notice,) = ask("/notices")[1]["notices"]
        self.assertIn("the coordinator decides robots by itself", notice)
        good = submit(*((f"sku-{i}", 1) for i in range(1, 20)))
        engine = open_engine(rospy.get_param("~database"))
        with engine.begin() as connection:
            poisoned = schema.order_line.c.order_id == good.order_id
            connection.execute(update(schema.order_line).where(poisoned).values(quantity=2**31 - 1))
        self.assertTrue(call("/gazebo/delete_model", DeleteModel, "storage_unit7").success)
        wait_until(lambda: "storage unit 7 is gone" in notices(), "it sees that a unit is gone")
        kill("/operations")
        wait_until(lambda: "storage unit 7 are gone:" in notices(), "it comes back", LONG)
        self.assertIn(f"order {good.order_id} (order-{good.order_id}) is cancelled:", notices())
        order = submit(("sku-2", 1))
        self.wait_for(order.order_id, OrderEvent.COMPLETED)
        self.assertEqual(check.faults(engine), [])

    def until_all_are_complete(self, engine, orders):
        """Asks the database: what a node publishes before it knows a subscriber is not heard. What
        is heard comes once."""
        wait_until(lambda: completed(engine, orders) == len(orders), "all orders complete", LONG)
        for order in orders:
            self.assertLessEqual(len(self.events_of(order, OrderEvent.COMPLETED)), 1)


if __name__ == "__main__":
    rospy.init_node("test_operations")
    rostest.rosrun("warehouse_tests", "work_at_orders", Operations)
