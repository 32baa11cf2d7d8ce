#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The pages show a shift as it goes on, and a person works at its stations."""

import asyncio
import json
import tempfile
import time
from pathlib import Path

import rospy
import rostest
import websockets
from prometheus_client.parser import text_string_to_metric_families
from rostest_support import axe
from rostest_support.browser import CENTRE
from rostest_support.node_test import wait_until
from rostest_support.page_test import address, ask, fetch
from rostest_support.work_page import (
    CARD,
    LONG,
    PHONE,
    READY,
    TABLET,
    TASK,
    WorkPageTest,
    pieces,
    station,
    submit,
)
from sqlalchemy import insert

from warehouse_operations.store import check, schema
from warehouse_operations.store.database import open_engine

MANY = 10_000  # orders
FIRST = 10**6  # their ids
FLAKY = Path(__file__).with_name("flaky_picker.js")

ROW = """[...document.querySelectorAll('.order-rows .order')]
  .map((row) => row.textContent).find((text) => text.startsWith('{}'))"""
LIT = "document.querySelector('#front .lit')"
HAND = "document.querySelector('[data-station=pick1] button:nth-of-type(2)')"

# Buttons too small for a glove, or out of sight.
UNFIT = """[...document.querySelectorAll('button, .button')].filter((e) => e.checkVisibility())
  .filter((e) => {
    const { width, height, left, right, top, bottom } = e.getBoundingClientRect();
    return Math.min(width, height) < 64 || Math.min(left, top) < 0
      || right > innerWidth || bottom > innerHeight;
  }).map((e) => `${e.id} ${e.offsetWidth} x ${e.offsetHeight}`)"""

# Answers *Damaged* and what it asks; once more if a bundle that was under way ends in between.
LEFT_OUT = """(() => {
  const isAsked = document.getElementById('question').open;
  document.getElementById(isAsked ? 'question-yes' : 'damaged').click();
  return isAsked;
})()"""

# Whether the legend of the heat map lies between the panels at its sides.
BESIDE = """(() => {
  const [heat, left, right] = ['heat-panel', 'list-panel', 'details-panel']
    .map((id) => document.getElementById(id).getBoundingClientRect());
  return right.width > 0 && heat.left >= left.right && heat.right <= right.left;
})()"""


# Robots that wait, by two updates with the focus on the second: its name before and after, and
# whether that is the same link.
WAITS = """(() => {
  const waits = (robot) => ({ robot, since: 5 - robot, text: '' });
  const show = (...robots) => page.shares.showWaits({ time: 9, waiting: robots.map(waits) });
  show(1, 2);
  const link = document.querySelector('#waiting a[href$=kiva2]');
  link.focus();
  show(2, 3);
  return [link.textContent, document.activeElement.textContent, document.activeElement === link];
})()"""
STATE = "document.getElementById('forecast-state')"


