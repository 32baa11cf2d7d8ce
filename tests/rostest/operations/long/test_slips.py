#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A slip of the hand costs nothing: rows stand still, a tap means what is shown, or is undone."""

import rospy
import rostest
from rostest_support.node_test import wait_until
from rostest_support.page_test import address, ask
from rostest_support.work_page import READY, TASK, WorkPageTest, pieces, station, submit
from selenium.webdriver.common.keys import Keys

ORDERS = 30
ROWS = """[...document.querySelectorAll('.order-rows .order')]
  .map((row) => [row.children[0].textContent, row.offsetTop])"""
MIDDLE = """(({x, y, width, height}) => [x + width / 2, y + height / 2])(
  ROW.querySelector('button:not(.order-name)').getBoundingClientRect())"""
HAND = "document.querySelector('[data-station=pick1] button:nth-of-type(2)')"
SIZES = ((1440, 900), (1024, 768), (390, 844))  # of windows [px]
PANELS = ["bar", "list-panel", "fleet-panel", "log-panel", "heat-panel", "pace"]
# Pairs of panels that cover each other, and buttons that something else covers.
COVERED = """(() => {
  const boxes = PANELS.map((id) => [id, document.getElementById(id)])
    .filter(([, box]) => box.checkVisibility())
    .map(([id, box]) => [id, box.getBoundingClientRect()]);
  const meet = (a, b) => (
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom);
  const pairs = boxes.flatMap(([id, a], i) => boxes.slice(i + 1)
    .filter(([, b]) => meet(a, b)).map(([other]) => `${id} and ${other}`));
  const hidden = [...document.querySelectorAll('#bar button')].filter((button) => {
    if (!button.checkVisibility()) return false;
    const { left, top, width, height } = button.getBoundingClientRect();
    return !button.contains(document.elementFromPoint(left + width / 2, top + height / 2));
  }).map((button) => button.id);
  return [...pairs, ...hidden];
})()""".replace("PANELS", str(PANELS))


