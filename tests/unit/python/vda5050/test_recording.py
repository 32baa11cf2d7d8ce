# SPDX-License-Identifier: Apache-2.0
"""record and replay at a real broker; files of recordings, whole, cut off and broken."""

import json
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest
import zstandard
from grid_robot import GRID, GridRobot, order, row
from paths import ROOT

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.conform.broker import Broker
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.recording import recorder as recorder_module
from warehouse_vda5050.recording.entry import Entry
from warehouse_vda5050.recording.file import RecordingError, Writer, read
from warehouse_vda5050.recording.recorder import Recorder
from warehouse_vda5050.schemas import why_invalid
from warehouse_vda5050.topics import Identity, Kind, Topics
from warehouse_vda5050.vehicle import Vehicle

NODES = ROOT / "src" / "warehouse_vda5050" / "nodes"
STATE = "uagv/v2/kiva/1/state"
needs_mosquitto = pytest.mark.skipif(
    not (shutil.which("mosquitto") or pathlib.Path("/usr/sbin/mosquitto").exists()),
    reason="mosquitto is not installed",
)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def broker():
    with OwnBroker(free_port()) as broker:
        yield broker


def started(name, *arguments):
    """A program, and a thread that keeps its lines."""
    command = [sys.executable, "-u", str(NODES / name), *map(str, arguments)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    process.lines = []
    process.reader = threading.Thread(target=lambda: process.lines.extend(process.stdout))
    process.reader.start()
    return process


def ended(process, code, seconds=20):
    try:
        assert process.wait(seconds) == code, process.lines
    finally:
        process.kill()
        process.reader.join()
    return "".join(process.lines)


def until(condition, what, poll=lambda: time.sleep(0.01), seconds=15):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"waited in vain: {what}"
        poll()


def says(process, text):
    until(lambda: any(text in line for line in process.lines), (text, process.lines))


class Listener:
    """Keeps what goes through a broker, with the time of arrival."""

    def __init__(self, port):
        self.messages = []
        self.broker = Broker(BrokerSettings("127.0.0.1", port), name="listen")
        self.broker.take = lambda m: self.messages.append((time.monotonic(), m))
        self.broker.subscribe("uagv/v2/#")

    def until(self, condition, what, seconds=15):
        until(condition, what, lambda: self.broker.poll(0.01), seconds)

    def publish(self, topic, payload):
        self.broker.publish(topic, payload)


def drive(port, until_over):
    """Lets a vehicle carry out an order at a broker."""
    robot, loop, who = GridRobot((0, 0)), MqttLoop(), Identity("kiva", "1")
    vehicle = Vehicle(robot, GRID)
    settings = BrokerSettings("127.0.0.1", port)
    link = VehicleLink(vehicle, who, codec_for(), Topics(), settings)
    loop.add(link.link)

    def step():
        loop.poll(0.01)
        robot.step()
        link.tick(time.monotonic())

    until(lambda: link.link.connected, "the connection", step)
    vehicle.on_order(order("o", row(0, 4)), time.monotonic())
    until(until_over(robot), "the end of the order", step)
    link.close()
    loop.close()


@needs_mosquitto
def test_all_of_a_broker_is_recorded_and_replayed_in_its_order_and_at_its_times(broker, tmp_path):
    file = tmp_path / "r.jsonl.zst"
    record = started("record", "--broker", f"127.0.0.1:{broker.port}", "--out", file)
    says(record, "Ctrl-C ends it")
    drive(broker.port, lambda robot: lambda: robot.cell == (4, 0))
    listener = Listener(broker.port)
    listener.publish("uagv/v2/acme/9/order", b'{"orderId": 7}')
    listener.publish("uagv/v2/acme/9/state", b"\xff\xfe")
    listener.publish("uagv/v2/acme/9/weather", b"rain")
    listener.publish("uagv/v2/acme/9/factsheet", b"")
    listener.until(lambda: len(listener.messages) >= 5, "its own messages")
    record.send_signal(signal.SIGINT)
    text = ended(record, 0)
    assert "3 of them not valid" in text and str(file) in text

    entries = [*read(file)]
    assert f"{len(entries)} messages" in text
    kinds = [entry.topic.rpartition("/")[2] for entry in entries]
    assert {"connection", "factsheet", "state"} <= set(kinds)
    invalid = {entry.topic: entry.why for entry in entries if not entry.valid}
    assert set(invalid) == {f"uagv/v2/acme/9/{kind}" for kind in ("order", "state", "weather")}
    assert "'headerId' is a required property" in invalid["uagv/v2/acme/9/order"]
    assert next(e for e in entries if e.topic.endswith("9/state")).payload == b"\xff\xfe"
    assert [e.qos for e in entries if e.topic.endswith("/connection")] == [1, 1]

    with OwnBroker(free_port()) as other:
        listener = Listener(other.port)
        begin = time.monotonic()
        replay = started("replay", file, "--broker", f"127.0.0.1:{other.port}", "--speed", 0.5)
        listener.until(lambda: len(listener.messages) >= len(entries), "the replay", 30)
        assert f"{len(entries)} of {len(entries)} messages are sent" in ended(replay, 0)
        sent = [(entry.topic, entry.payload) for entry in entries]
        assert [(m.topic, m.payload) for _, m in listener.messages] == sent
        span = listener.messages[-1][0] - listener.messages[0][0]
        expected = 2 * (entries[-1].time - entries[0].time)
        assert expected - 0.2 < span < expected + 1.0, (span, expected, begin)
        later = Listener(other.port)  # the broker keeps connections
        later.until(lambda: later.messages, "what the broker has kept")
        assert later.messages[0][1].topic == "uagv/v2/kiva/1/connection"


@needs_mosquitto
def test_a_replay_keeps_the_time_between_messages_and_ends_by_ctrl_c(broker, tmp_path):
    file = recording(tmp_path, [(0.0, b"{}"), (4.0, b"{}"), (1000.0, b"{}")])
    listener = Listener(broker.port)
    replay = started("replay", file, "--broker", f"127.0.0.1:{broker.port}", "--speed", 4)
    listener.until(lambda: len(listener.messages) == 2, "two messages")
    (first, _), (second, _) = listener.messages
    assert 0.8 < second - first < 1.8
    says(replay, "of 1000.0 s, 2 of 3 messages")
    replay.send_signal(signal.SIGINT)
    assert "2 of 3 messages are sent" in ended(replay, 1)


@needs_mosquitto
def test_a_replay_waits_for_a_broker_that_is_away(broker, tmp_path):
    file = recording(tmp_path, [(0.2 * k, str(k).encode()) for k in range(20)])
    listener = Listener(broker.port)
    replay = started("replay", file, "--broker", f"127.0.0.1:{broker.port}")
    listener.until(lambda: len(listener.messages) >= 3, "the first messages")
    broker.stop()
    before = len(listener.messages)
    broker.start()
    listener.until(lambda: listener.messages[-1][1].payload == b"19", "the last message", 30)
    assert "20 of 20 messages are sent" in ended(replay, 0)
    payloads = [int(m.payload) for _, m in listener.messages]
    assert payloads == sorted(payloads) and len(payloads) > before


def recording(folder, messages):
    """The file of some (time, payload) on one topic."""
    file = folder / "made.jsonl.zst"
    writer = Writer(file)
    for at, payload in messages:
        writer.write(Entry(1.7e9 + at, STATE, payload))
    writer.close()
    return file


def lines_file(folder, *lines):
    file = folder / "broken.jsonl.zst"
    file.write_bytes(zstandard.compress("".join(lines).encode()))
    return file


GOOD = json.dumps({"time": 1.0, "topic": "a/b", "payload": "x"}) + "\n"


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("{\n", "not JSON"),
        ("7\n", "an object was expected"),
        ('{"topic": "a", "payload": ""}\n', "time is None"),
        ('{"time": NaN, "topic": "a", "payload": ""}\n', "time is nan"),
        ('{"time": 1, "topic": "a/#", "payload": ""}\n', "topic is 'a/#'"),
        ('{"time": 1, "topic": "a"}\n', "payload_base64 is None"),
        ('{"time": 1, "topic": "a", "payload_base64": "?"}\n', "payload_base64 is not base64"),
        ('{"time": 1, "topic": "a", "payload": 7}\n', "payload is 7"),
        ('{"time": 1, "topic": "a", "payload": "", "qos": 9}\n', "qos is 9"),
        ('{"time": 1, "topic": "a", "payload": "", "retain": 1}\n', "retain is 1"),
    ],
)
def test_a_broken_line_is_named(tmp_path, line, reason):
    file = lines_file(tmp_path, GOOD, line, GOOD)
    entries = read(file)
    assert next(entries).payload == b"x"
    with pytest.raises(RecordingError) as refusal:
        next(entries)
    assert str(refusal.value).startswith(f"{file}:2: {reason}")


