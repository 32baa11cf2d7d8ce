# SPDX-License-Identifier: Apache-2.0
"""What people ask of an assistant, over both transports, of a real warehouse."""

import asyncio
import base64
import json
import re

import pytest
from assistants import connected
from conftest import NAME
from served_hub import until

TRANSPORTS = ("http", "stdio")
READING = {
    "list_simulations": {},
    "describe_warehouse": {},
    "find": {"what": "kiva2"},
    "why_waiting": {"what": "pick1"},
    "alarms": {},
    "recent_events": {},
    "list_orders": {"limit": 100},
    "describe_station": {"station": "pick1"},
    "search_documentation": {"words": "record a shift"},
    "simulation_arguments": {},
}


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_ten_questions(talk, transport):
    async def conversation(assistant):
        return {tool: await assistant.done(tool, **args) for tool, args in READING.items()}

    replies = talk(conversation, transport, commands=False)
    for tool, text in replies.items():
        print(f"{transport} {tool}: {len(text.encode())} bytes")
    assert f'"{NAME}": RUNNING' in replies["list_simulations"]
    assert "4 robots, 24 storage units, 96 items" in replies["describe_warehouse"]
    assert '"pick1" (pick): open' in replies["describe_warehouse"]
    assert replies["find"].startswith('"kiva2": ')
    assert "in all" in replies["list_orders"] and "call more with key" in replies["list_orders"]
    assert "how-to/" in replies["search_documentation"]


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_changes_stand_in_the_hubs_journal_with_who_asked(talk, hub, transport):
    async def conversation(assistant):
        await assistant.done("set_time", action="speed", factor=1)
        return await assistant.done("list_changes", limit=1)

    last = talk(conversation, transport)
    assert "set_time" in last and "assistant" in last
    entry = hub.ask("GET", "/api/v1/journal")[1]["entries"][-1]
    assert (entry["kind"], entry["action"], entry["done"]) == ("assistant", "set_time", True)
    assert ("over stdio" in entry["who"]) == (transport == "stdio")
    assert (" at 127.0.0.1" in entry["who"]) == (transport == "http")
    assert json.loads(entry["arguments"]) == {"action": "speed", "factor": 1}
    assert (hub.home / "warehouse/hub/journal.jsonl").read_text().splitlines()

    async def refused(assistant):
        await assistant.refused("set_time", action="pause")

    talk(refused, transport, commands=False)
    entry = hub.ask("GET", "/api/v1/journal")[1]["entries"][-1]
    assert not entry["done"] and "--allow commands" in entry["outcome"]


def test_a_world_is_saved_and_inserted(talk, hub):
    async def conversation(assistant):
        text = await assistant.done("save_world", name=NAME, world="kept", replace=True)
        assert "models" in text
        text = await assistant.refused("insert_world", name=NAME, world="kept")
        assert "would stand in" in text
        assert "another name" in await assistant.refused("save_world", name=NAME, world="paper")

    talk(conversation)
    assert "kept" in [row["name"] for row in hub.ask("GET", "/api/v1/worlds")[1]["worlds"]]


def test_reports_are_resources(talk):
    async def conversation(assistant):
        read = assistant.client.read_resource
        listed = (await read("warehouse://reports")).contents[0].text
        assert f"warehouse://reports/shift/{NAME}" in listed.splitlines()
        return (await read(f"warehouse://reports/shift/{NAME}")).contents[0].text

    report = json.loads(talk(conversation))
    assert set(report) == {"kpis", "figures", "stations"} and report["kpis"]["items_picked"] >= 0


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_tools_say_what_they_are(talk, transport):
    async def conversation(assistant):
        return (await assistant.client.list_tools()).tools

    tools = {tool.name: tool for tool in talk(conversation, transport)}
    assert len(tools) >= 10
    for tool in tools.values():
        hints = tool.annotations
        assert tool.title and tool.description.count("\n") == 0, tool.name
        assert re.fullmatch(r"[A-Z][^.]*\.", tool.description), tool.description
        assert tool.input_schema["type"] == "object"
        assert None not in (hints.read_only_hint, hints.destructive_hint, hints.idempotent_hint)
    for name in ("stop_simulation", "cancel_order"):
        assert (
            tools[name].annotations.destructive_hint and not tools[name].annotations.read_only_hint
        )
    assert tools["find"].annotations.read_only_hint


def test_a_unit_is_brought_and_let_go(talk, hub):
    async def conversation(assistant):
        text = await assistant.done("transport_unit", unit=12, station="pick1")
        number = int(re.match(r"Transport (\d+)", text)[1])
        assert f"Transport {number}: " in await assistant.done("transport_state", transport=number)
        text = await assistant.done("set_station", station="pick1", is_open=False)
        assert text.startswith('"pick1" is closed')
        await assistant.comes("closed", "describe_station", station="pick1")
        await assistant.done("set_station", station="pick1", is_open=True)

    talk(conversation)


def test_an_order_is_submitted_put_first_and_cancelled(talk):
    async def conversation(assistant):
        lines = [{"sku": "sku-3", "quantity": 1}]
        text = await assistant.done("submit_order", lines=lines, reference="by hand")
        number = int(re.match(r"Order (\d+) is accepted", text)[1])
        assert 'reference "by hand"' in await assistant.done("find", what=f"order {number}")
        is_error, text = await assistant.call("prioritise_order", order=number, priority=9)
        if not is_error:  # it may be complete already
            assert text.startswith(f"Order {number}: priority 9"), text
            assert "priority 9" in await assistant.done("find", what=f"order {number}")
        await assistant.done("cancel_order", order=number)
        assert "CANCELLED" in await assistant.done("find", what=f"order {number}")
        assert "unknown" in await assistant.refused("cancel_order", order=10**9)

    talk(conversation)


