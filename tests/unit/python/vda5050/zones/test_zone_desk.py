# SPDX-License-Identifier: Apache-2.0
"""The master's zones: closed zones of the floor become zone sets, and requests are answered."""

import math

import pytest
from grid_robot import GRID, is_over, row
from test_zones import ZoneBench

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.frame import Frame
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.zone_desk import ClosedArea
from warehouse_vda5050.model import (
    Factsheet,
    InstantActions,
    OperatingMode,
    Responses,
    ZoneSet,
)
from warehouse_vda5050.topics import Identity, Kind
from warehouse_vda5050.zones.zone import ZoneType

WHO = Identity("acme", "1")
CODEC = codec_for("3.0.0")


def closed(x0, y0, x1, y1, *inside):
    """Returns the area of cells, closed."""
    return ClosedArea(3, x0 - 0.5, y0 - 0.5, x1 + 0.5, y1 + 0.5, frozenset(inside))


class Sides:
    """A master with one vehicle; messages go by JSON of 3.0.0, each second."""

    def __init__(self, cell=(0, 0), zones=True, frame=None):
        self.bench = ZoneBench(cell=cell)
        self.master = RemoteFleet([RemoteRobot(1, WHO, frame or Frame())], GRID, "run", zones)
        self.headers = Headers(WHO, "3.0.0", lambda: 1.7e9 + self.bench.now)
        self.sent = []
        self.master.take(WHO, self.bench.vehicle.take_factsheet(), 0.0)
        self.step()

    def step(self, count=1):
        """Goes on by some seconds; returns the vehicle's state."""
        vehicle = self.bench.vehicle
        for _ in range(count):
            for _, message in self.master.messages(self.bench.now):
                self.sent.append(message)
                kind = {ZoneSet: Kind.ZONE_SET, Responses: Kind.RESPONSES}.get(type(message))
                kind = kind or Kind.INSTANT_ACTIONS
                decoded = CODEC.decode(kind, CODEC.encode(message)).message
                if kind is Kind.ZONE_SET:
                    vehicle.on_zone_set(decoded)
                elif kind is Kind.RESPONSES:
                    vehicle.on_responses(decoded)
                else:
                    # The orders are of this test, and the master would cancel them as foreign.
                    actions = tuple(a for a in decoded.actions if a.type != "cancelOrder")
                    vehicle.on_instant_actions(InstantActions(actions), self.bench.now)
            state = self.bench.tick()
            payload = CODEC.encode(
                vehicle.state().__class__(
                    **{**vars(state), "header": self.headers.next(Kind.STATE)}
                )
            )
            self.master.take(WHO, CODEC.decode(Kind.STATE, payload).message, self.bench.now)
        return state

    def until(self, condition, seconds=60):
        for _ in range(seconds):
            state = self.step()
            if condition(state):
                return state
        raise AssertionError(f"still {state}")

    @property
    def zones(self):
        """The zones that hold for the vehicle."""
        return self.bench.vehicle.zones.store.enabled


def holds(count):
    return lambda state: len(state.zone_sets) == 1 and state.zone_sets[0].enabled


def test_a_closed_zone_is_blocked_for_a_vehicle_outside_until_it_is_opened():
    sides = Sides()
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.until(holds(1))
    (zone,) = sides.zones.zones
    assert zone.type is ZoneType.BLOCKED and zone.id == "closed3"
    assert not sides.bench.order("o", row(0, 6))
    assert sides.bench.order("beside", row(0, 2))
    sides.until(is_over)
    sides.master.close_zones([])
    sides.until(lambda s: sides.zones and not sides.zones.zones and len(s.zone_sets) == 1)
    assert sides.bench.order("p", row(2, 6))


def test_a_vehicle_that_turns_in_the_next_cell_is_not_in_the_zone():
    sides = Sides(cell=(2, 0))
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.until(holds(1))
    assert sides.bench.order("o", [(2, 0), (1, 0), (2, 0), (2, 1), (2, 2)])
    assert sides.until(is_over).last_node == "c2_2"


def test_a_vehicle_in_a_closed_zone_is_released_to_leave_it():
    sides = Sides(cell=(3, 0))
    sides.master.close_zones([closed(3, 0, 4, 2, 1)])
    sides.until(holds(1))
    assert sides.zones.zones[0].type is ZoneType.RELEASE
    assert sides.bench.order("o", row(3, 6))
    state = sides.until(is_over)
    assert state.last_node == "c6_0" and not state.errors
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.until(lambda s: sides.zones.zones[0].type is ZoneType.BLOCKED)


