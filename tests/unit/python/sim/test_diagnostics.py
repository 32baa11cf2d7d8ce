# SPDX-License-Identifier: Apache-2.0
import http.server
import threading

import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from warehouse_msgs.msg import FleetState, KivaStatus, Vda5050
from warehouse_msgs.srv import FailRequest
from warehouse_sim import diagnostics

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
STALE = DiagnosticStatus.STALE


def values_of(status):
    return {pair.key: pair.value for pair in status.values}


@pytest.mark.parametrize(
    "factor, requested, is_paused, level, message",
    [
        (1.0, 1.0, False, OK, "runs at 1.00 times real time"),
        (0.5, 1.0, False, WARN, "runs at 0.50 times real time; 1 is requested"),
        (4.8, 5.0, False, OK, "runs at 4.80 times real time"),
        (0.3, 0.0, False, OK, "runs at 0.30 times real time"),  # as fast as possible
        (0.0, 1.0, True, OK, "paused"),
        (None, 1.0, False, STALE, "nothing is heard of the world"),
    ],
)
def test_a_world_is_judged_by_the_speed_that_was_requested(
    factor, requested, is_paused, level, message
):
    status = diagnostics.of_world(factor, requested, is_paused)
    assert (status.level, status.message) == (level, message)
    assert status.name == "warehouse: world"


def fleet(*robots):
    """A FleetState of (status, failures) a robot."""
    status, failures = zip(*robots)
    return FleetState(kiva_id=range(1, len(robots) + 1), status=status, failures=failures)


def test_failed_and_blocked_robots_are_named():
    broken = 1 << FailRequest.MOTOR
    status = diagnostics.of_robots(
        fleet(
            (KivaStatus.STATUS_IDLE, 0),
            (KivaStatus.STATUS_BLOCKED, 0),
            (KivaStatus.STATUS_BUSY, broken),
        )
    )
    assert status.level == ERROR
    assert status.message == "failed: kiva3 (drive); blocked: kiva2"
    assert values_of(status) == {
        "robots": "3", "idle": "1", "busy": "1", "blocked": "1", "failed": "1", "kiva3": "drive",
    }  # fmt: skip


def test_a_blocked_robot_alone_is_a_warning_and_a_healthy_fleet_is_none():
    blocked = diagnostics.of_robots(fleet((KivaStatus.STATUS_BLOCKED, 0)))
    assert (blocked.level, blocked.message) == (WARN, "blocked: kiva1")
    well = diagnostics.of_robots(fleet((KivaStatus.STATUS_BUSY, 0)))
    assert (well.level, well.message) == (OK, "1 robot, none failed or blocked")
    assert diagnostics.of_robots(None).level == STALE


def test_many_robots_are_a_count():
    status = diagnostics.of_robots(fleet(*[(KivaStatus.STATUS_BLOCKED, 0)] * 8))
    assert status.message == "blocked: kiva1, kiva2, kiva3, kiva4, kiva5 and 3 more"


def test_vehicles_without_a_connection_are_named():
    message = Vda5050(broker="localhost:1883", kiva_id=[1, 2], direction=Vda5050.VEHICLE)
    message.connection = [Vda5050.ONLINE, Vda5050.CONNECTIONBROKEN]
    status = diagnostics.of_broker(message)
    assert (status.level, status.message) == (WARN, "not connected: kiva2")
    message.connection = [Vda5050.ONLINE, Vda5050.ONLINE]
    assert diagnostics.of_broker(message).message == "2 connected"


@pytest.fixture
def server():
    server = http.server.HTTPServer(("127.0.0.1", 0), http.server.BaseHTTPRequestHandler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server
    server.shutdown()
    server.server_close()


def test_a_viewer_that_refuses_a_request_answers_all_the_same(server):
    address = f"http://127.0.0.1:{server.server_port}/"
    assert diagnostics.fault_of(address) == ""
    status = diagnostics.of_viewer(address, "")
    assert (status.level, status.message) == (OK, "answers")


def test_a_viewer_that_ended_is_an_error():
    status = diagnostics.of_viewer(
        "http://127.0.0.1:9/", diagnostics.fault_of("http://127.0.0.1:9")
    )
    assert status.level == ERROR and "refused" in status.message
