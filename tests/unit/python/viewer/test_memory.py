# SPDX-License-Identifier: Apache-2.0
"""What the viewer remembers takes its memory at the beginning, however long a shift lasts."""

import itertools
import tracemalloc

import pytest

from warehouse_viewer.api.command_log import KEPT as COMMANDS
from warehouse_viewer.api.command_log import CommandLog
from warehouse_viewer.page.journal import KEPT as EVENTS
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.watch.sentence_log import KEPT as SENTENCES
from warehouse_viewer.watch.sentence_log import SentenceLog

ROBOTS = 100
TOLERANCE = 64_000  # names, and which events each model has [bytes]


@pytest.fixture
def grown():
    """Returns how much memory Python has taken since the first call [bytes]."""
    tracemalloc.start()
    begin = []

    def measure():
        begin.append(tracemalloc.get_traced_memory()[0])
        return begin[-1] - begin[0]

    yield measure
    tracemalloc.stop()


def event(number):
    return {
        "kind": "BLOCKED",
        "time": number / 10,
        "command": 10**6 + number,
        "model": f"kiva{number % ROBOTS}",
        "other": "",
        "text": f"obstacle {number} is in the way",
    }


def test_events(grown):
    journal = Journal()
    journal.expect(ROBOTS)
    grown()
    for number in range(EVENTS + 20 * ROBOTS):
        journal.add(event(number))
    assert grown() < TOLERANCE
    assert len(journal.since(0)) == EVENTS


def test_what_two_models_share_is_kept_once_and_then_forgotten(grown):
    journal = Journal(kept=1)
    journal.expect(ROBOTS)
    grown()
    for number in range(40 * ROBOTS):
        journal.add(event(number) | {"other": f"kiva{(number + 7) % ROBOTS}"})
    assert grown() < TOLERANCE
    last = journal.since(0, "kiva3")
    numbers = [e["id"] - 1 for e in last]
    assert len(last) == 10 and all(n % ROBOTS in (3, (3 - 7) % ROBOTS) for n in numbers)
    assert [e["text"] for e in last] == [event(n)["text"] for n in numbers]


def test_commands(grown):
    log = CommandLog(lambda: 12.0)
    grown()
    for number in range(2 * COMMANDS):
        body = f'{{"x": {number}, "y": -13, "kiva_id": 458}}'
        log.add(by="/program", address="", method="TOPIC", path="/move_to", body=body, status=0)
    assert grown() < TOLERANCE
    assert len(log.rows()) == COMMANDS and log.rows(limit=1)[0]["body"] == body


def test_sentences(grown):
    log = SentenceLog()
    log.expect(ROBOTS)
    grown()
    for time, robot in itertools.product(range(3 * SENTENCES), range(ROBOTS)):
        log.note(f"kiva{robot}", time, f"kiva{robot} waits for kiva{time % 2}")
    assert grown() < TOLERANCE
    assert log.at("kiva5", 3 * SENTENCES - 1.5) == "kiva5 waits for kiva0"


def test_a_sentence_is_found_as_long_as_it_is_kept():
    log = SentenceLog()
    log.note("kiva1", 0.0, "kiva1 is idle")
    log.note("kiva1", 5.0, "")
    assert (log.at("kiva1", 4.9), log.at("kiva1", 5.0), log.at("kiva2", 5.0)) == (
        "kiva1 is idle",
        "",
        "",
    )
    for time in range(10, 10 + SENTENCES):
        log.note("kiva1", time, f"kiva1 waits for unit {time}")
    assert log.at("kiva1", 9.0) == ""
    assert log.at("kiva1", 10.0) == "kiva1 waits for unit 10"
    assert log.since("kiva1", "unit 69") == 69.0 and log.since("kiva1", "unit 68") is None


def test_more_names_come_than_were_expected():
    log = SentenceLog()
    log.expect(1)
    for number in range(40):
        log.note(f"kiva{number}", number, f"kiva{number} is idle")
    assert [log.at(f"kiva{n}", 50.0) for n in (0, 39)] == ["kiva0 is idle", "kiva39 is idle"]
    assert log.names == {f"kiva{n}" for n in range(40)}
