# SPDX-License-Identifier: Apache-2.0
"""Who follows the work of the warehouse gets what has changed, once; Prometheus all figures."""

import asyncio
import json
import math
import re
from types import SimpleNamespace

import pytest
import rospy
from fake_hub import Socket
from fake_ros import FakeRos
from fastapi import FastAPI, HTTPException
from paths import ROOT
from prometheus_client.parser import text_string_to_metric_families
from sample_messages import coordinator_state, fleet
from std_msgs.msg import Header

from gazebo_msgs.msg import PerformanceMetrics
from warehouse_msgs import msg, srv
from warehouse_viewer.api import change_book, changes, description, operations_json
from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.api.metrics import Metrics
from warehouse_viewer.api.operations_json import QUANTILES
from warehouse_viewer.api.routes import forecasts
from warehouse_viewer.api.schemas.pydantic_versions import as_json
from warehouse_viewer.ros.operations_client import OperationsClient
from warehouse_viewer.ros.shift_feed import ShiftFeed
from warehouse_viewer.ros.simulation import AwayError
from warehouse_viewer.watch.station_watch import StationWatch
from warehouse_viewer.watch.troubles import of_forecast

DASHBOARD = ROOT / "doc" / "how-to" / "grafana.json"


def test_a_reader_gets_the_newest_of_each_key_once():
    book = ChangeBook()
    for key, row in ((1, "a"), (2, "b"), (1, "c")):
        book.note("orders", key, row)
    assert book.since("orders", 0) == (["b", "c"], False)
    assert book.since("orders", 2) == (["c"], False)
    assert book.since("orders", book.last) == ([], False)
    assert book.since("stock", 0) == ([], False)


def test_who_reads_too_late_is_told_so():
    book = ChangeBook(kept=2)
    for key in range(4):
        book.note("orders", key, key)
    assert book.since("orders", 0) == ([2, 3], True)
    assert book.since("orders", 2) == ([2, 3], False)
    book.miss("orders")
    assert book.since("orders", 4) == ([], True)


def test_a_long_day_of_orders_takes_no_more_memory_than_its_newest():
    book = ChangeBook()
    for number in range(3 * change_book.KEPT):
        book.note("orders", number, number)
    assert len(book._rows["orders"]) == change_book.KEPT <= 1000


class Ros(FakeRos):
    """Lasts as long as a shift is connected."""

    shifts = 1

    def Subscriber(self, topic, *args, **options):  # noqa: N802 (rospy's name)
        super().Subscriber(topic, *args, **options)
        return SimpleNamespace(get_num_connections=lambda: self.shifts)


class Shift:
    """A shift's messages, and a Work that hears them."""

    def __init__(self):
        self.ros, self.book, self.seq, self.watch = Ros(), ChangeBook(), {}, StationWatch()
        self.work = OperationsClient(self.ros, ShiftFeed(self.ros, self.book))
        self.work.call = lambda *_: srv.FindOrdersResponse(total=7)

    def tell(self, topic, kind, **fields):
        self.seq[topic] = self.seq.get(topic, 0) + 1
        header = Header(seq=self.seq[topic], stamp=rospy.Time(60))
        self.ros.callbacks[f"warehouse/{topic}"](kind(header=header, **fields))

    def orders(self, *numbers, **fields):
        rows = [msg.OrderStatus(order_id=number, **fields) for number in numbers]
        self.tell("order_changes", msg.OrderStatuses, orders=rows)

    def stations(self, *names):
        rows = [msg.StationState(name=name, kind="PICK", shelf_id=3, inbound=[4]) for name in names]
        self.tell("stations", msg.StationStates, stations=rows)

    def backend(self, **feed):
        feed = SimpleNamespace(subscribe=lambda names: None, coordinator=None, **feed)
        parts = {"operations": self.work, "changes": self.book, "feed": feed}
        return SimpleNamespace(**parts, stations=self.told_stations)

    def told_stations(self, message):
        self.watch.update(60.0, message.stations, None)
        result = operations_json.stations(message)
        return [row | self.watch.as_json(item) for row, item in zip(result, message.stations)]