def test_a_file_that_was_cut_off_is_read_up_to_its_last_whole_line(tmp_path):
    file = tmp_path / "cut.jsonl.zst"
    writer = Writer(file)
    for k in range(5):
        writer.write(Entry(float(k), STATE, b"{}"))
        writer.flush()
    whole = file.read_bytes()  # what a killed program leaves
    file.write_bytes(whole[:-2])
    assert [entry.time for entry in read(file)] == [0.0, 1.0, 2.0, 3.0]
    file.write_bytes(whole)
    assert len([*read(file)]) == 5


def test_replay_refuses_a_bad_file_before_it_sends_anything(tmp_path):
    other = tmp_path / "text.zst"
    other.write_text("no zstd at all")
    empty = lines_file(tmp_path)
    for file, reason in (
        (other, f"{other}:1: no zstd"),
        (lines_file(tmp_path, GOOD, "{\n"), "broken.jsonl.zst:2: not JSON"),
        (tmp_path / "none.zst", "No such file"),
    ):
        assert reason in ended(started("replay", file), 2)
    empty = lines_file(tmp_path)
    assert f"{empty}:1: a message was expected" in ended(started("replay", empty), 2)
    good = recording(tmp_path, [(0.0, b"")])
    for speed in ("0", "-1", "nan"):
        assert "speed is" in ended(started("replay", good, "--speed", speed), 2)
    assert "127.0.0.1:1" in ended(started("replay", good, "--broker", "127.0.0.1:1"), 2)


