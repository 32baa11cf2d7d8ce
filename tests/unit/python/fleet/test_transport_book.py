# SPDX-License-Identifier: Apache-2.0
"""The book of transports: which step follows which, and what it counts."""

import itertools
from types import SimpleNamespace

import pytest

from warehouse_fleet.transports.transport_book import (
    FETCHED,
    FOLLOWS,
    INBOUND,
    Step,
    TransportBook,
)

PICK1 = "pick1"
# One way from OPEN to each step.
WAYS = {
    Step.FETCHING: (),
    Step.READY: (Step.READY,),
    Step.LIFTING: (Step.READY, Step.LIFTING),
    Step.BRINGING: (Step.READY, Step.LIFTING, Step.BRINGING),
    Step.WAITING: (Step.READY, Step.LIFTING, Step.BRINGING, Step.WAITING),
    Step.STORING: (Step.READY, Step.LIFTING, Step.STORING),
    Step.DROPPING: (Step.READY, Step.LIFTING, Step.STORING, Step.DROPPING),
}


def book_at(step):
    """Returns a book, and its only transport, which is at a step."""
    book = TransportBook([11, 12], SimpleNamespace(time=3.0), stations=[PICK1])
    transport = book.add(7, PICK1, 0)
    book.enqueue(transport)
    book.assign(transport, 1)
    for each in WAYS[step]:
        book.go_on(transport, each)
    return book, transport


def check_counts(book):
    steps = [transport.step for transport in book]
    assert book.fetched[PICK1] == sum(step in FETCHED for step in steps)
    assert book.inbound[PICK1] == sum(step in INBOUND for step in steps)
    assert book.waiting(PICK1) == book.fetched[PICK1] + book.inbound[PICK1]
    for robot, transport in book.of_robot.items():
        assert book.step_of[robot] == transport.step


@pytest.mark.parametrize(("step", "after"), itertools.product(WAYS, Step))
def test_a_step_follows_as_the_table_says(step, after):
    book, transport = book_at(step)
    check_counts(book)
    if after in FOLLOWS[step]:
        book.go_on(transport, after)
        assert (transport.step, transport.since) == (after, 3.0)
    else:
        text = f"transport 1: {after.name} can't follow {step.name}"
        with pytest.raises(ValueError, match=text):
            book.go_on(transport, after)
        assert transport.step == step
    check_counts(book)


@pytest.mark.parametrize("step", WAYS)
def test_a_transport_that_is_removed_is_counted_no_more(step):
    book, transport = book_at(step)
    book.remove(transport)
    assert book.waiting(PICK1) == 0 and list(book) == [] and book.assigned() == []
    assert (book.step_of == -1).all()


def test_a_transport_that_is_taken_from_its_robot_is_open_again():
    book, transport = book_at(Step.READY)
    book.unassign(transport)
    assert book.open == [transport] and book.assigned() == []
    check_counts(book)
