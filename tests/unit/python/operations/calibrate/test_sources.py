# SPDX-License-Identifier: Apache-2.0
"""What each source holds becomes a recording; what can't be read is refused in a sentence."""

import json
import math
import sqlite3
import subprocess
import sys
from datetime import UTC, datetime

import numpy as np
import pytest
import rosbag
import rospkg
import rospy
import yaml
from nav_msgs.msg import Odometry
from std_msgs.msg import String

from warehouse_msgs.msg import FleetState, KivaStatus
from warehouse_operations.calibrate import program
from warehouse_operations.runs.simulation import Description, open_operations

SPEED, UP, DOWN, LIFT = 1.2, 0.8, 1.0, 3.0  # [m/s], [m/s²], [m/s²], [s]
WAY, RATE, PERIOD = 6.0, 1.8, 30.0  # of a drive [m], of a turn [rad/s], of all of it [s]


def at(time):
    """(x, y, yaw, speed, turning, lifting) of a vehicle that drives to and fro for ever, and turns
    half around by two quarters, and lifts."""
    lap, time = divmod(time, PERIOD)
    back = lap % 2 > 0
    x, v = drive(time)
    angle, w, lifting = 0.0, 0.0, False
    for i in range(2):
        turned, rate = turn(time - 10 - 3 * i)
        angle, w = angle + turned, w + rate
    lifting = 20 <= time < 20 + LIFT
    yaw = math.remainder((math.pi if back else 0.0) + angle, math.tau)
    return (WAY - x if back else x), 0.0, yaw, v, w, lifting


def drive(time):
    """(way, speed) after a time from rest."""
    rising, falling = SPEED / UP, SPEED / DOWN
    cruise = (WAY - SPEED * (rising + falling) / 2) / SPEED
    if time < rising:
        return UP * time**2 / 2, UP * time
    if time < rising + cruise:
        return SPEED * (time - rising / 2), SPEED
    left = max(rising + cruise + falling - time, 0.0)
    return WAY - DOWN * left**2 / 2, DOWN * left


def turn(time, ramp=6.0):
    """(angle, rate) of a quarter turn with a top rate."""
    rising, whole = RATE / ramp, math.pi / 2 / RATE + RATE / ramp
    time = min(max(time, 0.0), whole)
    if time < rising:
        return ramp * time**2 / 2, ramp * time
    if time < whole - rising:
        return RATE * (time - rising / 2), RATE
    return math.pi / 2 - ramp * (whole - time) ** 2 / 2, ramp * (whole - time)


QUARTER_TURN = math.pi / 2 / RATE + RATE / 6.0


def state(time, serial, action="", **more):
    x, y, yaw, v, w, _ = at(time)
    value = {
        "timestamp": datetime.fromtimestamp(1.7e9 + time, UTC).isoformat(timespec="milliseconds"),
        "manufacturer": "acme",
        "serialNumber": serial,
        "agvPosition": {"x": round(x, 4), "y": y, "theta": round(yaw, 4), "mapId": "hall"},
        "velocity": {"vx": round(v, 3), "vy": 0.0, "omega": round(w, 3)},
        "batteryState": {"batteryCharge": 50.0, "charging": False},
        "actionStates": [],
        "loads": [],
        "errors": [],
    }
    if action:
        row = {"actionId": f"lift{int(time // PERIOD)}", "actionType": "pick"}
        value["actionStates"] = [row | {"actionStatus": action}]
    return value | more


def entry(time, topic, value):
    return json.dumps({"time": 1.7e9 + time, "topic": topic, "payload": json.dumps(value)})


