# SPDX-License-Identifier: Apache-2.0
"""Paths with speed limits (/follow_limited) to vehicles behind a broker."""

import math

import pytest
from test_abilities import PLAIN, bench_of, follow, requiring
from test_master_vehicle import WAY, Bench

from warehouse_vda5050.master import journey
from warehouse_vda5050.master.commands import Follow, RefusedError
from warehouse_vda5050.model import Factsheet

SPEEDS = ("order.edges.maxSpeed", "SUPPORTED", "")


def limited(bench, path):
    """Sends a path; returns the demands of the order's edges."""
    bench.vehicle.command(path)
    return [dict(edge.demands) for edge in bench.order().edges]


@pytest.mark.parametrize("sheet", [None, Factsheet(parameters=(SPEEDS,))])
def test_limits_of_a_path_are_those_of_the_edges(sheet):
    path = Follow(9, 0, WAY, 4, (math.inf, math.inf, 0.3, 2.0))
    bench = bench_of(sheet) if sheet else Bench(PLAIN)
    assert limited(bench, path) == [{}, {"maxSpeed": 0.3}, {"maxSpeed": 2.0}]


def test_a_limit_does_not_raise_what_the_vehicle_requires():
    bench = bench_of(requiring("order.edges.maxSpeed", max_speed=0.7))
    path = Follow(9, 0, WAY, 4, (math.inf, 0.3, 0.9, math.inf))
    assert [row["maxSpeed"] for row in limited(bench, path)] == [0.3, 0.7, 0.7]


def test_limits_are_refused_where_the_factsheet_does_not_name_them():
    bench = bench_of(Factsheet())
    bench.vehicle.take_events()
    bench.vehicle.command(Follow(9, 0, WAY, 4, (math.inf, 0.3, 0.3, 0.3)))
    (event,) = bench.vehicle.take_events()
    assert event.kind.value == "REFUSED" and "does not name maxSpeed" in event.text
    assert follow(bench).kind.value == "ACCEPTED"


def test_points_that_come_again_without_limits_keep_theirs():
    way = journey.begin(Follow(9, 0, WAY, 2, (math.inf, 0.5, 0.3, 0.2)), "o", 0.0)
    way.change(Follow(9, 2, WAY[2:], 3))
    assert way.speeds == [math.inf, 0.5, 0.3, 0.2]
    way.change(Follow(9, 3, ((9.0, 9.0),), 3))
    assert way.speeds == [math.inf, 0.5, 0.3, math.inf]
    way.change(Follow(9, 3, WAY[3:], 3, (0.1,)))
    assert way.speeds == [math.inf, 0.5, 0.3, 0.1] and way.is_changed
    with pytest.raises(RefusedError, match="can't be replaced"):
        way.change(Follow(9, 1, WAY[1:], 3, (0.1, 0.1, 0.1)))