class OperationsPage(WorkPageTest):
    """Tests that run in this order: each finds what the last one left."""

    def test_1_an_order_is_followed_to_its_end(self):
        changes = asyncio.run(self.follow("page-1"))
        self.assertEqual(changes["orders"][-1]["lines"][0]["picked"], 2)
        self.assertTrue(any(place["sku"] == "sku-3" for place in changes["stock"]))
        self.assertIn("ARRIVED", {transport["state"] for transport in changes["transports"]})
        self.assertTrue(changes["stations"])
        self.page.until(f"({ROW.format('page-1')})?.includes('done')")
        self.page.until("page.chart.plot.chart?.data.datasets[0].data.length > 0")
        self.page.until("document.querySelectorAll('.figure .value').length === 4")
        self.page.until("page.gantt.rows.length === 7 && page.gantt.frames > 0")
        self.page.until("document.getElementById('robots-legend').textContent.length > 0")

    async def follow(self, reference):
        """{kind: rows} of what changes until a new order is complete."""
        changes = {"orders": [], "stock": [], "transports": [], "stations": []}
        socket_address = address().replace("http", "ws") + f"api/v1/changes?of={','.join(changes)}"
        async with websockets.connect(socket_address) as socket:
            self.assertEqual(json.loads(await socket.recv()), {"type": "shift", "runs": True})
            number = await asyncio.to_thread(submit, reference, "sku-3", 2)
            while not any(
                (o["order_id"], o["state"]) == (number, "COMPLETED") for o in changes["orders"]
            ):
                message = json.loads(await asyncio.wait_for(socket.recv(), LONG))
                self.assertFalse(message.get("missed"), message)
                changes[message["type"]] += message[message["type"]]
        return changes

    def test_1_the_shift_is_looked_ahead_of_as_it_is_and_with_a_change(self):
        self.page.open(address() + "operations")
        submit("ahead", "sku-5", 1)
        self.look_ahead("")
        self.page.until("page.forecast.shown?.runs > 0")
        self.page.until("page.forecast.plot.chart.data.datasets[3].data.length > 10")
        self.look_ahead("+0 close pick1")
        self.page.until("page.forecast.shown.changes[0] === '+0 close pick1'")
        text = self.page.read("document.getElementById('forecast-text').textContent")
        self.assertIn("orders", text)
        self.assertIn("against as it is", text)
        self.assertTrue(self.page.read("!document.getElementById('forecast-other').hidden"))
        status, latest = ask("/forecasts/latest")
        self.assertEqual((status, latest["state"]), (200, "DONE"))
        urgent = submit("urgent", "sku-5", 1)
        first = "document.getElementById('forecast-order')"
        self.look_ahead("order", f"page.forecast.askOrder(); {first}.value = 'urgent'")
        self.page.until(f"page.forecast.id > {latest['forecast_id']}")
        self.assertIn("looks ahead", self.page.read(f"{STATE}.textContent"))
        self.page.driver.execute_script("page.forecast.offerPolicies()")
        self.look_ahead("+0 policy orders due date")
        self.page.until("page.forecast.shown.changes[0] === '+0 policy orders due date'")
        status, answer = ask("/forecasts", {"changes": ["+0 close pick99"]})
        self.assertEqual(status, 409)
        self.assertIn("pick99", answer["detail"])
        self.is_completed(urgent, "robots bring what is urgent")

    def test_1_what_if_starts_from_now(self):
        self.page.open(address() + "whatif")
        self.page.until("!document.getElementById('from-now').hidden")
        for line, columns in (("close pick1", 1), ("close pick99", 1), ("", 2)):
            script = (
                f"document.getElementById('now-changes').value = '{line}';"
                "document.getElementById('now-minutes').value = 30"
            )
            self.page.driver.execute_script(script)
            self.page.click_on("now-go")
            if "99" in line:
                self.page.until(
                    "document.getElementById('now-told').textContent.includes('pick99')"
                )
            self.page.until(f"page.fromNow.columns.length === {columns}")
        table = self.page.text("now-table")
        for text in ("close pick1; 30 min", "as it is; 30 min", "Orders done", "±"):
            self.assertIn(text, table)
        self.page.open(address() + "operations")

    def look_ahead(self, change, more=""):
        """Asks for a forecast with a change. more: what is filled in besides."""
        options = "document.getElementById('forecast-change')"
        self.page.until(f"[...{options}.options].some((o) => o.value === '{change}')")
        minutes = "document.getElementById('forecast-minutes').value = 30"
        self.page.driver.execute_script(f"{minutes}; {options}.value = '{change}'; {more}")
        self.page.driver.execute_script("document.getElementById('forecast-form').requestSubmit()")

    def test_2_a_person_picks_and_finds_too_few(self):
        self.press("pick2", 1)
        self.press("pick1", 2)
        self.page.until("document.querySelector('[data-station=pick2]').classList.contains('shut')")
        self.page.until(f"{HAND}.ariaPressed === 'true'")
        number = submit("page-2", "sku-4", 3)
        self.click(CARD.format("pick1", "a"))
        self.screen("pick1")
        self.wait_for(f"{TASK} === 'Take 3 × sku-4' && {LIT}")
        self.is_for_gloves()
        unit = ask("/stations")[1]["stations"][0]["shelf_id"]
        self.tap("fewer")
        self.tap("confirm")
        self.page.until(f"{TASK} === 'Take 1 × sku-4'")
        self.tap("short")
        self.tap("question-yes")
        self.page.until(f"page.bench.state.shelf_id !== {unit}")  # it has no more
        self.overview()
        self.press("pick1", 2)
        self.press("pick2", 1)
        self.assertEqual(pieces("sku-4").get(unit, 0), 0)
        self.is_completed(number, "what was missing is brought from elsewhere")

    def is_completed(self, number, what):
        """Waits until an order is complete."""
        done = lambda: ask(f"/orders/{number}")[1]["state"] == "COMPLETED"  # noqa: E731
        wait_until(done, what, LONG)

    def is_for_gloves(self):
        """A screen with work has large buttons, all in sight, and nothing for axe to say."""
        for size in (PHONE, TABLET):
            self.page.be_phone(*size)
            self.assertEqual(self.page.read(UNFIT), [], size)
        if axe.is_there():
            self.assertEqual(axe.findings(self.page), [])

    def test_3_a_person_puts_new_stock_in(self):
        self.press("replenish1", 2)
        self.click(CARD.format("replenish1", "a"))
        self.page.until(READY)
        self.wait_for(f"{TASK}?.startsWith('Put in') && {LIT}")
        before = self.replenishing()
        pick = before[1][0]
        self.assertEqual(self.page.read(TASK), f"Put in {pick['quantity']} × {pick['sku']}")
        self.wait_for(LEFT_OUT)
        wait_until(lambda: self.replenishing() != before, "nothing is to be put in of it")
        after = self.replenishing()
        self.assertTrue(after[0] != before[0] or after[1] == before[1][1:], (before, after))
        self.overview()
        self.press("replenish1", 2)

    def replenishing(self):
        """The unit that is there, and what is to be put into it."""
        station_row = station("replenish1")
        return station_row["shelf_id"], station_row["picks"]

    def test_4_ten_thousand_orders_are_no_burden(self):
        engine = open_engine(rospy.get_param("~database"))
        with engine.begin() as connection:
            rows = [
                {
                    "id": FIRST + i,
                    "run": 1,
                    "reference": f"many-{i}",
                    "created": 0.0,
                    "due": 1.0,
                    "priority": 0,
                    "state": 2,
                    "station": "pick1",
                    "completed": 2.0,
                }
                for i in range(MANY)
            ]
            connection.execute(insert(schema.orders), rows)
            lines = [
                {"order_id": row["id"], "number": 0, "sku": "sku-1", "quantity": 1, "picked": 1}
                for row in rows
            ]
            connection.execute(insert(schema.order_line), lines)
        engine.dispose()
        self.click("[data-filter='late=true']")
        self.page.until(f"page.orders.total === {MANY}")
        self.page.until(ROW.format(f"many-{MANY - 1}"))
        self.page.read("document.getElementById('orders').scrollTo(0, 1e9)")
        self.page.until(ROW.format("many-0"))
        self.assertLess(self.page.read("document.querySelectorAll('.order').length"), 50)
        self.page.type("many-777", "search")
        self.page.until("page.orders.total === 11")  # many-777 and many-7770 to 7779
        self.page.until("page.orders.rows[0].reference === 'many-777'")
        self.click("[data-filter='']")
        self.page.read("document.getElementById('search').value = 'sku-4'")
        self.page.type(" ", "search")
        self.page.until(f"page.orders.total === 1 && {ROW.format('page-2')}")

    def test_5_the_floor_shows_where_pieces_are_and_where_robots_drive(self):
        self.page.open(f"{address()}#sku-5")
        self.page.until("page.where?.units.size > 0 && page.stage.frames > 2")
        self.page.until("document.querySelectorAll('.labels .pieces:not([hidden])').length > 0")
        number = submit("page-5", "sku-5", 1)
        self.is_completed(number, "a piece is picked")
        # New stock may come meanwhile.
        shown = lambda: dict(self.page.read("[...page.where.units]"))  # noqa: E731
        wait_until(lambda: shown() == pieces("sku-5"), "the page shows where pieces are")
        self.page.click_on("heat")
        self.page.until("Boolean(page.heat?.object)")
        self.click("[data-heat=waiting]")
        self.page.until("document.getElementById('heat-text').textContent.includes('waited')")
        self.page.read("page.select('kiva1')")
        self.page.until(BESIDE)  # the legend lies on no panel
        self.page.read("page.select('pick1')")
        mode = "document.querySelector('[data-station-mode=AUTOMATIC]')"
        self.page.until(f"{mode}?.checkVisibility() && {mode}.ariaPressed === 'true'")
        self.assertIn("/station/pick1", self.page.read("document.querySelector('#care a').href"))
        self.page.read("page.select(null)")
        self.page.click_on("heat")
        self.page.until("!page.heat.object && document.getElementById('heat-panel').hidden")

    def test_6_orders_are_typed_in_and_uploaded_and_alarms_are_seen(self):
        self.page.open(f"{address()}operations")
        self.page.until("page.orders.total > 0 && page.kpis")
        self.page.click_on("new-order")
        self.page.type("typed-1", "entry-reference")
        self.page.read("document.querySelector('#entry-lines input').focus()")
        self.page.type("no-such-sku\n")
        self.page.until(
            "document.querySelector('.entry-lines .fault')?.textContent.includes('no-such-sku')"
        )
        fault = "document.querySelector('.entry-lines .fault:not([hidden])')"
        self.page.type("x")  # a fault goes with the text that had it
        self.page.until(f"!{fault}")
        self.page.read("(document.querySelector('#entry-lines input').value = 'sku-2')")
        self.page.read("document.getElementById('entry-form').requestSubmit()")
        self.page.until("!document.getElementById('entry').open")
        self.page.type("typed-1", "search")
        self.page.until(ROW.format("typed-1"))
        wrong = "reference,sku,quantity\nup-1,sku-1,1\nup-2,sku-1,none\n"
        self.let_fall(wrong.replace("sku-1,none", "sku-no,none"))
        table = "document.querySelector('#sheet-faults tbody').textContent"
        self.page.until(f"{table}.startsWith('3sku')")
        self.assertIn(
            "3quantityquantity is 'none'; a whole number from 1 on", self.page.read(table)
        )
        self.page.read("document.getElementById('sheet').close()")
        self.let_fall(wrong)
        self.page.until(f"{table}.startsWith('3quantity')")
        self.assertEqual(ask("/orders?search=up-1")[1]["total"], 0)
        self.page.read("document.getElementById('sheet').close()")
        self.let_fall(wrong.replace("none", "2"))
        self.click("#sheet-yes:not([hidden])")
        self.page.until("!document.getElementById('sheet').open")
        self.assertEqual(ask("/orders?search=up-")[1]["total"], 2)
        status, sheet = fetch("api/v1/orders.csv?search=up-2")
        self.assertEqual((status, sheet.decode("utf-8-sig").count("up-2")), (200, 1))
        self.assertEqual(fetch("api/v1/orders.xlsx?search=up-2")[1][:2], b"PK")

    def let_fall(self, text):
        """Drops a file with orders on the list."""
        self.page.read("document.getElementById('orders').scrollIntoView({block: 'center'})")
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write(text)
            file.flush()
            self.page.drop(file.name, *self.page.read(CENTRE.format("orders")))
            self.page.until("document.getElementById('sheet').open")

    def test_7_what_is_put_in_leaves_what_is_picked_its_height(self):
        chart = "page.chart.plot.chart"
        self.page.until(f"{chart} && {chart}.data.datasets[0].data.length > 0")
        tallest = (
            f"Math.max(10, ...[0, 2].flatMap((i) => {chart}.data.datasets[i].data.map((p) => p.y)))"
        )
        self.page.until(f"{chart}.scales.y.max <= 1.5 * {tallest}")
        put_in = f"Math.max(...{chart}.data.datasets[1].data.map((p) => p.y))"
        self.page.until(f"{chart}.scales.stored.max >= {put_in}")

    def test_7_the_last_hour_says_what_of_it_is_known(self):
        watched = """(Object.assign(page.gantt.spans, {begin: 420, now: 840, take() {}}),
            page.gantt.take(null), document.getElementById('gantt-known').textContent)"""
        self.assertEqual(self.page.read(watched), "its last 7 min: watched since 0:07:00")
        self.overview()

    def test_7_all_can_use_it(self):
        self.assertEqual(axe.findings(self.page), [])

    def test_7_fingers_spread_the_last_hour(self):
        self.addCleanup(self.overview)
        self.page.be_phone(*PHONE)
        self.show()
        self.page.until("page.gantt.rows.length === 7")
        x, y = self.page.bring("gantt")
        left, right = [(x - i, y) for i in (20, 60, 100)], [(x + i, y) for i in (20, 60, 100)]
        self.page.swipe(left, right)
        self.page.until("!page.gantt.view.isWhole")
        self.page.tap_until("gantt-all", "page.gantt.view.isWhole")

    def test_7_the_last_hour_is_read_by_keys_and_alarms_are_told(self):
        self.page.until("page.gantt.rows.length === 7")
        self.page.read("page.gantt.box.focus()")
        text = "document.getElementById('gantt-told').textContent"
        self.page.until(f"{text}.startsWith('pick1: ')")
        self.page.type("\ue015")  # arrow down
        self.page.until(f"{text}.startsWith('pick2: ')")
        self.page.type("+")
        self.page.until("!page.gantt.view.isWhole")
        self.page.type("0")
        self.page.until("page.gantt.view.isWhole")
        self.assertIn("ROBOT_BROKEN", ask("/alarms")[1]["kinds"])
        self.assertEqual(ask("/alarms/999999/seen", {"by": "Anna"})[0], 404)
        self.assertEqual(ask("/alarms/1/seen", {"by": "x" * 61})[0], 422)

    def test_7_the_focus_stays_where_the_keyboard_put_it(self):
        """Presses a button that is disabled while its work is done; then a list changes."""
        page = self.page
        page.open(address() + "operations")
        page.until(f"{HAND} && !{HAND}.disabled")
        for _ in range(2):  # as it was, in the end
            was = page.read(f"{HAND}.ariaPressed")
            page.read(f"{HAND}.focus()")
            page.type("\ue007")  # enter
            page.until(f"{HAND}.ariaPressed !== {was!r} && !{HAND}.disabled")
            page.until(f"document.activeElement === {HAND}")
        self.assertEqual(page.read(WAITS), ["kiva2", "kiva2", True])

    def test_8_prometheus_gets_the_same_figures(self):
        status, text = fetch("metrics")
        families = text_string_to_metric_families(text.decode())
        samples = {(s.name, *s.labels.values()): s.value for f in families for s in f.samples}
        self.assertEqual((status, samples["warehouse_shift_up",]), (200, 1))
        kpis = ask("/kpis")[1]
        self.assertGreater(samples["warehouse_items_picked_total",], 0)
        self.assertLessEqual(samples["warehouse_items_picked_total",], kpis["items_picked"])
        self.assertGreaterEqual(samples["warehouse_orders", "completed"], MANY)
        self.assertEqual(samples["warehouse_station_open", "PICK", "pick2"], 1)
        robots = [value for (name, *_), value in samples.items() if name == "warehouse_robots"]
        self.assertEqual(sum(robots), 4)

    def test_9_over_a_flaky_network_each_pick_is_confirmed_once(self):
        picks, sku = rospy.get_param("~picks"), "sku-6"
        self.let_finish("typed-1", "up-1", "up-2")
        for name, is_open, mode in (("pick1", True, "MANUAL"), ("pick2", False, "AUTOMATIC")):
            ask(f"/stations/{name}", {"open": is_open, "mode": mode}, method="PUT")
        before = picked(rospy.get_param("~database"))
        self.screen("pick1")
        self.pick_flakily()
        began = time.monotonic()
        numbers = [submit(f"flaky-{i}", sku, 1) for i in range(picks)]
        self.wait_for(f"picker.done >= {picks // 2}")
        done = self.reload_offline()
        self.wait_for(f"picker.done >= {picks - done} && page.outbox.entries.length === 0")
        wall = time.monotonic() - began
        states = lambda: {ask(f"/orders/{n}")[1]["state"] for n in numbers}  # noqa: E731
        wait_until(lambda: states() == {"COMPLETED"}, "all orders are complete")
        reading = self.page.read("picker")
        self.assertEqual((done + reading["done"], reading["refused"]), (picks, []))
        self.assertGreater(min(reading["lostRequests"], reading["lostAnswers"]), 0)
        engine = open_engine(rospy.get_param("~database"))
        made_up = f"order_id >= {FIRST}"  # those of test 4, which were never picked
        with engine.begin() as connection:
            connection.exec_driver_sql(f"DELETE FROM order_line WHERE {made_up}")
            connection.exec_driver_sql(f"DELETE FROM orders WHERE id >= {FIRST}")
        self.assertEqual(check.faults(engine), [])
        engine.dispose()
        self.assertEqual(picked(rospy.get_param("~database")) - before, picks)
        print(f"{picks} picks in {wall:.1f} s, {reading}")

    def let_finish(self, *references):
        """Has the stations complete the orders of earlier tests by themselves."""
        for name in ("pick1", "pick2"):
            ask(f"/stations/{name}", {"open": True, "mode": "AUTOMATIC"}, method="PUT")

        def states():
            answers = [ask(f"/orders?search={reference}")[1]["orders"] for reference in references]
            return {order["state"] for orders in answers for order in orders}

        wait_until(lambda: states() == {"COMPLETED"}, "the orders of earlier tests are complete")

    def pick_flakily(self):
        self.page.read(f"(eval({json.dumps(FLAKY.read_text())}), 0)")

    def reload_offline(self):
        """The network goes; what is kept here outlasts a reload. Returns what was picked so far."""
        self.page.read("(picker.isOffline = true)")
        self.wait_for("page.outbox.entries.length > 0 && page.outbox.isStuck")
        self.page.until("document.getElementById('link').textContent.includes('nothing is lost')")
        kept = self.page.read("page.outbox.entries.map(({ body }) => body.id)")
        self.assertEqual(len(kept), len(set(kept)))
        done = self.page.read("(clearInterval(picker.timer), picker.done)")
        self.screen("pick1")
        self.pick_flakily()
        return done


def picked(database):
    """Pieces that were picked and not taken back, by the moves of stock."""
    engine = open_engine(database)
    with engine.connect() as connection:
        sums = "SELECT COALESCE(-SUM(quantity), 0) FROM move WHERE reason = 'pick'"
        total = connection.exec_driver_sql(sums).scalar()
    engine.dispose()
    return total


if __name__ == "__main__":
    rospy.init_node("test_operations_page")
    rostest.rosrun("warehouse_tests", "operations_page", OperationsPage)
