# SPDX-License-Identifier: Apache-2.0
"""Every kind of message that is sent fits the official schemas of 2.1.0."""

import json
import math
from dataclasses import replace

import pytest
from grid_robot import Bench, drop, order, pick, row
from official_schemas import VALIDATORS, faults

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.errors import Error
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import (
    Action,
    Battery,
    Connection,
    ConnectionState,
    InstantActions,
    Visualization,
)
from warehouse_vda5050.topics import Identity, Kind

HEADERS = Headers(Identity("kiva", "7"), "2.1.0")


def check(kind, message, version="2.1.0"):
    message = replace(message, header=HEADERS.next(kind))
    assert faults(kind, codec_for(version).encode(message)) == []


@pytest.mark.parametrize("version", ["2.0.0", "2.1.0"])
def test_states_of_a_trip_with_everything_in_it(version):
    bench = Bench(units={"7": (2, 0)})
    bench.robot.extra = {"battery": Battery(33.3, True), "errors": (Error("motorError"),)}
    actions = {2: [pick()], 6: [drop(), Action("waitForTrigger", "w")]}
    bench.order("o", [*row(0, 4), (4, 1), (4, 2)], actions=actions)
    bench.instant("startPause", "a")
    bench.instant("dance", "b")
    bench.instant("stopPause", "c")
    bench.order("p", [(0, 0), (1, 1)])
    bench.tick(60)
    bench.instant("trigger", "d")
    bench.tick(5)
    bench.instant("cancelOrder", "e")
    assert len(bench.states) > 15 and bench.states[-1].order_id == "o"
    for state in bench.states:
        check(Kind.STATE, state, version)


@pytest.mark.parametrize("turns", [0.5, -0.5, 1.5, 0.4999999])
def test_a_heading_is_at_most_half_a_turn(turns):
    bench = Bench()
    bench.robot.extra = {"yaw": turns * math.tau}
    assert abs(bench.tick().position.theta) <= math.pi


def test_factsheet():
    check(Kind.FACTSHEET, Bench().vehicle.take_factsheet())


def test_connection_and_visualization():
    for state in ConnectionState:
        check(Kind.CONNECTION, Connection(state))
    state = Bench().tick()
    check(Kind.VISUALIZATION, Visualization(state.position, state.velocity))


def test_instant_actions_under_both_names_where_peers_differ():
    message = replace(
        InstantActions((Action("stateRequest", "a"),)), header=HEADERS.next(Kind.ORDER)
    )
    text = json.loads(codec_for("2.0.0").encode(message))
    assert text["instantActions"] == text["actions"] != []
    assert "instantActions" not in json.loads(codec_for("2.1.0").encode(message))


def test_what_a_master_sends():
    check(Kind.ORDER, order("o", row(0, 3), released=2, actions={1: [pick()]}))
    check(Kind.INSTANT_ACTIONS, InstantActions((pick(),)))


def test_the_schemas_refuse_what_is_wrong():
    value = json.loads(codec_for().encode(Bench().tick()))
    assert not VALIDATORS[Kind.STATE].is_valid({**value, "driving": "yes"})
