# SPDX-License-Identifier: Apache-2.0
"""Tools: a warehouse in words, what stands where, why something waits, alarms and events."""

import asyncio
import re
from typing import Annotated, Any

from pydantic import Field

from warehouse_assistant import hub_client
from warehouse_assistant.hub_client import Trouble
from warehouse_assistant.toolbox import Simulation, Toolbox
from warehouse_assistant.words import count, duration, listed, plain, quoted, sentence

NUMBERED = re.compile(r"(kiva|robot|storage_unit|unit|item|order)[ _#-]?(\d{1,10})", re.IGNORECASE)
KINDS = {"robot": "kiva", "unit": "storage_unit"}
MOST_HITS = 10
ENDED = ("STORED", "FAILED", "CANCELLED")  # states of transports

Row = dict[str, Any]
Client = hub_client.Simulation


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.reads("Describe a warehouse")
    async def describe_warehouse(simulation: Simulation = "") -> str:
        """Describes what runs, waits or needs help, and compares figures with their targets."""
        warehouse = await box.hub.simulation(simulation)
        whole = await warehouse.get("warehouse")
        names = ("coordinator", "stations", "figures", "kpis", "alarms")
        parts = await asyncio.gather(*(warehouse.get_or_none(name) for name in names))
        fleet, stations, figures, kpis, alarms = parts
        lines = [_headline(warehouse.name, whole)]
        lines += [_fleet(fleet)] if fleet else ["No coordinator runs: robots take commands alone."]
        if kpis and figures:
            lines += [_orders(kpis), _figures(figures)]
            lines += [_station(s, whole["time"]) for s in (stations or {}).get("stations", [])]
        else:
            lines.append("No shift runs: there are no orders.")
        lines.append(_alarms(alarms))
        return "\n".join(lines)

    @box.reads("Find something")
    async def find(
        what: Annotated[
            str,
            Field(
                min_length=1,
                max_length=80,
                description="kiva3, unit 12, item 5, order 7, pick1, a SKU, or a reference",
            ),
        ],
        simulation: Simulation = "",
    ) -> str:
        """Finds a robot, storage unit, item, station, SKU or order, and returns its state."""
        warehouse = await box.hub.simulation(simulation)
        if match := NUMBERED.fullmatch(what.strip()):
            kind = KINDS.get(match[1].lower(), match[1].lower())
            return await _numbered(warehouse, kind, int(match[2]))
        return await _named(warehouse, what.strip())

    @box.reads("Explain why something waits")
    async def why_waiting(
        what: Annotated[
            str,
            Field(min_length=1, max_length=100, description="a robot or a station: kiva3, pick1"),
        ],
        simulation: Simulation = "",
    ) -> str:
        """Explains why a robot or a station is waiting, and what helps."""
        warehouse = await box.hub.simulation(simulation)
        match = NUMBERED.fullmatch(what.strip())
        if match and match[1].lower() in ("kiva", "robot"):
            return await _why_robot(warehouse, int(match[2]))
        return await _why_station(warehouse, what.strip())

    @box.reads("List alarms")
    async def alarms(simulation: Simulation = "") -> str:
        """Lists the alarms that hold now, with what a person should do."""
        warehouse = await box.hub.simulation(simulation)
        rows = (await warehouse.get("alarms"))["alarms"]
        return "\n".join(map(_alarm, rows)) or "There are no alarms."

    @box.reads("List recent events")
    async def recent_events(
        model: Annotated[str, Field(max_length=100, description="of it alone, as kiva3")] = "",
        limit: Annotated[int, Field(ge=1, le=200, description="largest count of events")] = 30,
        simulation: Simulation = "",
    ) -> str:
        """Lists the newest events of the warehouse's journal, the newest first."""
        warehouse = await box.hub.simulation(simulation)
        rows = (await warehouse.get("events", model=model, limit=limit))["events"]
        return "\n".join(map(_event, reversed(rows))) or "There are no such events yet."


