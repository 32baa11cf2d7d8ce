# SPDX-License-Identifier: Apache-2.0
"""Zone sets of 3.0.0: what a vehicle takes, and how it keeps to them; sections are its own."""

import json

import pytest
from grid_robot import Bench, is_over, order, row
from official_schemas import validator_of

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.model import Responses, ZoneSet
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.zones.outline import Box, contains, overlaps, passes
from warehouse_vda5050.zones.zone import Grant, Response, Zone, ZoneType

CODEC = codec_for("3.0.0")
ALARM = ("BLOCKED_ZONE_VIOLATION", "CRITICAL")


def area(x0, y0, x1, y1):
    return (x0, y0), (x1, y0), (x1, y1), (x0, y1)


def cell(x, y):
    """Returns the inner part of a cell."""
    return area(x - 0.3, y - 0.3, x + 0.3, y + 0.3)


class ZoneBench(Bench):
    """A vehicle that takes zones, and a wall clock that goes with the bench's."""

    def __init__(self, *zones, **kwargs):
        super().__init__(zones=True, **kwargs)
        self.vehicle.zones.clock = lambda: self.now
        self.sets = 0
        if zones:
            self.hold(*zones)

    def hold(self, *zones):
        """Sends zones and enables them."""
        self.sets += 1
        name = f"z{self.sets}"
        self.vehicle.on_zone_set(ZoneSet(name, "warehouse", zones))
        return self.instant("enableZoneSet", f"enable{self.sets}", zoneSetId=name)

    def answer(self, grant, expiry=None):
        """Answers the one request."""
        (request,) = self.vehicle.state().zone_requests
        responses = Responses((Response(request.id, grant, expiry),))
        self.vehicle.on_responses(responses)
        return self.tick()


def blocked(*place):
    return Zone("b", ZoneType.BLOCKED, cell(*place))


def release(x, loss="STOP", y=0):
    return Zone("r", ZoneType.RELEASE, cell(x, y), word=loss)


def types(state):
    return [(e["errorType"], e["errorLevel"]) for e in CODEC.to_json(state)["errors"]]


def references(state):
    return [pair for error in state.errors for pair in error.references]


def accepts(bench, *zones, map_id="warehouse", name="new"):
    """Returns whether a zone set is taken over."""
    bench.vehicle.on_zone_set(ZoneSet(name, map_id, zones))
    return name in [zones.id for zones in bench.tick().zone_sets]


# --- zone sets


def test_a_newly_added_zone_set_is_disabled_and_enabled_by_enable_zone_set():
    """6.4.2."""
    bench = ZoneBench()
    bench.vehicle.on_zone_set(ZoneSet("a", "warehouse", ()))
    bench.vehicle.on_zone_set(ZoneSet("b", "warehouse", ()))
    assert [s.enabled for s in bench.tick().zone_sets] == [False, False]
    bench.instant("enableZoneSet", "i1", zoneSetId="a")
    state = bench.instant("enableZoneSet", "i2", zoneSetId="b")
    assert [s.enabled for s in state.zone_sets] == [False, True]
    state = bench.instant("deleteZoneSet", "i3", zoneSetId="a")
    assert [s.id for s in state.zone_sets] == ["b"]
    assert not state.errors


@pytest.mark.parametrize("action", ["enableZoneSet", "deleteZoneSet"])
def test_a_zone_set_that_was_not_sent_is_not_known(action):
    state = ZoneBench().instant(action, zoneSetId="nowhere")
    assert state.actions[0].status.value == "FAILED"
    assert types(state) == [("INVALID_INSTANT_ACTION", "WARNING")]


def test_an_enabled_zone_set_is_not_deleted():
    state = ZoneBench(blocked(5, 0)).instant("deleteZoneSet", "i9", zoneSetId="z1")
    assert [s.id for s in state.zone_sets] == ["z1"]
    assert "is enabled" in state.errors[0].description