def test_a_follower_gets_what_stands_first_and_then_what_changes():
    async def scenario():
        shift, socket = Shift(), Socket()
        shift.stations("pick1")
        shift.orders(1)
        reader = changes._Reader(socket, shift.backend(), ["orders", "stock", "stations"])
        for _ in range(2):
            await reader.send_news()
        assert [text["type"] for text in socket.texts] == ["shift", "stations"]
        lines = [msg.OrderLine("sku-1", 2)]
        shift.orders(1, 2, state=1, lines=lines, picked=[1])
        shift.orders(2, state=2, lines=lines, picked=[2])
        place = msg.StockPlace("item1", 3, "sku-1", 4, 1, 24)
        shift.tell("stock_changes", msg.StockPlaces, places=[place])
        await reader.send_news()
        orders, stock = socket.texts[2:]
        assert [(o["order_id"], o["state"]) for o in orders["orders"]] == [
            (1, "ASSIGNED"),
            (2, "COMPLETED"),
        ]
        assert orders["orders"][1]["lines"] == [{"sku": "sku-1", "quantity": 2, "picked": 2}]
        assert stock["stock"][0]["quantity"] == 4 and not stock["missed"]
        # What OpenAPI says of it is so.
        for kind, result in ((changes.OrdersChanged, orders), (changes.StockChanged, stock)):
            assert json.loads(as_json(kind(**result))) == result
        changes.StationsNow(**socket.texts[1])

    asyncio.run(scenario())


def test_a_follower_is_told_when_the_shift_ends_and_of_what_it_missed():
    async def scenario():
        shift, socket = Shift(), Socket()
        shift.orders(1)
        reader = changes._Reader(socket, shift.backend(), ["orders"])
        await reader.send_news()
        shift.ros.shifts = 0
        await reader.send_news()
        shift.ros.shifts, shift.seq = 1, {}  # another one counts from 1
        shift.orders(5)
        await reader.send_news()
        assert [t.get("runs") for t in socket.texts] == [True, False, True, None]
        assert socket.texts[-1]["missed"] is True

    asyncio.run(scenario())


def test_what_is_followed_is_one_of_those_that_there_are():
    assert "heat" not in changes.topics("") and "orders" in changes.topics("")
    assert changes.topics("heat,orders") == ["heat", "orders"]
    with pytest.raises(ValueError, match="no moon, sun to follow; there are orders, stock"):
        changes.topics("sun,orders,moon")


class Heard(dict):
    """Stands in for a Feed."""

    coordinator = None

    def __missing__(self, name):
        return None


def test_prometheus_gets_every_figure_that_the_dashboard_shows():
    shift = Shift()
    shift.stations("pick1", "pick2")
    shift.tell("kpis", msg.Kpis, items_picked=42, orders_late=3)
    shift.tell("forecasts", msg.ForecastResult, **forecast())
    feed = Heard(performance=PerformanceMetrics(real_time_factor=0.9), fleet=fleet(stamp=60.0))
    feed.coordinator = coordinator_state(60.0, bringing=5, plan_p99=20.0, alarms=["a", "b"])
    text, kind = Metrics(feed, shift.work, lambda: 1000).text()
    assert kind.startswith("text/plain")
    families = list(text_string_to_metric_families(text.decode()))
    samples = {(s.name, *s.labels.values()): s.value for f in families for s in f.samples}
    assert samples["warehouse_items_picked_total",] == 42
    assert samples["warehouse_recording_bytes",] == 1000
    assert samples["warehouse_orders", "open"] == 7
    assert samples["warehouse_orders_late",] == 3
    assert samples["warehouse_robots", "bringing"] == 5
    assert samples["warehouse_plan_seconds", "99"] == pytest.approx(0.02)
    assert samples["warehouse_alarms",] == 2 and samples["warehouse_real_time_factor",] == 0.9
    assert samples["warehouse_station_queue", "PICK", "pick2"] == 2
    panels = json.loads(DASHBOARD.read_text())["panels"]
    asked = {name for p in panels for t in p["targets"] for name in names_in(t["expr"])}
    assert asked == {name for name, *_ in samples}


def forecast(number=3, **fields):
    bands = {f"{name}_{q}": [1.0, 2.0] for name in ("done", "open", "late") for q in QUANTILES}
    finish = {"finish_p10": 900.0, "finish_p50": 1200.0, "finish_p90": math.nan}
    bands |= {f"pieces_per_hour_{q}": [60.0, 60.0] for q in QUANTILES}
    return {
        "forecast_id": number,
        "made_at": 600.0,
        "minutes": 20.0,
        "runs": 8,
        "time": [60.0, 120.0],
        "text": "all is well",
        **bands,
        **finish,
        **fields,
    }