def test_record_refuses_in_a_sentence(tmp_path):
    there = tmp_path / "there"
    there.write_text("")
    away = ("--broker", "127.0.0.1:1")
    assert "127.0.0.1:1" in ended(started("record", *away, "--out", tmp_path / "new"), 2)
    assert not (tmp_path / "new").exists()
    text = ended(started("record", *away, "--out", there, "--seconds", "-1"), 2)
    assert "seconds is -1" in text
    assert "prefix is" in ended(started("record", "--prefix", "a b", "--out", there), 2)


@needs_mosquitto
def test_record_overwrites_nothing_and_may_end_by_itself(broker, tmp_path):
    file = tmp_path / "r.zst"
    arguments = ("--broker", f"127.0.0.1:{broker.port}", "--out", file, "--seconds", "0.5")
    assert "0 messages" in ended(started("record", *arguments), 0)
    assert [*read(file)] == []
    assert "is there already" in ended(started("record", *arguments), 2)


def test_messages_that_come_too_fast_are_kept_and_not_checked(tmp_path, monkeypatch):
    monkeypatch.setattr(recorder_module, "BEHIND", 10)
    file = tmp_path / "r.zst"
    recorder = Recorder(Writer(file), Topics())
    for _ in range(500):
        recorder.take(STATE, b"{}", 0, False)
    recorder.close()
    entries = [*read(file)]
    assert len(entries) == 500 and {entry.valid for entry in entries} == {None, False}
    assert any("not checked" in line for line in recorder.summary())


@pytest.mark.parametrize("version", ["2.0.0", "2.1.0", "3.0.0"])
def test_a_message_is_judged_by_the_schema_of_its_version(version):
    vehicle = Vehicle(GridRobot(), GRID)
    vehicle.update(0.0)
    payload = codec_for(version).encode(vehicle.state())
    value = json.loads(payload) | {"version": version}
    assert why_invalid(Kind.STATE, json.dumps(value).encode()) == ""
    other = "2.1.0" if version[0] == "3" else "3.0.0"
    assert why_invalid(Kind.STATE, json.dumps(value | {"version": other}).encode())
    assert "is a required property" in why_invalid(Kind.STATE, b"{}")
    assert why_invalid(Kind.STATE, b"[") and why_invalid(Kind.STATE, b"") == ""
