# SPDX-License-Identifier: Apache-2.0
"""A slow page gets the newest, not the past; commands learn what became of them."""

import asyncio
import csv
import io

import rospy
from fake_hub import Socket, hub_of
from fake_ros import FakeRos
from sample_messages import World, fleet, rows
from std_msgs.msg import Header

from warehouse_msgs.msg import Event, FleetPaths
from warehouse_viewer.api import catalogue
from warehouse_viewer.page import hub as hub_module
from warehouse_viewer.page.hub import IN_FLIGHT, Page, paths_of
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.ros.commander import Commander


async def settle():
    for _ in range(20):
        await asyncio.sleep(0)


async def tell(hub):
    async with hub._turn:
        hub._turn.notify_all()
    await settle()


def test_a_page_that_does_not_answer_gets_no_more_and_then_only_the_newest():
    async def scenario():
        world, socket = World(), Socket()
        world.turn()
        hub = hub_of(world)
        page = Page(socket, 0)
        sending = asyncio.create_task(hub._send_forever(page))
        await settle()
        for step in range(50):
            world.turn(fleet=fleet(x=(float(step), -1.0 - step)))
            await tell(hub)
        assert len(socket.updates) == IN_FLIGHT
        await hub._handle(page, {"ack": IN_FLIGHT})
        await tell(hub)
        assert len(socket.updates) == IN_FLIGHT + 1
        assert rows(socket.updates[-1]) == [2, 0, 0, 0]
        assert page.tick == world.model.tick
        sending.cancel()

    asyncio.run(scenario())


def test_a_page_gets_updates_no_sooner_than_it_asks_for(monkeypatch):
    forever = 1e6  # [s]
    monkeypatch.setattr(hub_module, "MOST_GAP", forever)

    async def scenario():
        world, socket = World(), Socket()
        world.turn()
        hub = hub_of(world)
        page = Page(socket, 0)
        await hub._handle(page, {"gap": forever})
        sending = asyncio.create_task(hub._send_forever(page))
        await settle()
        world.turn(fleet=fleet(x=(3.0, 4.0)))
        await tell(hub)
        assert len(socket.updates) == 1
        sending.cancel()

    asyncio.run(scenario())


def test_a_page_gets_the_scene_before_the_rows_that_refer_to_it():
    async def scenario():
        world, socket = World(), Socket()
        world.turn()
        await hub_of(world)._send_changes(Page(socket, 0))
        assert [text["type"] for text in socket.texts] == ["scene"]
        assert rows(socket.updates[0]) == [2, 1, 1, 1]

    asyncio.run(scenario())


class Talker(Socket):
    """A page that says these texts, and then nothing."""

    def __init__(self, said):
        super().__init__()
        self.said = list(said)

    async def receive_text(self):
        if self.said:
            return self.said.pop(0)
        return await asyncio.Future()


def stays(said):
    """Whether the hub goes on listening after a page said that."""

    async def scenario():
        listening = asyncio.create_task(hub_of(World())._listen_forever(Page(Talker(said), 0)))
        for _ in range(100):
            await settle()
        ended = listening.done()
        listening.cancel()
        return not ended

    return asyncio.run(scenario())


def test_a_page_that_talks_nonsense_or_too_much_is_let_go():
    assert stays(['{"ack": 1}', '{"watch": {"scans": [1], "paths": [2]}}'])
    for nonsense in (
        "no json",
        "[1]",
        '{"ack": "many"}',
        '{"watch": 3}',
        '{"watch": {"scans": 1}}',
    ):
        assert stays([nonsense]) is (nonsense == "[1]")
    assert not stays(['{"ack": 1}'] * 300)


def test_events_come_once():
    async def scenario():
        journal, socket, world = Journal(), Socket(), World()
        hub, page = hub_of(world, journal), Page(socket, 0)
        journal.add(
            catalogue.event(
                Event(header=Header(stamp=rospy.Time(2)), kind=Event.DONE, model="kiva1")
            )
        )
        await hub._send_changes(page)
        await hub._send_changes(page)
        (text,) = socket.texts
        assert text["events"][0] | {"id": 1, "kind": "DONE", "time": 2.0} == text["events"][0]

    asyncio.run(scenario())


