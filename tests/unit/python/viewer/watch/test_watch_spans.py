# SPDX-License-Identifier: Apache-2.0
"""States of the last hour are kept in bounded memory, and a reader gets what is new to it."""

import json

import numpy as np

from warehouse_viewer.watch.span_log import GONE, SpanLog


def read(data):
    """(head, {(row, time): state}) of what SpanLog.encode() returned."""
    length = int(np.frombuffer(data, "<u4", 1)[0])
    head, n = json.loads(data[4 : 4 + length]), 0
    at, moments = 4 + length, head["moments"]
    times = np.frombuffer(data, "<f4", moments, at)
    counts = np.frombuffer(data, "<u4", moments, at + 4 * moments)
    changes = np.frombuffer(data, "<u4", -1, at + 8 * moments)
    assert counts.sum() == len(changes)
    states = {}
    for time, count in zip(times, counts):
        for change in changes[n : n + count]:
            states[int(change >> 3), round(head["origin"] + float(time), 3)] = int(change & 7)
        n += count
    return head, states


def log_of(*updates, **options):
    log = SpanLog(**options)
    for time, kind, names, states in updates:
        log.update(time, kind, names, np.array(states, np.uint8))
    return log


def test_changes_alone_are_kept():
    log = log_of(
        (10, "robot", ["kiva1", "kiva2"], [0, 1]),
        (11, "robot", ["kiva1", "kiva2"], [0, 1]),
        (12, "robot", ["kiva1", "kiva2"], [0, 2]),
        (12, "station", ["pick1"], [2]),
    )
    head, states = read(log.encode())
    assert head["rows"] == [["robot", "kiva1"], ["robot", "kiva2"], ["station", "pick1"]]
    assert states == {(0, 10): 0, (1, 10): 1, (1, 12): 2, (2, 12): 2}
    assert (head["base"], head["now"]) == ([GONE] * 3, 12)


def test_a_reader_gets_what_is_new_to_it():
    log = log_of((10, "robot", ["kiva1"], [0]), (11, "robot", ["kiva1"], [1]))
    first, _ = read(log.encode())
    log.update(12, "robot", ["kiva1", "kiva2"], np.array([2, 0], np.uint8))
    head, states = read(log.encode(first["epoch"], first["last"], 1))
    assert not head["is_whole"] and head["rows"] == [["robot", "kiva2"]]
    assert states == {(0, 12): 2, (1, 12): 0}
    assert read(log.encode(head["epoch"], head["last"], 2))[1] == {}


def test_who_comes_from_another_run_gets_all():
    log = log_of((10, "robot", ["kiva1"], [0]))
    epoch = log.epoch
    log.update(3, "robot", ["kiva1"], np.array([1], np.uint8))  # the world was reset
    head, states = read(log.encode(epoch, 1, 1))
    assert head["is_whole"] and head["begin"] == 3
    assert states == {(0, 3): 1}


def test_what_is_older_than_the_span_becomes_the_state_at_its_beginning():
    log = log_of(*((t, "robot", ["kiva1"], [t % 3]) for t in range(10)), span=4.0)
    head, states = read(log.encode())
    assert head["begin"] == 5 and head["base"] == [4 % 3]
    assert sorted(time for _, time in states) == [5, 6, 7, 8, 9]


def test_there_are_never_more_changes_than_there_is_room_for():
    names = [f"kiva{i}" for i in range(10)]
    log = log_of(*((t, "robot", names, [t % 2] * 10) for t in range(100)), most=50)
    head, states = read(log.encode())
    assert len(states) == 50 and head["begin"] == 94
    assert head["base"] == [94 % 2] * 10


def test_a_robot_that_is_gone_is_unknown_from_then_on():
    log = log_of((1, "robot", ["kiva1", "kiva2"], [1, 1]), (2, "robot", ["kiva2"], [1]))
    assert read(log.encode())[1] == {(0, 1): 1, (1, 1): 1, (0, 2): GONE}
    log.update(3, "robot", ["kiva2", "kiva1"], np.array([1, 2], np.uint8))
    assert read(log.encode())[1][0, 3] == 2