def test_a_zone_set_with_a_known_id_is_not_taken_over():
    """6.4.2: DUPLICATE_ZONE_SET."""
    bench = ZoneBench(blocked(5, 0))
    bench.vehicle.on_zone_set(ZoneSet("z1", "warehouse", ()))
    assert types(bench.tick()) == [("DUPLICATE_ZONE_SET", "WARNING")]
    assert not bench.order("o", row(0, 6))


@pytest.mark.parametrize(
    "type,number,word",
    [
        (ZoneType.SPEED_LIMIT, 0.5, ""),
        (ZoneType.PENALTY, 0.5, ""),
        (ZoneType.PRIORITY, 0.5, ""),
        (ZoneType.COORDINATED_REPLANNING, 0.0, ""),
        (ZoneType.ACTION, 0.0, ""),
        (ZoneType.LINE_GUIDED, 0.0, ""),
        (ZoneType.RELEASE, 0.0, "EVACUATE"),
    ],
)
def test_zones_that_the_factsheet_does_not_name_are_refused_by_name(type, number, word):
    bench = ZoneBench()
    assert not accepts(bench, Zone("z", type, cell(3, 0), number, word))
    state = bench.vehicle.state()
    assert types(state) == [("UNSUPPORTED_PARAMETER", "CRITICAL")]
    assert (word or type.value) in state.errors[0].description
    assert ("zoneId", "z") in state.errors[0].references


def test_a_zone_set_of_another_map_is_refused():
    bench = ZoneBench()
    assert not accepts(bench, map_id="attic")
    assert types(bench.vehicle.state()) == [("UNKNOWN_MAP_ID", "WARNING")]


def test_two_zones_of_one_id_are_refused():
    assert not accepts(ZoneBench(), blocked(1, 1), blocked(2, 2))


def test_the_factsheet_says_which_zones_are_supported():
    sheet = CODEC.to_json(ZoneBench().vehicle.take_factsheet())
    types = sheet["typeSpecification"]["supportedZones"]
    assert types == ["BLOCKED", "RELEASE", "DIRECTED", "BIDIRECTED"]
    assert sheet["protocolLimits"]["maximumArrayLengths"]["zoneSet.zones"] == 1000
    validator_of(Kind.FACTSHEET, "3.0.0").validate(sheet)
    assert CODEC.decode(Kind.FACTSHEET, json.dumps(sheet).encode()).message.zone_types


def test_vehicles_of_versions_without_zones_know_none():
    bench = Bench()
    sheet = codec_for("2.1.0").to_json(bench.vehicle.take_factsheet())
    assert "supportedZones" not in sheet["typeSpecification"]
    state = bench.instant("enableZoneSet", zoneSetId="a")
    assert "is not an instant action" in state.errors[0].description


# --- BLOCKED


def test_an_order_through_a_blocked_zone_is_refused():
    bench = ZoneBench(blocked(3, 0))
    assert not bench.order("o", row(0, 6))
    state = bench.vehicle.state()
    assert types(state) == [("NO_ROUTE_TO_TARGET", "WARNING")]
    assert {("nodeId", "c3_0"), ("zoneId", "b")} <= set(references(state))
    assert bench.order("p", row(0, 2))


def test_a_robot_stops_before_a_zone_that_is_blocked_while_it_drives():
    """6.4.1.1, and 6.4.5: NODE_UNREACHABLE."""
    bench = ZoneBench()
    assert bench.order("o", row(0, 8))
    bench.hold(blocked(6, 0))
    state = bench.tick(12)
    assert bench.robot.cell[0] < 6 and not state.driving
    assert types(state) == [("NODE_UNREACHABLE", "CRITICAL")]
    assert ("zoneId", "b") in references(state)
    bench.hold()  # none
    assert bench.until(is_over).last_node == "c8_0"
    assert not bench.vehicle.state().errors


def test_a_robot_that_finds_itself_in_a_blocked_zone_stops_and_says_so():
    """6.4.1.1."""
    bench = ZoneBench()
    bench.order("o", row(0, 8))
    bench.tick(2)
    x, y = bench.robot.cell
    state = bench.hold(Zone("b", ZoneType.BLOCKED, area(x - 0.5, y - 0.5, x + 3.5, y + 0.5)))
    assert ALARM in types(state)
    state = bench.tick(5)
    assert bench.robot.cell[0] <= x + 2 and not state.driving
    assert ALARM not in types(bench.hold())