def test_the_journal_forgets_the_models_that_had_no_trouble_for_longest():
    """Robots and units of a thousand warehouses have names, and most of them are gone."""
    journal = Journal(kept=2, models=3)
    for number in (1, 2, 3, 1, *range(4, 400), 1, 400):
        journal.add(
            catalogue.event(Event(kind=Event.BLOCKED, model=f"kiva{number}", other=f"wall{number}"))
        )
        assert len(journal._own) <= 3
    assert [e["id"] for e in journal.since(0, "kiva399")] == []
    assert [e["model"] for e in journal.since(0, "kiva1")] == ["kiva1"]
    journal = Journal(kept=2, models=3)
    for number in (1, 2, 3, 1, 4):
        journal.add(catalogue.event(Event(kind=Event.BLOCKED, model=f"kiva{number}")))
    assert [len(journal.since(0, f"kiva{number}")) for number in (1, 2, 3, 4)] == [2, 0, 1, 1]


def test_the_journal_keeps_the_last():
    journal = Journal(kept=3)
    for kind in (Event.ACCEPTED, Event.DONE, Event.ACCEPTED, Event.BLOCKED):
        journal.add(catalogue.event(Event(kind=kind, model="kiva1", other="wall1")))
    assert [e["id"] for e in journal.since(0)] == [2, 3, 4]
    assert [e["kind"] for e in journal.since(3)] == ["BLOCKED"]
    assert journal.since(4) == []
    assert len(journal.since(0, model="wall1")) == 3
    assert journal.since(0, model="kiva2") == []
    assert [e["id"] for e in journal.since(0, limit=1)] == [4]


def test_paths_are_those_of_the_wanted_robots():
    message = FleetPaths(rospy.Time(1), [3, 5], [1, 2], [1, 2, 3], [4, 5, 6])
    assert paths_of(message, {5, 9}) == {5: [[2, 5], [3, 6]]}
    assert paths_of(None, {5}) == {}


def command(events, until_end, timeout=1.0):
    """The Outcome of a command to kiva1 that is followed by these (kind, model[, command])."""

    async def scenario():
        commander = Commander(FakeRos())
        fields = {"direction": 1}
        waiting = asyncio.create_task(commander.send("rot", 1, fields, until_end, timeout))
        await settle()
        for kind, model, *number in events:
            known = {"command": number[0] if number else 7}
            commander.note({"kind": kind, "model": model, "text": "why"} | known)
        return await waiting

    return asyncio.run(scenario())


def test_a_command_learns_its_answer():
    assert command([("DONE", "kiva2"), ("ACCEPTED", "kiva1")], False).kind == "accepted"
    refused = command([("REFUSED", "kiva1")], True)
    assert (refused.kind, refused.events[-1]["text"]) == ("refused", "why")


def test_a_command_learns_its_end():
    events = [("ACCEPTED", "kiva1"), ("LIFTED", "kiva1"), ("DONE", "kiva1")]
    outcome = command(events, True)
    assert (outcome.kind, len(outcome.events)) == ("done", 3)
    assert command([("ACCEPTED", "kiva1"), ("BLOCKED", "kiva1")], True).kind == "blocked"


def test_a_command_without_an_answer_is_pending():
    others = [("ACCEPTED", "kiva1"), ("REFUSED", "kiva1", 8), ("DONE", "kiva1", 6)]
    outcome = command([*others, ("BLOCKED", "kiva1")], True)
    assert (outcome.kind, len(outcome.events)) == ("blocked", 2)
    assert command(others, True, timeout=0.05).kind == "accepted"
    assert command([("ACCEPTED", "kiva2")], False, timeout=0.05).kind == "pending"


def test_names_are_no_formulas_in_a_spreadsheet():
    journal = Journal()
    event = {"time": 1.5, "kind": "SPAWNED", "command": 0, "other": "", "text": "-2.5"}
    names = ("=1+1", "+1+1", "-1+1", "@SUM(1)", "\t=1", "\r=1", "＝1", "kiva1", "a=1", "'=1")
    for name in names:
        journal.add(event | {"model": name})
    rows = list(csv.DictReader(io.StringIO(journal.csv(), newline="")))
    assert [row["model"] for row in rows] == [f"'{n}" for n in names[:7]] + list(names[7:])
    assert (rows[0]["time"], rows[0]["text"], rows[0]["id"]) == ("1.5", "-2.5", "1")