def test_a_shift_is_forecast(talk):
    async def conversation(assistant):
        as_it_is = await assistant.done("forecast_shift", minutes=20)
        without = await assistant.done("forecast_shift", minutes=20, changes=["+0 close pick1"])
        wrong = await assistant.refused("forecast_shift", changes=["+0 close pick99"])
        return as_it_is, without, wrong

    as_it_is, without, wrong = talk(conversation)
    assert "Orders in 20 min, of " in as_it_is and "against as it is" in without
    assert "pick99" in wrong


def test_a_warehouse_is_sized(talk, hub):
    async def conversation(assistant):
        asked = {"layout": "small", "orders_per_hour": 100, "hours": 0.5, "late_percent": 5}
        return await assistant.done("size_warehouse", **asked)

    assert talk(conversation).startswith("Sizing 1 runs")
    until(lambda: hub.ask("GET", "/api/v1/sizings/1")[1]["state"] != "RUNNING", "it runs on")

    async def answer(assistant):
        return await assistant.done("sizing_results")

    text = talk(answer)
    assert "small, 100 orders an hour, at most 5 % late in 0.5 h: done: " in text
    assert "robot" in text and "open picking station" in text


def test_a_robot_is_sent_by_hand(talk):
    async def conversation(assistant):
        await assistant.done("set_robot_mode", robot=2, mode="MANUAL")
        await assistant.comes("MANUAL", "why_waiting", what="kiva2")
        for _ in range(100):  # it ends what it had begun
            text = await assistant.refused("send_robot", robot=2, x=1000, y=0)
            if "not idle" not in text:
                break
            await asyncio.sleep(0.3)
        assert "outside the floor" in text
        assert "no robot kiva99" in await assistant.refused("send_robot", robot=99, x=0, y=0)
        await assistant.done("set_robot_mode", robot=2, mode="AUTOMATIC")

    talk(conversation)


def test_time_is_paused_and_goes_on(talk):
    async def conversation(assistant):
        await assistant.done("set_time", action="pause")
        await assistant.comes("paused", "describe_warehouse")
        await assistant.done("set_time", action="resume")
        await assistant.done("set_time", action="speed", factor=2)
        await assistant.comes("real-time factor", "describe_warehouse")

    talk(conversation)


def test_a_simulation_is_started_and_stopped(talk, hub):
    async def start(assistant):
        text = await assistant.done("start_simulation", name="second", size="small", shift=False)
        assert "STARTING" in text
        return await assistant.refused("describe_warehouse")

    assert "Say which by `simulation`" in talk(start)
    until(lambda: hub.ask("GET", "/api/v1/simulations/second")[1]["state"] != "STARTING", "starts")

    async def stop(assistant):
        text = await assistant.done("describe_warehouse", simulation="second")
        assert "No shift runs" in text
        await assistant.done("stop_simulation", name="second", forget=True)
        assert "second" not in await assistant.done("list_simulations")

    talk(stop)


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_the_floor_is_a_picture(talk, transport):
    async def conversation(assistant):
        return (await assistant.client.call_tool("picture_of_floor", {})).content

    text, picture = talk(conversation, transport)
    assert text.text == f'"{NAME}": 4 robots and 24 storage units.'
    assert picture.mime_type == "image/png"
    assert base64.b64decode(picture.data).startswith(b"\x89PNG")


def test_long_replies_go_on(talk):
    async def conversation(assistant):
        text = await assistant.done("read_documentation", page="how-to/operations")
        parts = [text]
        while key := re.search(r'call more with key "(.+)"\]$', parts[-1]):
            parts.append(await assistant.done("more", key=key[1]))
        return parts

    parts = talk(conversation)
    assert len(parts) > 2
    assert len(set(parts)) == len(parts)


def test_layouts_and_pages_are_resources(talk):
    async def conversation(assistant):
        client = assistant.client
        uris = [r.uri for r in (await client.list_resources()).resources]
        assert {str(uri) for uri in uris} == {
            "warehouse://layouts",
            "warehouse://reports",
            "warehouse://docs",
        }
        small = (await client.read_resource("warehouse://layouts/small")).contents[0].text
        page = (await client.read_resource("warehouse://docs/how-to/http")).contents[0].text
        return small, page

    small, page = talk(conversation)
    assert '"stations"' in small and "api/v1/robots" in page


def test_without_permission_nothing_changes(talk, hub):
    before = hub.ask("GET", "/api/v1/simulations")[1]["simulations"]

    async def conversation(assistant):
        return [
            await assistant.refused("stop_simulation", name=NAME),
            await assistant.refused("set_time", action="pause"),
        ]

    for transport in TRANSPORTS:
        for text in talk(conversation, transport, commands=False):
            assert "--allow commands" in text and "Nothing was changed" in text
    after = hub.ask("GET", "/api/v1/simulations")[1]["simulations"]
    assert [(r["name"], r["state"]) for r in after] == [(r["name"], r["state"]) for r in before]


def test_twenty_assistants_at_once(talk, hub):
    async def ask(number):
        transport = "stdio" if number % 10 == 0 else "http"
        async with connected(hub.url, transport, commands=False) as assistant:
            return [
                await assistant.done("describe_warehouse"),
                await assistant.done("find", what=f"kiva{number % 4 + 1}"),
                await assistant.done("why_waiting", what="pick2"),
            ]

    async def all_of_them():
        return await asyncio.wait_for(asyncio.gather(*map(ask, range(20))), 110)

    replies = asyncio.run(all_of_them())
    assert len(replies) == 20
    for number, (whole, robot, station) in enumerate(replies):
        assert whole.startswith(f'"{NAME}"') and station.startswith('"pick2"')
        assert robot.startswith(f'"kiva{number % 4 + 1}"')
