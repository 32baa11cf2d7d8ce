# SPDX-License-Identifier: Apache-2.0
"""The warehouse in figures for Prometheus, at /metrics. Times and rates are simulated ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector

from warehouse_viewer.api.operations_json import QUANTILES
from warehouse_viewer.api.schemas.fleet import RobotsByWork
from warehouse_viewer.api.schemas.operations import STATES
from warehouse_viewer.api.schemas.pydantic_versions import names_of
from warehouse_viewer.page.source import AwayError
from warehouse_viewer.ros.feed import Feed
from warehouse_viewer.ros.operations_client import OperationsClient

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState, ForecastResult, StationState

# Figures of the Kpis: name, what it is, field.
SHIFT_COUNTERS = (
    ("items_picked", "Pieces that were picked.", "items_picked"),
    ("lines_picked", "Order lines that were picked.", "lines_picked"),
    ("orders_completed", "Orders that were completed.", "orders_completed"),
    ("bundles_stored", "Bundles of pieces that were put in.", "bundles_stored"),
    ("trips", "Storage units that were at a station.", "trips"),
    ("distance_metres", "That all robots have driven.", "distance_m"),
)
SHIFT_GAUGES = (
    ("shift_seconds", "Since the shift began.", "simulated_s"),
    ("item_throughput_per_hour", "Pieces an hour since then.", "item_throughput_per_hour"),
    ("item_upper_bound_per_hour", "That stations can reach.", "item_upper_bound_per_hour"),
    ("item_score_ratio", "Throughput over upper bound.", "item_score"),
    ("pile_on", "Pieces a storage unit at a picking station.", "pile_on"),
    ("station_idle_ratio", "Of the picking stations' time.", "station_idle_fraction"),
    ("late_orders_ratio", "Orders that are or were late.", "late_orders_fraction"),
    ("orders_late", "Orders past their due time that are not complete.", "orders_late"),
    ("stock_ratio", "Pieces over room for pieces.", "stock_level"),
)
FORECAST = (
    ("done", "Orders done by the end of the last forecast without changes."),
    ("open", "Orders that are open then."),
    ("late", "Orders that are late by then."),
)
PERCENTILES = {"p25": "25", "median": "50", "p75": "75", "p95": "95"}
# Figures of the CoordinatorState.
FLEET_COUNTERS = (
    ("transports_delivered", "Storage units brought to where they should go.", "delivered"),
    ("transports_stored", "Storage units brought back.", "stored"),
    ("transports_failed", "Transports that came to nothing.", "failed"),
    ("collisions", "Since the coordinator began.", "collisions"),
    ("blocked", "How often a robot was blocked.", "blocked"),
    ("watchdog", "How often robots made no progress for 30 s.", "watchdog"),
)
FLEET_GAUGES = (
    ("executed_over_planned_ratio", "Seconds driven over planned.", "executed_over_planned"),
)
TRANSPORT_STATES = ("open", "under_way")


class Metrics(Collector):
    """Figures of a Feed and of the operations, read on each request. recorded: returns the memory
    that the recording of the last hour takes [bytes]; None if the viewer records nothing."""

    def __init__(
        self,
        feed: Feed,
        operations: OperationsClient,
        recorded: Callable[[], int] | None = None,
    ) -> None:
        self._feed, self._operations, self._shift = feed, operations, operations.feed
        self._recorded = recorded
        self._registry = CollectorRegistry()
        self._registry.register(self)

    def text(self, accepted: str = "") -> tuple[bytes, str]:
        """Returns (text, content type) in the format that a request's Accept header asks for."""
        encode, content_type = choose_encoder(accepted)
        return encode(self._registry), content_type

    def describe(self) -> list[Any]:
        """Returns nothing to the registry: no name is known before the figures are."""
        return []

    def collect(self) -> Iterator[Any]:
        """Yields the metric families (prometheus_client's hook)."""
        yield _gauge("shift_up", "Whether a shift is running.", float(self._shift.runs))
        state = self._feed.coordinator
        yield _gauge("coordinator_up", "Whether a coordinator runs.", float(state is not None))
        if self._recorded:
            text = "Memory of the recording of the last hour."
            yield _gauge("recording_bytes", text, self._recorded())
        yield from self._world()
        if state:
            yield from _fleet(state)
        yield from self._of_shift()

    def _world(self) -> Iterator[Metric]:
        if performance := self._feed["performance"]:
            text = "Simulated seconds a wall second."
            yield _gauge("real_time_factor", text, performance.real_time_factor)
        if fleet := self._feed["fleet"]:
            yield _gauge("simulated_time_seconds", "Time in the world.", fleet.stamp.to_sec())

    def _of_shift(self) -> Iterator[Metric]:
        yield _by_label("orders", "Orders that are kept.", "state", self._orders())
        if kpis := self._shift["kpis"]:
            yield from (_counter(name, text, getattr(kpis, f)) for name, text, f in SHIFT_COUNTERS)
            yield from (_gauge(name, text, getattr(kpis, f)) for name, text, f in SHIFT_GAUGES)
            turnover = {p: getattr(kpis.order_turnover_s, n) for n, p in PERCENTILES.items()}
            text = "From an order's arrival to its completion."
            yield _by_label("order_turnover_seconds", text, "percentile", turnover)
        if forecast := self._shift.forecast:
            yield from _forecast(forecast)
        if message := self._shift["stations"]:
            yield from _stations(message.stations)

    def _orders(self) -> dict[str, int]:
        """{state: how many}."""
        if not self._shift.runs:
            return {}
        try:
            return {
                name.lower(): self._operations.find_orders(state=number, limit=0).total
                for number, name in enumerate(STATES)
            }
        except AwayError:  # it has just ended
            return {}