class SlipsTest(WorkPageTest):
    """Tests that run in this order: each finds what the last one left."""

    def row(self, reference):
        return (
            "[...document.querySelectorAll('.order-rows .order')]"
            f".find((row) => row.textContent.startsWith('{reference}'))"
        )

    def test_1_rows_stand_still_and_a_cancelled_order_is_the_one_that_was_named(self):
        self.press("pick1", 1)
        self.press("pick2", 1)  # both closed: orders stay
        numbers = {f"slip-{i}": submit(f"slip-{i}", "sku-3", 1) for i in range(5)}
        self.page.until("page.orders.total > 0")
        self.page.read("document.getElementById('news').click()")
        self.page.until(f"{self.row('slip-4')} && {self.row('slip-0')}")
        before = self.page.read(ROWS)
        button = self.page.read(MIDDLE.replace("ROW", self.row("slip-2")))
        for i in range(ORDERS):
            submit(f"late-{i}", "sku-3", 1)
        self.page.until(f"document.getElementById('news').textContent === '{ORDERS} new: show'")
        self.assertEqual(self.page.read(ROWS), before)
        self.page.read("document.getElementById('orders').scrollIntoView({block: 'center'})")
        button = self.page.read(MIDDLE.replace("ROW", self.row("slip-2")))
        self.page.click_at(*button)
        self.page.until("document.getElementById('question').open")
        self.assertEqual(self.page.text("question-title"), "Cancel slip-2?")
        self.assertIn(
            f"Order {numbers['slip-2']}, picked so far: 0/1 sku-3", self.page.text("question-text")
        )
        self.page.click_on("question-no")
        self.page.until("!document.getElementById('question').open")
        self.assertEqual(ask(f"/orders/{numbers['slip-2']}")[1]["state"], "OPEN")
        self.page.click_at(*button)
        self.page.until("document.getElementById('question').open")
        self.page.click_on("question-yes")
        self.page.until("document.getElementById('answer').textContent === 'slip-2 is cancelled'")
        states = {name: ask(f"/orders/{number}")[1]["state"] for name, number in numbers.items()}
        self.assertEqual(
            [name for name, state in states.items() if state == "CANCELLED"], ["slip-2"]
        )
        # It stays where it was, as what it is now; the new ones come when they are asked for.
        self.page.until(f"{self.row('slip-2')}.textContent.includes('cancelled')")
        self.assertEqual(self.page.read(ROWS), before)
        self.page.click_on("news")
        self.page.until(
            f"{self.row(f'late-{ORDERS - 1}')} && document.getElementById('news').hidden"
        )
        # Far down in the list, too, what is seen does not move.
        self.page.read("document.getElementById('orders').scrollTo(0, 400)")
        self.page.until(f"{self.row('late-15')}")
        there = self.page.read(ROWS)
        submit("last", "sku-3", 1)
        self.page.until("document.getElementById('news').textContent === '1 new: show'")
        self.assertEqual(self.page.read(ROWS), there)
        for number in [n for name, n in numbers.items() if name != "slip-2"]:
            ask(f"/orders/{number}", method="DELETE")
        for order in ask("/orders?limit=100&state=OPEN")[1]["orders"]:
            ask(f"/orders/{order['order_id']}", method="DELETE")

    def test_2_a_double_tap_confirms_one_pick(self):
        """Nor does a tap confirm what was drawn only a moment ago."""
        self.press("pick1", 2)
        self.press("pick1", 1)  # at once: neither undoes the other
        self.page.until(f"{HAND}.ariaPressed === 'true'")
        numbers = [submit(f"tap-{i}", "sku-4", 1) for i in range(3)]
        self.page.read("(location.hash = '#pick1')")  # a link of old
        self.page.until(f"location.pathname === '/station/pick1' && {READY}")
        self.wait_for(f"{TASK} === 'Take 1 × sku-4' && page.view.isSettled")
        # And one that comes as soon as the next pick is drawn.
        tap = "document.getElementById('confirm').click()"
        self.page.read(f"[0, 1].forEach(() => {tap})")
        self.page.read(f"page.bench.task && {tap}")
        picked = lambda: sum(  # noqa: E731
            line["picked"] for n in numbers for line in ask(f"/orders/{n}")[1]["lines"]
        )
        wait_until(lambda: picked() == 1, "one of three is picked")
        self.page.until("page.view.isSettled && page.outbox.entries.length === 0")
        self.assertEqual(picked(), 1)
        self.assertIn("take tote", self.page.text("told"))

    def test_3_what_no_longer_holds_is_refused_and_said(self):
        pick = station("pick1")["picks"][0]
        body = {"order_id": pick["order_id"], "item": pick["item"], "quantity": pick["quantity"]}
        path = f"/stations/pick1/picks/{pick['sequence']}"
        self.screen("pick1")
        self.page.until(f"{TASK} && page.view.isSettled")
        # Another client confirms it, while this page gets no news of it.
        self.page.read("(page.news.handlers.take = () => {})")
        first, again = ask(path, body), ask(path, body)
        self.assertEqual(first, (200, {"message": "", "quantity": 1}))
        self.assertEqual(again, first)  # a repetition changes nothing
        self.assertEqual(ask(path, body | {"outcome": "DAMAGED"})[0], 409)
        before = station("pick1")["pieces"]
        self.tap("damaged")
        self.click("#question-yes")
        self.page.until("document.getElementById('told').textContent.includes('already')")
        self.assertIn("1 × sku-4 is not booked", self.page.text("told"))
        stale = ask(f"/stations/pick1/picks/{10**6}", body)
        self.assertEqual(stale[0], 409)
        self.assertIn("that is no longer asked for; pick1 asks for", stale[1]["detail"])
        self.assertEqual(station("pick1")["pieces"], before)

    def test_4_a_write_off_takes_two_steps_and_is_undone(self):
        self.screen("pick1")
        self.wait_for(f"{TASK}?.startsWith('Take') && page.view.isSettled")
        pick = station("pick1")["picks"][0]
        stock = pieces("sku-4")
        self.tap("short")
        self.page.until("document.getElementById('question').open")
        self.assertEqual(pieces("sku-4"), stock)
        self.click("#question-no")
        self.page.until("!document.getElementById('question').open")
        self.tap("short")
        self.click("#question-yes")
        unit = next(p["shelf_id"] for p in ask("/stock?sku=sku-4")[1]["places"])
        wait_until(lambda: pieces("sku-4") != stock, f"it is written off {pick} {unit}")
        self.click("#undo")
        self.page.until("document.getElementById('told').textContent.includes('taken back')")
        wait_until(lambda: pieces("sku-4") == stock, "it is back")

    def test_5_a_station_that_waits_for_a_person_says_so(self):
        card = "document.querySelector('[data-station=pick1]').textContent"
        self.wait_for(f"{card}.includes('has waited for a person for')")
        alarms = "document.getElementById('alarms')"
        needed = f"{alarms}.textContent.includes('is at pick1: a person has to confirm a pick')"
        self.wait_for(needed)
        self.press("pick1", 2)
        self.page.until(f"!{needed}")
        self.page.until(f"!{card}.includes('person')")

    def test_6_what_the_server_refuses_is_said(self):
        """Every button: a server that is gone, and one that answers no."""
        self.page.read("(window.fetch = () => Promise.reject(new TypeError('gone')))")
        self.press("pick2", 1)
        self.page.until(
            "document.getElementById('answer').textContent === 'the server does not answer'"
        )
        self.page.read("document.querySelector('#where button').click()")
        self.page.until(
            "document.getElementById('found').textContent === 'the server does not answer'"
        )
        broken = "new Response('oops', {status: 500, statusText: 'Internal Server Error'})"
        self.page.read(f"(window.fetch = () => Promise.resolve({broken}))")
        self.press("pick2", 2)
        self.page.until("document.getElementById('answer').textContent.includes('500')")
        self.screen("pick2")
        self.page.read(f"(window.fetch = () => Promise.resolve({broken}))")
        self.click("#by-hand")
        self.page.until("document.getElementById('told').textContent.includes('500')")

    def test_7_no_panel_of_the_floor_covers_another(self):
        page = self.page
        self.addCleanup(page.be_desktop)
        for width, height in SIZES:
            page.be_phone(width, height)
            page.open(address())
            page.until("page.fleet?.runs && page.stage.frames > 2 && page.bar.live")
            page.read("page.showPace(400)")  # as where a processor draws
            self.assertEqual(page.read(COVERED), [], (width, height))
            page.read("document.getElementById('heat').click()")
            page.until("!document.getElementById('heat-panel').hidden")
            self.assertEqual(page.read(COVERED), [], (width, height, "heat"))

    def test_8_a_search_that_is_given_up_finds_all_again(self):
        page = self.page
        page.be_desktop()
        page.open(address())
        page.until("page.list?.rows.length === 4")
        page.type("kiva2", "search")
        page.until("page.list.rows.length === 1")
        page.type(Keys.ESCAPE)
        page.until("document.getElementById('search').value === '' && page.list.rows.length === 4")
        page.open(f"{address()}operations")
        page.until("page.orders?.total > 3")
        page.type("slip-2", "search")
        page.until("page.orders.total === 1")
        page.type(Keys.ESCAPE)
        page.until("document.getElementById('search').value === '' && page.orders.total > 3")


if __name__ == "__main__":
    rospy.init_node("test_slips")
    rostest.rosrun("warehouse_tests", "slips", SlipsTest)