def _headline(name: str, whole: Row) -> str:
    pace = "paused" if whole["paused"] else f"real-time factor {whole['real_time_factor']:.2g}"
    return (
        f"{quoted(name)} is warehouse {quoted(whole['name'])}: {count(whole['robots'], 'robot')},"
        f" {count(whole['storage_units'], 'storage unit')}, {count(whole['items'], 'item')};"
        f" simulated time {duration(whole['time'])}, {pace}."
    )


def _fleet(fleet: Row) -> str:
    acts, transports, modes = fleet["activities"] or {}, fleet["transports"], fleet["robots"]
    doing = listed(f"{number} {name.replace('_', ' ')}" for name, number in acts.items() if number)
    text = f"Robots: {doing or 'none reported'}."
    if modes["manual"] or modes["out_of_service"]:
        text += f" {modes['manual']} manual, {modes['out_of_service']} out of service."
    text += (
        f" Transports: {transports['open']} without a robot yet, {transports['under_way']} under"
        f" way, {transports['stored']} done, {transports['failed']} failed."
    )
    waits = [f"kiva{w['robot']} {quoted(w['text'])}" for w in fleet["waiting"]]
    return text + (f" Standing for 10 s or longer: {listed(waits, 5)}." if waits else "")


def _orders(kpis: Row) -> str:
    return (
        f"Orders: {kpis['orders_waiting']} wait, {kpis['orders_at_stations']} at stations,"
        f" {kpis['orders_completed']} completed, {kpis['orders_late']} late;"
        f" {kpis['items_picked']} pieces picked, {kpis['pile_on']:.1f} a visit."
    )


def _figures(figures: Row) -> str:
    def against(name: str, unit: str, factor: float = 1.0) -> str:
        value, target = figures[name]["value"] * factor, figures[name]["target"] * factor
        return f"{value:.0f}{unit} (target {target:.0f}{unit})" if target else f"{value:.0f}{unit}"

    return (
        f"Figures: {against('pieces', '')} pieces an hour, {against('orders', '')} orders an hour,"
        f" {against('late', ' %', 100)} late, {against('available', ' %', 100)} robots available."
    )


def _station(station: Row, now: float) -> str:
    text = f"{quoted(station['name'])} ({station['kind'].lower()}): "
    text += "open" if station["open"] else "closed"
    text += f", {station['mode']}, {station['activity'].lower().replace('_', ' ')}"
    text += f" for {duration(max(0.0, now - station['since']))}"
    text += f", unit {station['shelf_id']} there" if station["shelf_id"] else ", no unit there"
    text += f", {len(station['inbound'])} on the way, {count(len(station['orders']), 'order')}"
    return f"{text}, {station['pieces_per_hour']:.0f} pieces an hour."


def _alarms(alarms: Row | None) -> str:
    rows = (alarms or {}).get("alarms", [])
    if not rows:
        return "No alarm: nothing needs help."
    return f"{count(len(rows), 'alarm')}; the worst: {_alarm(rows[0])}"


def _alarm(alarm: Row) -> str:
    text = f"{alarm['severity']}: {plain(alarm['title'])}, {quoted(alarm['subject'])}"
    text += f", {quoted(alarm['text'], 200)}. {plain(alarm['to_do'], 300)}"
    return text + (f" Seen by {quoted(alarm['seen_by'])}." if alarm["seen_by"] else "")


def _event(event: Row) -> str:
    subject = " ".join(quoted(event[key]) for key in ("model", "other") if event[key])
    return (
        f"{event['time']:.1f} s {plain(event['kind'], 40)} {subject}: {quoted(event['text'], 200)}"
    )


async def _numbered(warehouse: Client, kind: str, number: int) -> str:
    if kind == "kiva":
        return _robot(await warehouse.get(f"robots/{number}"))
    if kind == "order":
        return order_text(await warehouse.get(f"orders/{number}"))
    if kind == "item":
        return _thing(await warehouse.get(f"items/{number}"))
    unit = await warehouse.get(f"storage_units/{number}")
    items = await warehouse.get("items", storage_unit=unit["name"], limit=20)
    lies = listed((quoted(row["name"]) for row in items["things"]), 8)
    return f"{_thing(unit)} On it: {lies or 'nothing'}."


