# SPDX-License-Identifier: Apache-2.0
"""Events as lines for a person."""

import io
from types import SimpleNamespace

import pytest
import rospy
from std_msgs.msg import Header

from warehouse_msgs.msg import Event
from warehouse_sim import event_text


def event(kind=Event.DONE, model="kiva2", other="", text="", command=0):
    header = Header(stamp=rospy.Time(12.5))
    return SimpleNamespace(**locals())


@pytest.mark.parametrize(
    ("happened", "line"),
    [
        (
            event(text="stands at (2, 1)", command=17),
            "    12.500 s  kiva2          DONE      #17    stands at (2, 1)",
        ),
        (
            event(Event.LIFTED, other="storage_unit3", command=4),
            "    12.500 s  kiva2          LIFTED    #4     storage_unit3",
        ),
        (
            event(Event.COLLISION, other="wall1", text="at 0.3 m/s"),
            "    12.500 s  kiva2          COLLISION        wall1: at 0.3 m/s",
        ),
        (event(Event.SPAWNED), "    12.500 s  kiva2          SPAWNED"),
    ],
)
def test_a_line_tells_when_who_what_and_of_which_command(happened, line):
    assert event_text.line(happened) == line


def test_colours_change_nothing_else():
    coloured = event_text.line(event(text="there"), coloured=True)
    assert "\033[32mDONE     \033[0m" in coloured
    assert coloured.replace("\033[32m", "").replace("\033[0m", "") == event_text.line(
        event(text="there")
    )


def test_a_terminal_shows_what_it_would_obey():
    evil = event(model="\033[2Jbox", text="a\nb\x9b1m")
    assert event_text.line(evil) == "    12.500 s  ?[2Jbox        DONE             a?b?1m"


def test_filters():
    touched = event(Event.COLLISION, model="kiva1", other="kiva2")
    assert event_text.fits(touched)
    assert event_text.fits(touched, ["kiva2"], ["collision", "done"])
    assert not event_text.fits(touched, ["kiva3"])
    assert not event_text.fits(touched, ["kiva1"], ["done"])


def test_colours_are_for_terminals():
    terminal, pipe = SimpleNamespace(isatty=lambda: True), io.StringIO()
    assert event_text.wants_colour("auto", terminal, {"TERM": "xterm"})
    assert not event_text.wants_colour("auto", terminal, {"TERM": "xterm", "NO_COLOR": "1"})
    assert not event_text.wants_colour("auto", terminal, {"TERM": "dumb"})
    assert not event_text.wants_colour("auto", pipe, {"TERM": "xterm"})
    assert event_text.wants_colour("always", pipe, {})
    assert not event_text.wants_colour("never", terminal, {})


def test_many_models_that_come_or_go_are_one_line():
    lines = event_text.EventLines()
    gone = [f"kiva{i}" for i in range(1, 5)] + [f"item{i}" for i in range(1, 97)]
    come = [*gone, "conveyor_belt1", "floor_markings1"]
    assert [lines.take(event(Event.DELETED, name)) for name in gone] == [[]] * 100
    first = lines.take(event(Event.SPAWNED, come[0]))
    assert first == ["    12.500 s  100 models     DELETED          4 robots, 96 items"]
    assert not any(lines.take(event(Event.SPAWNED, name)) for name in come[1:])
    summed, done = lines.take(event())
    assert summed.endswith(
        "102 models     SPAWNED          4 robots, 96 items, 1 conveyor belt, 1 other model"
    )
    assert done.endswith("DONE")
    assert lines.rest() == []


def test_few_are_told_one_by_one():
    lines = event_text.EventLines()
    for name in ("box1", "box2", "box3"):
        assert lines.take(event(Event.SPAWNED, name)) == []
    assert [line.split()[2] for line in lines.rest()] == ["box1", "box2", "box3"]


def test_each_is_told_where_that_is_asked_for():
    lines = event_text.EventLines(each=True)
    assert [len(lines.take(event(Event.DELETED, f"item{i}"))) for i in range(9)] == [1] * 9
