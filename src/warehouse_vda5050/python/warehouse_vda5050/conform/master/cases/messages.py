# SPDX-License-Identifier: Apache-2.0
"""Form and headers of orders and instant actions (6.4, 6.6.6, 6.9), and how they are sent (6.2)."""

import re
from collections.abc import Iterator

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master import form
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("messages")
case = chapter.case
STAMP = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z")
NAMES = {
    Kind.ORDER: "orders",
    Kind.INSTANT_ACTIONS: "instant actions",
    Kind.ZONE_SET: "zone sets",
    Kind.RESPONSES: "responses",
}


def _sent(stage: Stage, *kinds: Kind) -> list[Entry]:
    """Returns the messages of the master. Raises Untestable without any."""
    entries = [e for kind in kinds for e in stage.received(kind)]
    if not entries:
        raise Untestable(f"the master sent no {' and no '.join(NAMES[kind] for kind in kinds)}")
    return entries


def _form(stage: Stage, kind: Kind) -> None:
    for entry in _sent(stage, kind):
        wrong = form.faults(kind, entry.value, stage.codec.version)
        demand(not wrong, "; ".join(wrong[:3]))


@case("order_form", "6.6.6", audit=True)
def order_form(stage: Stage) -> None:
    """Each order has its fields, of the right types."""
    _form(stage, Kind.ORDER)


@case("instant_form", "6.9", audit=True)
def instant_form(stage: Stage) -> None:
    """Each message of instant actions has its fields, of the right types."""
    _form(stage, Kind.INSTANT_ACTIONS)


@case("numbers", "6.1.4", audit=True)
def numbers(stage: Stage) -> None:
    """NaN and infinity stand nowhere: JSON has no such numbers."""
    for entry in _sent(stage, *stage.to_vehicle):
        spoilt = re.search(rb"[:\[,]\s*(NaN|-?Infinity)\b", entry.payload)
        demand(not spoilt, f"{entry.topic} has {spoilt and spoilt[1].decode()}")


@case("utf8", "6.1.2", audit=True)
def utf8(stage: Stage) -> None:
    """All is encoded in UTF-8."""
    for entry in _sent(stage, *stage.to_vehicle):
        demand("\ufffd" not in entry.text, f"{entry.topic} is not UTF-8")


def _by_topic(stage: Stage) -> Iterator[list[Entry]]:
    for kind in stage.to_vehicle:
        for actor in stage.actors:
            yield stage.received(kind, 0, actor)


def _ids(stage: Stage, kind: Kind) -> None:
    _sent(stage, kind)
    for actor in stage.actors:
        entries = stage.received(kind, 0, actor)
        counted = [(e.value or {}).get("headerId") for e in entries]
        for before, after in zip(counted, counted[1:]):
            follows = after == ((before or 0) + 1) % (1 << 32)
            demand(follows, f"{actor.name}/{kind.value}: headerId {after} follows {before}")


@case("order_ids", "6.4", audit=True)
def order_ids(stage: Stage) -> None:
    """headerId of orders counts up by one for each message of the topic."""
    _ids(stage, Kind.ORDER)


@case("instant_ids", "6.4", audit=True)
def instant_ids(stage: Stage) -> None:
    """headerId of instant actions counts up by one for each message of the topic."""
    _ids(stage, Kind.INSTANT_ACTIONS)


@case("zone_ids", "7.2", audit=True, versions=("3.0.0",))
def zone_ids(stage: Stage) -> None:
    """headerId of zone sets and of responses counts up by one for each message of the topic."""
    _sent(stage, Kind.ZONE_SET, Kind.RESPONSES)
    for kind in (Kind.ZONE_SET, Kind.RESPONSES):
        if stage.received(kind):
            _ids(stage, kind)


@case("stamps", "6.4", audit=True)
def stamps(stage: Stage) -> None:
    """timestamp is ISO 8601 in UTC."""
    for entry in _sent(stage, *stage.to_vehicle):
        value = (entry.value or {}).get("timestamp")
        demand(STAMP.fullmatch(str(value)), f"{entry.topic}: timestamp is {value!r}")


@case("rising", "6.4", audit=True)
def rising(stage: Stage) -> None:
    """timestamp never goes back."""
    _sent(stage, *stage.to_vehicle)
    for entries in _by_topic(stage):
        times = [entry.stamp for entry in entries]
        for before, after in zip(times, times[1:]):
            demand(before <= after, f"{entries[0].topic}: {after} follows {before}")


@case("clock", "6.4", audit=True)
def clock(stage: Stage) -> None:
    """timestamp advances as the clock does."""
    entries = _sent(stage, Kind.ORDER)
    real = entries[-1].time - entries[0].time
    if real < 20.0:
        raise Untestable("the run was too short")
    passed = (entries[-1].stamp - entries[0].stamp).total_seconds()
    demand(abs(passed - real) < 0.1 * real, f"{passed:.0f} s passed in {real:.0f} s")


@case("version", "6.4", audit=True)
def version(stage: Stage) -> None:
    """version is that which is tried."""
    ours = stage.codec.version.rpartition(".")[0]
    for entry in _sent(stage, *stage.to_vehicle):
        value = str((entry.value or {}).get("version"))
        demand(value.startswith(ours), f"{entry.topic}: version is {value}")


@case("identity", "6.4", audit=True)
def identity(stage: Stage) -> None:
    """manufacturer and serialNumber are those of the vehicle whose topic it is."""
    for entry in _sent(stage, *stage.to_vehicle):
        value = entry.value or {}
        name = f"{value.get('manufacturer')}/{value.get('serialNumber')}"
        demand(name == entry.vehicle, f"{entry.topic} is for {name}")


@case("qos", "6.2", audit=True)
def qos(stage: Stage) -> None:
    """All that the master sends has quality of service 0."""
    entries = [e for e in stage.observed.entries if not e.retained]
    if not entries:
        raise Untestable("the master sent nothing")
    for entry in entries:
        demand(entry.qos == 0, f"{entry.topic} came with quality of service {entry.qos}")


@case("retained", "6.14", audit=True, strict=True)
def retained(stage: Stage) -> None:
    """Nothing that the master sends is retained: a vehicle that comes back would get old orders."""
    _sent(stage, *stage.to_vehicle)
    mark = len(stage.observed.entries)
    for actor in stage.actors:
        for kind in stage.to_vehicle:
            stage.wire.hear(stage.topics.of(actor.role.identity, kind))
    stage.wait(1.0)
    kept = [e for e in stage.observed.entries[mark:] if e.retained and e.payload]
    demand(not kept, f"the broker has retained {len(kept)}, such as {kept and kept[0].topic}")


@case("own_topics", "6.5", audit=True)
def own_topics(stage: Stage) -> None:
    """The master sends orders, instant actions, and in 3.0 zone sets and responses; the vehicle
    sends the rest."""
    _sent(stage, *stage.to_vehicle)
    entries = stage.foreign.entries
    demand(not entries, f"{entries and entries[0].topic} was not sent by the vehicle")