def test_the_contour_of_a_robot_that_turns_reaches_farther():
    """6.4.1.1: any part of the contour."""
    near = Zone("b", ZoneType.BLOCKED, area(2.6, 0.42, 4.4, 0.48))
    bench = ZoneBench(near)
    assert bench.order("straight", row(0, 3))
    bench.until(is_over)
    bench = ZoneBench(Zone("b", ZoneType.BLOCKED, area(2.6, 0.42, 4.4, 0.48)))
    assert not bench.order("turns", [*row(0, 3), (3, 1)])


# --- one-way


@pytest.mark.parametrize(
    "type,direction,word,cells,is_taken",
    [
        (ZoneType.DIRECTED, 0.0, "STRICT", row(0, 6), True),
        (ZoneType.DIRECTED, 3.14159, "STRICT", row(0, 6), False),
        (ZoneType.DIRECTED, 1.5708, "STRICT", row(0, 6), False),
        (ZoneType.DIRECTED, 1.5708, "RESTRICTED", row(0, 6), True),
        (ZoneType.DIRECTED, 3.14159, "RESTRICTED", row(0, 6), False),
        (ZoneType.DIRECTED, 3.14159, "SOFT", row(0, 6), True),
        (ZoneType.BIDIRECTED, 3.14159, "RESTRICTED", row(0, 6), True),
        (ZoneType.BIDIRECTED, 1.5708, "RESTRICTED", row(0, 6), False),
        (ZoneType.BIDIRECTED, 1.5708, "SOFT", row(0, 6), True),
    ],
)
def test_a_zone_is_traversed_in_its_direction_alone(type, direction, word, cells, is_taken):
    """6.4.1.2."""
    bench = ZoneBench(Zone("d", type, area(2.5, -0.5, 4.5, 0.5), direction, word))
    assert bench.order("o", cells) is is_taken
    if is_taken:
        assert bench.until(is_over).last_node == "c6_0"


# --- RELEASE


def test_a_robot_waits_for_the_release_and_removes_its_request_after_it():
    """6.4.3."""
    bench = ZoneBench(release(4))
    assert bench.order("o", row(0, 8))
    state = bench.tick(8)
    (request,) = state.zone_requests
    assert (request.type, request.zone, request.zone_set) == ("ACCESS", "r", "z1")
    assert request.status.value == "REQUESTED" and state.last_node == "c3_0"
    assert bench.answer(Grant.QUEUED).last_node == "c3_0"
    assert bench.answer(Grant.GRANTED).zone_requests[0].status.value == "GRANTED"
    at = bench.until(lambda s: s.last_node == "c4_0")
    assert at.zone_requests[0].status.value == "GRANTED"
    state = bench.until(is_over)
    assert state.last_node == "c8_0" and not state.zone_requests and not state.errors


def test_a_zone_that_is_far_away_is_not_asked_for():
    bench = ZoneBench(release(9))
    bench.order("o", row(0, 9))
    assert not bench.vehicle.state().zone_requests
    assert bench.until(lambda s: s.zone_requests).last_node == "c3_0"


@pytest.mark.parametrize("grant", [Grant.REJECTED, Grant.REVOKED])
def test_a_robot_that_has_not_entered_stays_out_and_asks_again(grant):
    bench = ZoneBench(release(4))
    bench.order("o", row(0, 8))
    former = bench.tick(8).zone_requests[0].id
    assert not bench.answer(grant).zone_requests
    state = bench.tick(6)
    assert state.last_node == "c3_0" and state.zone_requests[0].id != former


def test_a_release_that_is_revoked_before_the_zone_is_not_used():
    bench = ZoneBench(release(6))
    bench.order("o", row(0, 8))
    bench.tick(1)
    bench.answer(Grant.GRANTED)
    bench.answer(Grant.REVOKED)
    state = bench.tick(20)
    assert bench.robot.cell[0] < 6 and not state.driving


