# SPDX-License-Identifier: Apache-2.0
"""Alarms reach other programs by POST, again where need be, and hold nothing up."""

import json
import threading
import time
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from warehouse_viewer.watch import webhooks
from warehouse_viewer.watch.alarm_book import AlarmBook, Trouble
from warehouse_viewer.watch.causes import remedies

PATIENCE = 10.0  # [s]


@contextmanager
def receiver(*answers):
    """(address, received): a server that gives these answers, then 200."""
    received, left = [], [*answers]

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self):  # noqa: N802 (http.server's name)
            length = int(self.headers["content-length"])
            received.append(json.loads(self.rfile.read(length)))
            status = left.pop(0) if left else 200
            self.send_response(status)
            if status == 302:
                self.send_header("location", "/elsewhere")
            self.end_headers()

        def log_message(self, *_):
            pass

    server = HTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/hook", received
    finally:
        server.shutdown()
        server.server_close()


def until(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def alarm():
    book = AlarmBook(lambda trouble: remedies(trouble, {}))
    book.update(100.0, [Trouble("ROBOT_BROKEN", "kiva3", "kiva3 is broken (drive)", 90.0)])
    return book


def test_a_message_says_cause_remedy_and_where_to_look():
    book = alarm()
    (begun,), _ = book.news()
    content = webhooks.message("begin", begun, "http://here:8080")
    assert content["event"] == "begin" and content["subject"] == "kiva3"
    assert content["cause"] == "kiva3 is broken (drive)"
    assert content["remedy"].startswith("Take it out of service")
    assert "Repair" in content["remedies"]
    assert content["link"] == "http://here:8080/#t=90.0&see=kiva3"
    book.update(130.0, [])
    _, (ended,) = book.news()
    content = webhooks.message("end", ended, "")
    assert (content["event"], content["duration"]) == ("end", 40.0)


def test_it_is_sent_again_until_it_is_taken():
    pauses = []
    with receiver(500, 503) as (url, received):
        webhooks.Webhooks([url], (1.0, 2.0, 4.0), pauses.append).post({"id": 1})
        until(lambda: len(received) == 3)
    assert pauses == [1.0, 2.0] and received == [{"id": 1}] * 3


@pytest.mark.parametrize("status", [302, 404])
def test_an_answer_that_stays_the_same_is_asked_for_once(status, caplog):
    with receiver(status) as (url, received):
        hooks = webhooks.Webhooks([url], () if status == 302 else (1.0,), lambda _: None)
        hooks.post({"id": 7})
        hooks.post({"id": 8})
        until(lambda: len(received) == 2)
    assert [row["id"] for row in received] == [7, 8]
    assert f"alarm 7 was not taken: {status}" in caplog.text
    assert "/hook" not in caplog.text  # it may be a secret


def test_one_that_is_dead_delays_no_other_and_nobody_waits():
    held = threading.Event()
    with receiver() as (url, received):
        hooks = webhooks.Webhooks(["http://127.0.0.1:9/", url], (1.0,), lambda _: held.wait())
        begin = time.monotonic()
        for number in range(webhooks.KEPT + 50):
            hooks.post({"id": number})
        assert time.monotonic() - begin < 2
        until(lambda: received)  # a thread that waits ends with the process


@pytest.mark.parametrize(
    "text", ["ftp://x/", "example.org/hook", "http://", "http://x:99999/", "http://x:port/"]
)
def test_a_wrong_address_is_refused_by_its_name(text):
    with pytest.raises(ValueError, match="an address http://… or https://… was expected") as error:
        webhooks.read(f"https://right.example/a, {text}")
    assert f"'{text}'" in str(error.value) and "right" not in str(error.value)


def test_several_come_with_commas_or_spaces_and_each_once():
    assert webhooks.read("http://a/ http://b/,http://a/") == ["http://a/", "http://b/"]
    assert webhooks.read("") == []
