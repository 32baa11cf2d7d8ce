# SPDX-License-Identifier: Apache-2.0
"""What a request for a warehouse may say, and the words with which it is refused."""

import pytest

from warehouse_layout.file.items import CAPACITY
from warehouse_layout.file.request import (
    LIMITS,
    MOST_STATIONS,
    PRESETS,
    Request,
    RequestError,
    check_stations,
    resolve,
)


def test_presets_are_those_of_the_interface():
    contract = {
        "empty": Request(0, 0, 0, 0),
        "small": Request(4, 24, 96, 2),
        "medium": Request(20, 160, 800, 4),
        "large": Request(100, 800, 4000, 10),
        "huge": Request(1000, 4000, 20000, 40),
    }
    assert contract == PRESETS


def test_counts_of_zero_mean_the_preset():
    assert resolve("medium") == PRESETS["medium"]


def test_counts_win_over_a_presets_name():
    request = resolve("medium", robots=2, items=5, shelves=3)
    assert (request.robots, request.items, request.shelves) == (2, 5, 3)


def test_explicit_counts_bring_belts():
    assert resolve("", robots=1).belts == 1
    assert resolve("", shelves=1).belts == 1
    assert resolve("", robots=100, shelves=800).belts == 8


def test_limits_themselves_are_met():
    request = resolve("", **LIMITS)
    assert (request.robots, request.belts) == (LIMITS["robots"], MOST_STATIONS)
    check_stations(MOST_STATIONS, MOST_STATIONS)


@pytest.mark.parametrize(
    "counts, words",
    [((MOST_STATIONS + 1, 0), "stations is 1001; 0 to 1000"), ((1, -1), "replenish is -1; 0 to")],
)
def test_more_stations_are_refused(counts, words):
    with pytest.raises(RequestError, match=words):
        check_stations(*counts)


@pytest.mark.parametrize(
    "counts, words",
    [
        ({}, "'yard' is not a preset.*empty, small, medium, large, huge"),
        ({"robots": -1, "shelves": 4}, "robots is -1.*negative"),
        ({"items": -2, "shelves": 4}, "items is -2.*negative"),
        ({"shelves": -3, "robots": 4}, "shelves is -3.*negative"),
        ({"robots": LIMITS["robots"] + 1}, "robots is 20001; the limit is 20000: larger fleets"),
        (
            {"shelves": LIMITS["shelves"] + 1},
            "shelves is 100001; the limit is 100000: larger floors",
        ),
        (
            {"items": LIMITS["items"] + 1, "shelves": 9},
            "items is 500001; the limit is 500000: more were never",
        ),
        ({"items": 1, "robots": 1}, "1 items, but no shelves"),
        ({"items": 2 * CAPACITY + 1, "shelves": 2}, "don't fit on 2 shelves.*so 3 shelves"),
    ],
)
def test_refused(counts, words):
    with pytest.raises(RequestError, match=words):
        resolve("yard", **counts)


def test_a_request_reads_well():
    text = "1 robot, 2 storage units, 1 item, 0 conveyor belts"
    assert str(Request(robots=1, shelves=2, items=1, belts=0)) == text
