# SPDX-License-Identifier: Apache-2.0
"""What tests of the page /operations and of the stations' screens share."""

import json

from rostest_support.node_test import wait_until
from rostest_support.page_test import PageTest, address, ask

LONG = 120.0  # for what robots do [s, wall]
TASK = "document.querySelector('#take:not([hidden]) #task')?.textContent"
READY = "page.bench && page.news.state === 'live'"  # of a station's screen
TABLET, PHONE = (1024, 768), (390, 844)  # [px]
CARD = "[data-station={}] {}"


def submit(reference, sku, quantity):
    order = {"reference": reference, "lines": [{"sku": sku, "quantity": quantity}]}
    status, answer = ask("/orders", order)
    assert status == 201, answer
    return answer["order_id"]


def pieces(sku):
    """Returns the pieces on each storage unit that holds some, by its number."""
    out = {}
    for place in ask(f"/stock?sku={sku}")[1]["places"]:
        out[place["shelf_id"]] = out.get(place["shelf_id"], 0) + place["quantity"]
    return out


def station(name):
    return {station_row["name"]: station_row for station_row in ask("/stations")[1]["stations"]}[
        name
    ]


class WorkPageTest(PageTest):
    path, ready = "operations", "page.kpis && document.querySelectorAll('.station').length === 3"

    def setUp(self):
        if self.page.read("location.pathname") != f"/{self.path}":
            self.overview()

    def overview(self):
        """Shows the page /operations."""
        self.page.be_desktop()
        self.show()

    def show(self):
        """Opens the page in a window as it is."""
        self.page.open(address() + self.path)
        self.page.until(self.ready)

    def screen(self, name):
        """Shows a station's screen, on a tablet."""
        self.page.be_phone(*TABLET)
        self.page.open(f"{address()}station/{name}")
        self.page.until(READY)

    def tap(self, button):
        """Touches a button of a screen once it may be meant: it has been there for a moment."""
        element = f"document.getElementById('{button}')"
        self.page.until(
            f"page.view.isSettled && {element}.checkVisibility() && !{element}.disabled"
        )
        self.page.tap_on(button)

    def click(self, selector):
        """Searches and clicks in one call: an element may be drawn again in between."""
        element = f"document.querySelector({json.dumps(selector)})"
        self.page.until(f"{element}?.checkVisibility() && !{element}.disabled")
        self.page.read(f"{element}.click()")

    def press(self, name, button):
        """A button of a station's card: 1 opens or closes it, 2 is for by hand or by itself."""
        self.click(CARD.format(name, f"button:nth-of-type({button})"))

    def wait_for(self, expression):
        """Until something comes true that robots do."""
        wait_until(lambda: self.page.read(f"page && ({expression})"), expression, LONG)