def _robot(robot: Row) -> str:
    text = f"{quoted(robot['name'])}: {robot['activity'].lower().replace('_', ' ')}"
    text += f" ({robot['status']}, {plain(robot['state'], 40)}) at ({robot['x']:.2f},"
    text += f" {robot['y']:.2f}) m, charge {robot['charge']:.0%}"
    text += f", carries {quoted(robot['storage_unit'])}" if robot["storage_unit"] else ""
    failures = listed(map(quoted, robot["failures"]))
    return text + (f", failures: {failures}." if failures else ".")


def _thing(thing: Row) -> str:
    pose = thing["pose"]
    text = f"{quoted(thing['name'])} at ({pose['x']:.2f}, {pose['y']:.2f}, {pose['z']:.2f}) m"
    text += f", on {quoted(thing['storage_unit'])}" if thing["storage_unit"] else ""
    return text + (f", carried by {quoted(thing['carrier'])}." if thing["carrier"] else ".")


def order_text(order: Row) -> str:
    """Returns an order in words."""
    lines = listed(
        (f"{ln['picked']}/{ln['quantity']} {quoted(ln['sku'], 60)}" for ln in order["lines"]), 8
    )
    text = f"Order {order['order_id']} (reference {quoted(order['reference'])}): {order['state']}"
    text += f", priority {order['priority']}"
    text += f", at {quoted(order['station'])}" if order["station"] else ""
    text += f", due at {order['due']:.0f} s" if order["due"] else ""
    text += f", completed at {order['completed']:.0f} s" if order["completed"] else ""
    return f"{text}; picked: {lines}."


async def _named(warehouse: Client, what: str) -> str:
    stations = await warehouse.get_or_none("stations")
    now = (await warehouse.get("warehouse"))["time"]
    rows = (stations or {}).get("stations", [])
    hits = [_station(s, now) for s in rows if what.lower() == str(s["name"]).lower()]
    robots = await warehouse.get("robots", name=what, limit=MOST_HITS)
    hits += map(_robot, robots["robots"])
    if stations and what.isascii() and what.isprintable():
        skus = (await warehouse.get("skus", search=what, limit=MOST_HITS))["skus"]
        exact = [row for row in skus if row["sku"].lower() == what.lower()]
        for row in exact or skus:
            hits.append(await _sku(warehouse, row) if exact else _sku_line(row))
        orders = await warehouse.get("orders", search=what, limit=MOST_HITS)
        hits += map(order_text, orders["orders"])
        if orders["total"] > MOST_HITS:
            hits.append(f"{orders['total'] - MOST_HITS} more orders; list_orders lists them.")
    if hits:
        return "\n".join(hits)
    return (
        f"Nothing here is called {quoted(what)}. Ask by number (kiva3, unit 12, item 5, order 7),"
        " by a station's name, a SKU or an order's reference; describe_warehouse names stations."
    )


def _sku_line(row: Row) -> str:
    return f"SKU {quoted(row['sku'])}: {count(row['available'], 'piece')} not promised to an order."


async def _sku(warehouse: Client, row: Row) -> str:
    stock = await warehouse.get("stock", sku=row["sku"], limit=8)
    bins = (f"{p['quantity']} on unit {p['shelf_id']}" for p in stock["places"])
    return f"{_sku_line(row)} In stock: {stock['pieces']}, {listed(bins, 8) or 'nowhere'}."