def test_a_forecast_comes_to_followers_and_to_prometheus():
    async def scenario():
        shift, socket = Shift(), Socket()
        shift.stations()
        shift.tell("forecasts", msg.ForecastResult, **forecast())
        await changes._Reader(socket, shift.backend(), ["forecasts"]).send_news()
        return shift, socket.texts[-1]

    shift, news = asyncio.run(scenario())
    assert news["forecasts"]["done"] == {q: [1.0, 2.0] for q in QUANTILES}
    assert news["forecasts"]["finish"] == {"p10": 900.0, "p50": 1200.0, "p90": None}
    assert json.loads(as_json(changes.ForecastNow(**news))) == news
    text = Metrics(Heard(), shift.work).text()[0].decode()
    assert 'warehouse_forecast_done{quantile="p90"} 2.0' in text
    assert 'warehouse_forecast_finish_seconds{quantile="p50"} 1200.0' in text


def test_a_forecast_is_found_by_its_number():
    shift = Shift()
    shift.stations()
    backend, book = shift.backend(), shift.work.feed.forecasts
    with pytest.raises(HTTPException, match="there is no such forecast"):
        forecasts._shown(backend, 1)
    book.ask(2)
    book.ask(3)
    assert forecasts._shown(backend, 3) == {"forecast_id": 3, "state": "RUNNING"}
    assert forecasts._shown(backend, 2)["state"] == "REPLACED"
    shift.tell("forecasts", msg.ForecastResult, **forecast())
    assert forecasts._shown(backend, 3)["state"] == "DONE"
    book.ask(1)  # of another shift
    assert book.newest == 1 and forecasts._shown(backend, 1)["state"] == "RUNNING"


def test_what_a_change_would_do_is_no_figure_and_no_alarm():
    shift = Shift()
    shift.stations()
    feed = shift.work.feed

    def metrics():
        return Metrics(Heard(), shift.work).text()[0].decode()

    shift.tell("forecasts", msg.ForecastResult, **forecast(3, late_p50=[0.0, 4.0]))
    tried = forecast(4, done_p90=[9.0, 9.0], changes=["+0 close pick1"])
    shift.tell("forecasts", msg.ForecastResult, **tried)
    shift.tell("forecasts", msg.ForecastResult, forecast_id=5, text="no forecast: killed")
    assert (feed.forecasts.newest, feed.forecast.forecast_id) == (5, 3)
    assert 'warehouse_forecast_done{quantile="p90"} 2.0' in metrics()
    assert [trouble.kind for trouble in of_forecast(feed.forecast, 700.0)] == [
        "ORDERS_WILL_BE_LATE"
    ]


def test_a_forecast_of_another_shift_takes_the_place_of_all_before():
    shift = Shift()
    shift.stations()
    book = shift.work.feed.forecasts
    book.ask(7)
    shift.tell("forecasts", msg.ForecastResult, **forecast(7))
    shift.tell("forecasts", msg.ForecastResult, **forecast(1, changes=["+0 close pick1"]))
    assert (book.newest, book.plain, book.result(7)) == (1, None, None)


def names_in(expression):
    return re.findall(r"\bwarehouse_\w+", expression)


def test_prometheus_is_answered_where_no_shift_and_no_coordinator_run():
    shift = Shift()
    shift.tell("kpis", msg.Kpis)
    shift.ros.shifts = 0
    text, _ = Metrics(Heard(), shift.work).text()
    rows = [row for row in text.decode().splitlines() if row and not row.startswith("#")]
    assert rows == ["warehouse_shift_up 0.0", "warehouse_coordinator_up 0.0"]


def test_a_shift_that_ends_meanwhile_costs_its_own_figures_alone():
    def away(*_):
        raise AwayError("gone")

    shift = Shift()
    shift.work.call = away
    text, _ = Metrics(Heard(), shift.work).text()
    assert b"warehouse_shift_up 1.0" in text and b"warehouse_orders{" not in text


def test_the_description_has_the_web_sockets_with_their_messages():
    api = description.described(FastAPI(title="x", version="1"))
    kinds = api["components"]["schemas"]
    messages = api["x-websockets"]["/api/v1/changes"]["messages"]
    types = [kinds[m["$ref"].rsplit("/", 1)[-1]]["properties"]["type"] for m in messages]
    # pydantic 2 tells a single value as a constant.
    named = [api["const"] if "const" in api else api["enum"][0] for api in types]
    assert sorted(named) == sorted(["shift", *changes.TOPICS])