def test_a_lease_that_ends_before_the_zone_is_expired():
    bench = ZoneBench(release(6))
    bench.order("o", row(0, 8))
    bench.answer(Grant.GRANTED, expiry=bench.now + 2)
    state = bench.until(lambda s: s.zone_requests[0].status.value == "EXPIRED")
    state = bench.tick(10)
    assert bench.robot.cell[0] < 6 and state.zone_requests[0].status.value == "REQUESTED"


def test_a_lease_is_extended_by_another_response():
    bench = ZoneBench(release(6))
    bench.order("o", row(0, 8))
    bench.answer(Grant.GRANTED, expiry=bench.now + 2)
    bench.answer(Grant.GRANTED, expiry=bench.now + 100)
    assert bench.until(is_over).last_node == "c8_0"


def inside(bench):
    """Lets the robot drive into the zone around column 4 to 6."""
    bench.order("o", row(0, 9))
    bench.answer(Grant.GRANTED)
    bench.until(lambda s: s.last_node == "c4_0")


def wide(loss):
    return Zone("r", ZoneType.RELEASE, area(3.7, -0.4, 7.3, 0.4), word=loss)


def test_a_robot_that_loses_its_release_in_the_zone_stops_until_it_has_it_again():
    """6.4.1.1, STOP; 6.6.5.4: RELEASE_LOST."""
    bench = ZoneBench(wide("STOP"))
    inside(bench)
    state = bench.answer(Grant.REVOKED)
    assert ("RELEASE_LOST", "CRITICAL") in types(state) and ("zoneId", "r") in references(state)
    assert state.zone_requests[0].status.value == "REVOKED"
    state = bench.tick(12)
    assert bench.robot.cell[0] < 8 and not state.driving
    bench.answer(Grant.GRANTED)
    state = bench.until(is_over)
    assert state.last_node == "c9_0" and not state.errors


def test_a_robot_goes_on_in_a_zone_whose_release_it_loses_with_continue():
    """6.4.1.1, CONTINUE."""
    bench = ZoneBench(wide("CONTINUE"))
    inside(bench)
    state = bench.answer(Grant.REVOKED)
    assert state.zone_requests[0].status.value == "GRANTED"
    assert types(state) == [("zoneError", "WARNING")]
    state = bench.until(is_over)
    assert state.last_node == "c9_0" and not state.errors and not state.zone_requests


def test_a_cancelled_order_takes_its_requests_back():
    bench = ZoneBench(release(4))
    bench.order("o", row(0, 8))
    assert bench.tick(8).zone_requests
    bench.instant("cancelOrder")
    bench.until(is_over)
    assert not bench.tick().zone_requests


def test_an_answer_to_no_request_changes_nothing():
    bench = ZoneBench(release(4))
    bench.vehicle.on_responses(Responses((Response("other", Grant.GRANTED),)))
    bench.order("o", row(0, 8))
    assert bench.tick(12).last_node == "c3_0"


# --- messages


def message(**zone):
    return {
        "headerId": 1,
        "timestamp": "2026-03-01T00:00:00.000Z",
        "version": "3.0.0",
        "manufacturer": "kiva",
        "serialNumber": "1",
        "zoneSet": {"mapId": "warehouse", "zoneSetId": "s", "zones": [zone]},
    }


CORNERS = [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 1}]


@pytest.mark.parametrize(
    "zone,text",
    [
        ({"zoneType": "BLOCKED", "vertices": CORNERS}, "zoneId is missing"),
        ({"zoneId": "a", "zoneType": "PINK", "vertices": CORNERS}, "zoneType is 'PINK'"),
        ({"zoneId": "a", "vertices": CORNERS}, "zoneType is missing"),
        ({"zoneId": "a", "zoneType": "BLOCKED", "vertices": CORNERS[:2]}, "vertices has 2"),
        ({"zoneId": "a", "zoneType": "BLOCKED", "vertices": [{"x": 1}]}, "y is missing"),
        ({"zoneId": "a", "zoneType": "DIRECTED", "vertices": CORNERS}, "direction is missing"),
        (
            {
                "zoneId": "a",
                "zoneType": "RELEASE",
                "vertices": CORNERS,
                "releaseLossBehavior": "FLY",
            },
            "releaseLossBehavior is 'FLY'",
        ),
    ],
)
def test_a_malformed_zone_is_refused_by_its_field(zone, text):
    with pytest.raises(MessageError, match=text):
        CODEC.decode(Kind.ZONE_SET, json.dumps(message(**zone)).encode())