async def _why_robot(warehouse: Client, number: int) -> str:
    robot = await warehouse.get(f"robots/{number}")
    fleet = await warehouse.get_or_none("coordinator")
    transports = await warehouse.get_or_none("transports", limit=1000)
    alarms = await warehouse.get_or_none("alarms")
    why = await warehouse.get_or_none(f"why/{robot['name']}")
    lines = [_robot(robot), *_reason(why, fleet)]
    for row in (transports or {}).get("transports", []):
        if row["robot"] == robot["name"] and row["state"] not in ENDED:
            goal = quoted(row["station"]) if row["station"] else "a cell"
            lines.append(
                f"Transport {row['id']} ({row['state']}): {row['storage_unit']} to {goal}."
            )
            if row["state"] == "ARRIVED":
                lines.append("The unit waits there to be released, by its station or release_unit.")
    lines += _alarms_of(alarms, robot["name"], why)
    lines += _what_helps(robot, fleet)
    return "\n".join(lines)


def _reason(why: Row | None, fleet: Row | None) -> list[str]:
    """Returns the sentence that all pages have for something, and for how long it holds."""
    if why is None:
        return []
    holds = f" For {duration(max(0.0, fleet['time'] - why['since']))}." if fleet else ""
    return [sentence(quoted(why["sentence"], 300)) + holds]


def _alarms_of(alarms: Row | None, name: str, why: Row | None) -> list[str]:
    """Returns the alarms about something, and about what it waits for."""
    subjects = {name, why["cause"] if why else ""}
    return [_alarm(row) for row in (alarms or {}).get("alarms", []) if row["subject"] in subjects]


def _what_helps(robot: Row, fleet: Row | None) -> list[str]:
    if fleet and robot["id"] in fleet["out_of_service"]:
        return ["It is OUT_OF_SERVICE. set_robot_mode AUTOMATIC gives it to the coordinator."]
    if fleet and robot["id"] in fleet["manual"]:
        return ["It is MANUAL: a person commands it. set_robot_mode AUTOMATIC gives it back."]
    if robot["status"] == "BLOCKED":
        return ["Its last command ended before an obstacle. Clear its way, then command it again."]
    if robot["activity"] == "RESTING":
        return ["It has no work: there is no transport for it now."]
    return [] if robot["activity"] in ("WAITING", "NEEDS_HELP") else ["It does not wait too long."]


async def _why_station(warehouse: Client, name: str) -> str:
    rows = (await warehouse.get("stations"))["stations"]
    station = next((s for s in rows if str(s["name"]).lower() == name.lower()), None)
    if station is None:
        which = listed(quoted(s["name"]) for s in rows)
        raise Trouble(f"There is no robot or station {quoted(name)}. Stations: {which}.")
    fleet = await warehouse.get_or_none("coordinator")
    alarms = await warehouse.get_or_none("alarms")
    now = fleet["time"] if fleet else (await warehouse.get("warehouse"))["time"]
    why = await warehouse.get_or_none(f"why/{hub_client.segment(station['name'])}")
    lines = [_station(station, now), *_reason(why, fleet), *_help_for(station)]
    waiting = {w["robot"]: w for w in (fleet or {}).get("waiting", [])}
    lines += [_queued(row, waiting.get(row["robot"])) for row in station["queue"]]
    lines += _alarms_of(alarms, station["name"], why)
    return "\n".join(lines)


def _help_for(station: Row) -> list[str]:
    """Returns which tool helps a station that waits."""
    if not station["open"]:
        return ["set_station opens it."]
    if station["waiting"]:
        return ["confirm_pick confirms for the person there."]
    if station["kind"] == "PICK" and not station["orders"]:
        return ["It has no orders; submit_order brings some."]
    if not station["shelf_id"] and not station["queue"]:
        return ["No free unit or robot can serve its orders now."]
    return []


def _queued(row: Row, waiting: Row | None) -> str:
    if not row["robot"]:
        return f"Unit {row['unit']}: no robot carries it yet."
    text = f"Unit {row['unit']} on kiva{row['robot']}"
    text += f", standing for {duration(row['stands'])}" if row["stands"] else ", moving"
    text += " (too long)" if row["is_long"] else ""
    return sentence(text + (f": {quoted(waiting['text'], 200)}" if waiting else ""))