def _forecast(result: ForecastResult) -> Iterator[Metric]:
    """Yields the band at the end of the last forecast of the shift as it is."""
    made_at = result.made_at
    text = "Simulated time of the last forecast without changes."
    yield _gauge("forecast_made_at_seconds", text, made_at)
    yield _gauge("forecast_minutes", "How far it looks ahead.", result.minutes)
    for name, text in FORECAST:
        bands = {q: getattr(result, f"{name}_{q}") for q in QUANTILES}
        ends = {q: band[-1] for q, band in bands.items() if len(band)}
        yield _by_label(f"forecast_{name}", text, "quantile", ends)
    finish = {q: getattr(result, f"finish_{q}") for q in QUANTILES}
    text = "Simulated time at which all orders of now are done; NaN: not within the forecast."
    yield _by_label("forecast_finish_seconds", text, "quantile", finish)


def _fleet(state: CoordinatorState) -> Iterator[Metric]:
    names = [*names_of(RobotsByWork), "manual", "out_of_service"]
    robots = {name: getattr(state, name) for name in names}
    yield _by_label("robots", "Robots by what they do.", "state", robots)
    yield _gauge("robots_waiting", "That have stood for 10 s or longer.", len(state.waiting_kiva))
    transports = {name: getattr(state, name) for name in TRANSPORT_STATES}
    yield _by_label("transports", "Those that are not over.", "state", transports)
    plans = {"50": state.plan_p50 / 1000, "99": state.plan_p99 / 1000}
    yield _by_label("plan_seconds", "Computing time of a plan.", "percentile", plans)
    yield _gauge("alarms", "Alarms of the coordinator.", len(state.alarms))
    yield from (_counter(name, text, getattr(state, field)) for name, text, field in FLEET_COUNTERS)
    yield from (_gauge(name, text, getattr(state, field)) for name, text, field in FLEET_GAUGES)


def _stations(stations: Iterable[StationState]) -> Iterator[Metric]:
    for name, text, kind, value in (
        ("queue", "Units at a station or on their way to it.", GaugeMetricFamily, _queue),
        ("busy_ratio", "Of the time since the shift began.", GaugeMetricFamily, _busy),
        ("open", "Whether it is open.", GaugeMetricFamily, lambda s: float(s.open)),
        ("orders", "Orders it works at.", GaugeMetricFamily, lambda s: len(s.orders)),
        ("pieces", "Picked there, or put in.", CounterMetricFamily, lambda s: s.pieces),
    ):
        family = kind(f"warehouse_station_{name}", text, labels=["station", "kind"])
        for station in stations:
            family.add_metric([station.name, station.kind], value(station))
        yield family


def _queue(station: StationState) -> int:
    return len(station.inbound) + bool(station.shelf_id)


def _busy(station: StationState) -> float:
    return station.busy_fraction


def _gauge(name: str, text: str, value: float) -> Metric:
    return GaugeMetricFamily(f"warehouse_{name}", text, value)


def _counter(name: str, text: str, value: float) -> Metric:
    return CounterMetricFamily(f"warehouse_{name}", text, value)


def _by_label(name: str, text: str, label: str, values: Mapping[str, float]) -> Metric:
    family = GaugeMetricFamily(f"warehouse_{name}", text, labels=[label])
    for key, value in values.items():
        family.add_metric([key], value)
    return family