def test_a_vehicle_that_knows_release_alone_waits_while_the_zone_is_closed():
    sides = Sides()
    sides.master.take(WHO, Factsheet(zone_types=("RELEASE",)), 0.0)
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.until(holds(1))
    assert sides.bench.order("o", row(0, 6))
    state = sides.step(20)
    assert state.last_node == "c2_0" and state.zone_requests[0].status.value == "REQUESTED"
    sides.master.close_zones([])
    assert sides.until(is_over).last_node == "c6_0"


@pytest.mark.parametrize("types", [(), ("SPEED_LIMIT",)])
def test_a_vehicle_whose_factsheet_has_no_such_zones_is_sent_none(types):
    sides = Sides()
    sides.master.take(WHO, Factsheet(zone_types=types), 0.0)
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.step(5)
    assert not [message for message in sides.sent if isinstance(message, ZoneSet)]


def test_versions_without_zones_are_sent_none():
    sides = Sides(zones=False)
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.step(5)
    assert not sides.bench.vehicle.state().zone_sets


def test_zones_lie_where_the_floor_is_in_the_map_of_the_vehicle():
    sides = Sides(frame=Frame(10.0, 5.0, math.pi / 2))
    sides.master.close_zones([closed(3, 0, 4, 2)])
    sides.until(holds(1))
    xs, ys = zip(*sides.zones.zones[0].vertices)
    assert (min(xs), max(xs)) == pytest.approx((-5.414, -2.586), abs=0.01)
    assert (min(ys), max(ys)) == pytest.approx((5.586, 7.414), abs=0.01)


def test_a_set_of_an_earlier_run_is_replaced():
    sides = Sides()
    sides.bench.vehicle.on_zone_set(ZoneSet("warehouse-old-1", "warehouse", ()))
    sides.bench.instant("enableZoneSet", "e", zoneSetId="warehouse-old-1")
    sides.until(lambda s: [z.id for z in s.zone_sets] == ["warehouse-run-1-1"])


def test_sets_of_two_vehicles_have_ids_of_their_own():
    """6.4.2: the content of a zone set with a unique zoneSetId shall not change."""
    robots = [RemoteRobot(k, Identity("acme", str(k)), Frame()) for k in (1, 2)]
    master = RemoteFleet(robots, GRID, "run", zones=True)
    for robot in robots:
        bench = ZoneBench()
        master.take(robot.identity, bench.vehicle.take_factsheet(), 0.0)
        master.take(robot.identity, bench.tick(), 0.0)
    master.close_zones([closed(4, 4, 5, 5, 2)])
    sets = [m for _, m in master.messages(1.0) if isinstance(m, ZoneSet)]
    assert len({s.id for s in sets}) == len(sets) == 2


def test_a_vehicle_in_manual_is_sent_zones_and_no_actions():
    """6.6.6: fleet control shall not send actions; AUTOMATIC again, the set is enabled."""
    sides = Sides()
    sides.bench.robot.extra["mode"] = OperatingMode.MANUAL
    sides.step(2)
    sides.sent.clear()
    sides.master.close_zones([closed(4, 4, 5, 5)])
    sides.step(20)
    assert {type(message) for message in sides.sent} == {ZoneSet}
    sides.bench.robot.extra.clear()
    sides.until(lambda s: [z.enabled for z in s.zone_sets] == [True])


def test_zones_that_are_refused_are_reported_once():
    sides = Sides()
    sides.master.take(WHO, Factsheet(zone_types=("BLOCKED",), max_zones=1), 0.0)
    sides.master.close_zones([closed(3, 0, 4, 2), closed(6, 0, 7, 2)])
    sides.step(5)
    (event,) = sides.master.take_events()
    assert event.text == "its zones are not sent: 2 are closed, and 1 are its most"


def test_a_vehicle_that_forgets_its_zones_again_and_again_gets_them_soon_and_without_an_alarm():
    sides = Sides()
    sides.master.close_zones([closed(3, 0, 4, 2)])
    for _ in range(8):
        sides.until(holds(1))
        store = sides.bench.vehicle.zones.store
        store.enabled = None
        store._sets.clear()
        sides.step(2)
        assert store.states(), "the set is there again within 2 s"
    assert not sides.master.take_events()


def test_a_set_that_is_never_answered_is_sent_less_and_less_and_one_alarm_says_so():
    sides = Sides()
    sides.bench.vehicle.on_zone_set = lambda _zones: None
    sides.master.close_zones([closed(3, 0, 4, 2)])
    texts = []
    for _ in range(600):
        sides.step()
        texts += [event.text for event in sides.master.take_events()]
    sent = [message for message in sides.sent if isinstance(message, ZoneSet)]
    assert 10 <= len(sent) <= 16  # 2, 4, 8, 16, 32 s, then once a minute
    (alarm,) = [text for text in texts if "not answered" in text]
    assert "was sent 5 times, and no state has it" in alarm
    del sides.bench.vehicle.on_zone_set
    sides.until(holds(1), 70)