def log_of(step, laps=40):
    """Lines of two vehicles that send a state now and then."""
    lines, rng = [], np.random.default_rng(2)
    for serial in ("1", "2"):
        topic = f"uagv/v2/acme/{serial}/state"
        times = np.arange(0, laps * PERIOD, step)
        times += rng.uniform(0, step, len(times))
        for time in times:
            lap = PERIOD * (time // PERIOD)
            action = ""
            if time - lap >= 20:
                action = "RUNNING" if time - lap < 20 + LIFT else "FINISHED"
            lines.append((time, entry(time, topic, state(time, serial, action))))
        for lap in range(laps):
            for after, action in ((20.0, "RUNNING"), (20 + LIFT, "FINISHED")):
                time = lap * PERIOD + after
                lines.append((time, entry(time, topic, state(time, serial, action))))
    return [line for _, line in sorted(lines)]


def numbers(sources, tmp_path, capacity=960.0):
    out = tmp_path / "found.yaml"
    program.write(program.read([str(source) for source in sources]), capacity, out)
    return yaml.safe_load(out.read_text()), out.read_text()


def check_motion(motion, share=0.01):
    assert motion["speed"] == pytest.approx(SPEED, rel=share)
    assert motion["acceleration"] == pytest.approx(2 * UP * DOWN / (UP + DOWN), rel=share)
    assert motion["quarter_turn_time"] == pytest.approx(QUARTER_TURN, rel=share)
    assert motion["lift_time"] == pytest.approx(LIFT, rel=share)


@pytest.mark.parametrize("step", [0.1, 1.0])
def test_a_log_of_vehicles_says_their_motion(tmp_path, step):
    path = tmp_path / "messages.jsonl"
    path.write_text("\n".join(log_of(step)) + "\n")
    content, text = numbers([tmp_path], tmp_path)  # the folder, as conform leaves it
    check_motion(content["motion"])
    assert set(content) == {"motion"}
    assert "# per_robot_hour: too little to say: 0 failures in 0.7 robot hours, 1 were" in text


def test_a_log_that_was_cut_off_and_has_what_is_no_text_is_read(tmp_path):
    path = tmp_path / "log.jsonl"
    binary = json.dumps({"time": 1.7e9, "topic": "uagv/v2/acme/1/state", "payload_base64": "/w=="})
    lines = [binary, *log_of(0.5)]
    path.write_text("\n".join(lines) + "\n" + lines[-1][:30])
    check_motion(numbers([path], tmp_path)[0]["motion"])


def test_a_compressed_log_is_the_same(tmp_path):
    zstandard = pytest.importorskip("zstandard")
    path = tmp_path / "log.jsonl.zst"
    # Two frames, as a recorder writes that was started again.
    lines, compressor = log_of(0.5), zstandard.ZstdCompressor()
    half = len(lines) // 2
    parts = ["\n".join(lines[:half]) + "\n", "\n".join(lines[half:]) + "\n"]
    path.write_bytes(b"".join(compressor.compress(part.encode()) for part in parts))
    check_motion(numbers([path], tmp_path)[0]["motion"])


def test_errors_of_vehicles_are_failures_and_repairs(tmp_path):
    lines = []
    fatal = [{"errorType": "motorError", "errorLevel": "FATAL"}]
    of_order = [{"errorType": "orderError", "errorLevel": "FATAL"}]
    for second in range(7200):
        broken = 1000 <= second < 1600 or 5000 <= second < 5300
        errors = fatal if broken else of_order if second > 7000 else []
        value = state(0.0, "1", errors=errors)
        value["timestamp"] = datetime.fromtimestamp(1.7e9 + second, UTC).isoformat()
        lines.append(entry(second, "uagv/v2/acme/1/state", value))
    path = tmp_path / "log.jsonl"
    path.write_text("\n".join(lines) + "\n")
    failures = numbers([path], tmp_path)[0]["failures"]
    assert failures["per_robot_hour"] == pytest.approx(1.0, rel=0.01)
    assert failures["repair_time"] == pytest.approx(450.0, rel=0.01)
    assert (failures["motor"], failures["radio_lost"]) == (1, 0)


def test_a_bag_of_robots_own_topics_says_their_motion(tmp_path):
    path = tmp_path / "robots.bag"
    with rosbag.Bag(str(path), "w") as bag:
        for count in range(round(40 * PERIOD * 20)):
            x, y, yaw, v, w, lifting = at(count / 20)
            stamp = rospy.Time.from_sec(1 + count / 20)
            odometry = Odometry()
            odometry.header.stamp = stamp
            odometry.pose.pose.position.x = x
            odometry.pose.pose.orientation.z = math.sin(yaw / 2)
            odometry.pose.pose.orientation.w = math.cos(yaw / 2)
            odometry.twist.twist.linear.x, odometry.twist.twist.angular.z = v, w
            status = KivaStatus(kiva_id=1, state=4 if lifting else 0)
            status.header.stamp = stamp
            bag.write("/hall/kiva1/status", status, stamp)
            bag.write("/hall/kiva1/odom", odometry, stamp)
    check_motion(numbers([path], tmp_path)[0]["motion"])


# --- what can't be read


def refused(*sources, out="/nowhere/found.yaml"):
    with pytest.raises(program.ERRORS) as error:
        program.read([str(source) for source in sources])
    assert "\n" not in str(error.value)
    return str(error.value)


def bag_of(path, **messages):
    with rosbag.Bag(str(path), "w") as bag:
        for topic, message in messages.items():
            bag.write("/" + topic.replace("__", "/"), message, rospy.Time(1))
    return path


def test_bags_without_robots_are_refused(tmp_path):
    text = refused(bag_of(tmp_path / "empty.bag"))
    assert "empty.bag: is empty; /warehouse/fleet, or /kiva<id>/odom" in text
    text = refused(bag_of(tmp_path / "chat.bag", chatter=String()))
    assert "chat.bag: has /chatter; /warehouse/fleet, or" in text
    text = refused(bag_of(tmp_path / "other.bag", warehouse__fleet=String()))
    assert "/warehouse/fleet is of type std_msgs/String; warehouse_msgs/FleetState was" in text
    fleet = FleetState(kiva_id=[1], x=[0], y=[0], yaw=[0], vx=[0], vy=[0], yaw_rate=[0])
    fleet.state, fleet.shelf_id, fleet.charge, fleet.failures = [0], [0], [1], [0]
    text = refused(bag_of(tmp_path / "short.bag", warehouse__fleet=fleet))
    assert "short.bag: /warehouse/fleet hold 1 messages, too few for a track" in text
    whole = (tmp_path / "chat.bag").read_bytes()
    (tmp_path / "cut.bag").write_bytes(whole[: len(whole) // 2])
    assert "cut.bag: " in refused(tmp_path / "cut.bag")


@pytest.mark.parametrize(
    "content, complaint",
    [
        ("", "is empty; a rosbag, a log of VDA 5050 messages or the database of a shift was"),
        ("hello", "is none of what is read; a rosbag"),
        ('{"a": 1}\n', ':1: \'{"a": 1}\'; a JSON object with "time", "topic" and "payload"'),
        (entry(0, "state", state(0.0, "1")) + "\n{half\n", ":2: '{half'; a JSON object with"),
        (
            entry(0, "uagv/v2/a/1/order", {}),
            "has no topic 'state' or 'visualization' among order: a log of what vehicles send",
        ),
        (entry(0, "state", state(0.0, "1")), "states of 1 vehicles, none with 10 positions"),
        (
            entry(0, "state", state(0.0, "1", agvPosition={"x": "here", "y": 0})),
            ":1: state: could not convert string to float: 'here'; a message of VDA 5050 was",
        ),
        (
            entry(0, "state", state(0.0, "1", timestamp="yesterday")),
            ":1: state: Invalid isoformat string: 'yesterday'",
        ),
    ],
)
def test_logs_are_refused_by_file_and_line(tmp_path, content, complaint):
    path = tmp_path / "log.jsonl"
    path.write_text(content)
    assert f"{path}" in refused(path)
    assert complaint in refused(path)


@pytest.fixture(scope="module")
def shift(tmp_path_factory):
    path = tmp_path_factory.mktemp("calibrate") / "run.db"
    with open_operations(Description("small", physics=False), str(path)) as ops:
        ops.step_until(600.0)
    return path


def test_databases_are_refused_in_a_sentence(shift, tmp_path):
    content = shift.read_bytes()
    cut = tmp_path / "cut.db"
    cut.write_bytes(content[:9000])
    assert "cut.db: " in refused(cut) or "the database" in refused(cut)
    old = tmp_path / "old.db"
    old.write_bytes(content)
    with sqlite3.connect(old) as connection:
        connection.execute("UPDATE schema_version SET version = 3")
    assert "of schema version 3; 4 was expected" in refused(old)
    other = tmp_path / "other.db"
    with sqlite3.connect(other) as connection:
        connection.execute("CREATE TABLE cats (name TEXT)")
    assert "there is no warehouse in it" in refused(other)
    idle = tmp_path / "idle.db"
    idle.write_bytes(content)
    with sqlite3.connect(idle) as connection:
        connection.execute("DELETE FROM move WHERE visit IS NOT NULL")
    assert "nothing was picked or put in; a shift at work was expected" in refused(idle)
    assert "No such file" in refused(tmp_path / "none.db")
    assert "is a folder without messages.jsonl" in refused(tmp_path)


def test_a_short_shift_says_by_name_what_is_too_little(shift, tmp_path):
    content, text = numbers([shift], tmp_path)
    assert set(content) == {"service"}
    assert content["service"]["seconds_a_piece"] == 10
    assert "# motion: nothing was measured\n# speed: too little to say: 0 cruises, 8 were" in text


@pytest.mark.long
def test_the_program_ends_as_it_says(shift, tmp_path):
    folder = rospkg.RosPack().get_path("warehouse_operations")
    command = [sys.executable, f"{folder}/nodes/calibrate"]

    def run(*arguments):
        asked = [*command, *map(str, arguments)]
        return subprocess.run(asked, capture_output=True, text=True, timeout=60, check=False)

    out = tmp_path / "deep" / "found.yaml"
    good = run(shift, "--out", out)
    assert good.returncode == 0 and "a piece [s]" in good.stdout and out.exists()
    assert "Too little to say:\n  speed (0 cruises, 8 were expected)" in good.stdout
    lines = log_of(10.0, 4)[:30]
    (tmp_path / "log.jsonl").write_text("\n".join(lines))
    none = run(tmp_path / "log.jsonl", "--out", out)
    assert none.returncode == 2 and "nothing can be said (speed: too little" in none.stderr
    assert run(tmp_path / "none", "--out", out).returncode == 1
    assert run(shift, "--out", "/proc/found.yaml").returncode == 1
    assert run(shift, "--out", out, "--capacity", "0").returncode == 2
