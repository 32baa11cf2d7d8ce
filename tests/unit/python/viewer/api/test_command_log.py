# SPDX-License-Identifier: Apache-2.0
"""Each request that changes something is kept with who sent it and what was answered."""

import asyncio

import pytest

from warehouse_viewer.api.command_log import CommandLog, LogsCommands


def send(log, method="POST", path="/api/v1/robots/3/mode", body=b"", headers=(), status=200):
    async def app(scope, receive, answer):
        assert (await receive())["body"] == body
        await answer({"type": "http.response.start", "status": status})

    async def receive():
        return {"type": "http.request", "body": body}

    async def answer(message):
        pass

    scope = {"type": "http", "method": method, "path": path, "headers": [*headers]}
    scope["client"] = ("10.0.0.7", 4711)
    asyncio.run(LogsCommands(app, log)(scope, receive, answer))


@pytest.fixture
def log():
    return CommandLog(lambda: 12.3456)


def test_who_and_what_and_its_answer(log):
    send(log, body=b'{"mode": "MANUAL", "by": "Ann"}', status=409)
    (row,) = log.rows()
    assert (row["by"], row["method"], row["path"]) == ("Ann", "POST", "/robots/3/mode")
    assert (row["status"], row["address"], row["time"]) == (409, "10.0.0.7", 12.346)
    assert row["body"] == '{"mode": "MANUAL", "by": "Ann"}' and row["wall"].endswith("+00:00")


def test_the_header_names_who_sends_no_body(log):
    send(log, "DELETE", headers=[(b"x-person", b"J%C3%BCrgen%0A")])
    assert log.rows()[0]["by"] == "Jürgen"
    assert log.rows("Jürgen") and not log.rows("Ann")


def test_what_only_reads_is_not_kept(log):
    send(log, "GET")
    send(log, path="/layout/check")
    assert log.rows() == []


def test_a_spreadsheet_takes_nothing_for_a_formula(log):
    send(log, body=b'{"by": "=1+1"}')
    send(log, body=b"[1]")
    head, first, second = log.csv().splitlines()
    assert head == "id,time,wall,by,address,method,path,body,status"
    assert ",=1+1," not in first and second.startswith("2,")