@pytest.mark.parametrize(
    "zone",
    [
        blocked(1, 2),
        release(3, "CONTINUE"),
        Zone("d", ZoneType.DIRECTED, cell(1, 1), 1.5, "STRICT"),
        Zone("s", ZoneType.SPEED_LIMIT, cell(1, 1), 0.5),
    ],
)
def test_a_zone_comes_back_as_it_was_sent_and_fits_the_schema(zone):
    payload = CODEC.encode(ZoneSet("s", "warehouse", (zone,)))
    validator_of(Kind.ZONE_SET, "3.0.0").validate(json.loads(payload))
    decoded = CODEC.decode(Kind.ZONE_SET, payload)
    assert decoded.message.zones == (zone,) and not decoded.unknown


def test_responses_come_back_as_they_were_sent():
    sent = (Response("a", Grant.GRANTED, 1772323200.5), Response("b", Grant.QUEUED))
    payload = CODEC.encode(Responses(sent))
    validator_of(Kind.RESPONSES, "3.0.0").validate(json.loads(payload))
    assert CODEC.decode(Kind.RESPONSES, payload).message.responses == sent


def test_a_lease_without_a_time_is_refused():
    payload = CODEC.encode(Responses((Response("a", Grant.GRANTED, 5.0),)))
    with pytest.raises(MessageError, match="leaseExpiry is 'soon'"):
        CODEC.decode(Kind.RESPONSES, payload.replace(b"1970-01-01T00:00:05.000Z", b"soon"))


def test_states_with_zones_fit_the_schema_and_come_back():
    bench = ZoneBench(release(4))
    bench.order("o", row(0, 8))
    state = bench.tick(8)
    value = CODEC.to_json(state)
    validator_of(Kind.STATE, "3.0.0").validate(value)
    back = CODEC.decode(Kind.STATE, json.dumps(value).encode()).message
    assert (back.zone_sets, back.zone_requests) == (state.zone_sets, state.zone_requests)


def test_versions_without_zones_have_no_such_messages():
    with pytest.raises(MessageError, match="has no zoneSet"):
        codec_for("2.1.0").decode(Kind.ZONE_SET, b'{"version": "2.1.0"}')


# --- geometry

ELL = ((0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4))


@pytest.mark.parametrize(
    "box,is_over",
    [
        (Box(0.5, 0.5, 0.3, 0.2, 0.2), True),
        (Box(3.0, 3.0, 0.0, 1.0, 1.0), False),  # within its hull, beside it
        (Box(-0.5, 2.0, 0.0, 1.0, 1.0), False),  # touches it
        (Box(-0.5, 2.0, 0.785, 1.0, 1.0), True),  # turned, its corner is within
        (Box(2.0, 2.0, 0.0, 10.0, 10.0), True),  # around it
    ],
)
def test_a_box_covers_a_part_of_a_polygon(box, is_over):
    assert overlaps(ELL, box) is is_over


def test_a_way_leads_through_a_polygon():
    assert contains(ELL, (0.5, 3.0)) and not contains(ELL, (2.0, 2.0))
    assert passes(ELL, (-1.0, 2.0), (3.0, 2.0)) and not passes(ELL, (2.0, 1.5), (2.0, 4.0))
    assert not passes(ELL, (5.0, 0.5), (6.0, 0.5))


def test_orders_are_checked_with_the_zones_of_the_last_enabled_set():
    bench = ZoneBench(blocked(3, 0))
    bench.hold(blocked(4, 0))
    assert not bench.vehicle.on_order(order("o", row(0, 4)), bench.now)
    assert bench.order("p", row(0, 3))
