# SPDX-License-Identifier: Apache-2.0
"""A broker's recording beside the floor's: the chosen robot's panel shows what it did then."""

import json
import os
import signal
import subprocess
import sys
import urllib.request
from dataclasses import replace

import numpy as np
import pytest
from asgi import request
from paths import ROOT
from rostest_support.browser import browser
from sample_messages import World, fleet

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.errors import Error, ErrorLevel
from warehouse_vda5050.model import (
    ActionState,
    ActionStatus,
    Connection,
    ConnectionState,
    Header,
    Node,
    NodeState,
    VehicleOrder,
    VehicleState,
)
from warehouse_vda5050.recording.entry import Entry
from warehouse_vda5050.recording.file import Writer
from warehouse_vda5050.recording.moments import Moments
from warehouse_vda5050.topics import Identity, Kind, Topics
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.replay.file import NAME, FileRecording, FileWriter
from warehouse_viewer.replay.recorder import Recorder
from warehouse_viewer.replay.standalone import application
from warehouse_viewer.replay.vda5050_past import Vda5050Past

NODES = ROOT / "src" / "warehouse_viewer" / "nodes"
BEGIN = 1_700_000_000.0  # on the wall, as the floor's recording begins [s since 1970]
PATIENCE = 60.0  # with a machine that has much to do [s, wall]
CODEC, TOPICS = codec_for(), Topics()
KINDS = {VehicleState: Kind.STATE, VehicleOrder: Kind.ORDER, Connection: Kind.CONNECTION}
CART = Identity("acme", "0007")
PICK = ActionState("a", "pick", ActionStatus.RUNNING)
PANEL = "document.getElementById('facts').textContent"


def entry(time, message, who=CART, retain=False):
    """A message that came some seconds after BEGIN."""
    header = Header(1, "2026-01-01T00:00:00.00Z", "2.1.0", who.manufacturer, who.serial)
    kind = KINDS[type(message)]
    payload = CODEC.encode(replace(message, header=header))
    return Entry(BEGIN + time, TOPICS.of(who, kind), payload, retain=retain)


def state(base, horizon, **fields):
    """A vehicle's state, with the nodes of base and horizon ahead."""
    rows = [(name, True) for name in base] + [(name, False) for name in horizon]
    nodes = tuple(NodeState(name, 2 * i + 2, done) for i, (name, done) in enumerate(rows))
    return VehicleState("tour", 3, "c0_0", 0, nodes, **fields)


def a_tour():
    """A vehicle is there, gets an order, drives it, stands with an error, and goes."""
    jam = Error("motorError", ErrorLevel.FATAL, "the left wheel is jammed")
    order = VehicleOrder("tour", 3, (Node("c0_0", 0, True),), ())
    return [
        entry(0, Connection(ConnectionState.ONLINE)),
        entry(2, VehicleState()),
        entry(9, order),
        entry(10, state(["c1_0", "c2_0"], ["c3_0"], driving=True)),
        entry(20, state(["c2_0"], [], actions=(PICK,), errors=(jam,))),
        Entry(BEGIN + 21, TOPICS.of(CART, KINDS[VehicleState]), b"no JSON"),
        entry(40, Connection(ConnectionState.OFFLINE)),
    ]


def at(moments, time):
    (moment,) = moments.at(BEGIN + time)
    return moment


def test_a_vehicle_at_any_moment():
    moments = Moments(a_tour(), {CART: 1})
    assert list(moments.at(BEGIN - 1)) == []
    assert at(moments, 1).told_at is None and at(moments, 1).connection == "ONLINE"
    assert at(moments, 9.5).doing.order == "" and at(moments, 9.5).ordered == "tour"
    drives = at(moments, 15)
    assert (drives.number, drives.is_ours, drives.told_at) == (1, True, BEGIN + 10)
    assert (drives.doing.order, drives.doing.update, drives.doing.driving) == ("tour", 3, True)
    assert (drives.doing.base, drives.doing.horizon) == (("c1_0", "c2_0"), ("c3_0",))
    stands = at(moments, 30).doing
    assert (stands.base, stands.actions) == (("c2_0",), ("pick RUNNING",))
    assert stands.errors == ("FATAL motorError: the left wheel is jammed",)
    assert at(moments, 50).connection == "OFFLINE"


def test_a_robot_s_number_is_its_serial_unless_a_file_says_otherwise():
    said = Connection(ConnectionState.ONLINE)
    makers = [Identity("kiva", "12"), Identity("kiva", "cart"), Identity("acme", "7")]
    entries = [entry(0, said, who) for who in makers]
    numbers = {m.identity: m.number for m in Moments(entries, {makers[2]: 12}).at(BEGIN)}
    assert numbers == {makers[2]: 12}
    numbers = {m.identity: m.number for m in Moments(entries, {}).at(BEGIN)}
    assert numbers == {makers[0]: 12, makers[2]: 7}


def test_times_of_a_clock_that_was_set_back_keep_their_order():
    entries = [entry(10, state(["b"], [])), entry(4, state(["c"], []))]
    moments = Moments(entries, {CART: 1})
    assert at(moments, 10).doing.base == ("c",)


@pytest.mark.parametrize(
    "payload",
    [b"[]", b"[" * 100_000, b'{"nodeStates": 3}', b'{"nodeStates": [{"sequenceId": "x"}, 7]}'],
)
def test_what_is_no_state_stops_nothing(payload):
    topic = TOPICS.of(Identity("kiva", "7"), KINDS[VehicleState])
    list(Moments([Entry(BEGIN, topic, payload)], {}).at(BEGIN))


@pytest.fixture
def folder(tmp_path):
    """A floor's recording of a minute, a broker's of the same, and the file of robots."""
    world, journal = World(), Journal()
    writer = FileWriter(tmp_path / NAME, {"name": "small"})
    clock = [BEGIN]
    recorder = Recorder(writer, world.model, journal, lambda: None, lambda: clock[0])
    for stamp in np.arange(0, 60, 0.25):
        clock[0] = BEGIN + float(stamp)
        world.turn(fleet=fleet(x=(stamp / 10, 1.0), stamp=float(stamp)))
        recorder.take()
    recorder.close()
    messages = Writer(tmp_path / "broker.jsonl.zst")
    for message in a_tour():
        messages.write(message)
    messages.close()
    (tmp_path / "robots.yaml").write_text("1: {manufacturer: acme, serial: '0007'}\n")
    return tmp_path


@pytest.fixture
def page_of(folder):
    """The address of the page that `replay` serves."""
    arguments = [folder, "--port", "0", "--no-browser", "--vda5050", folder / "broker.jsonl.zst"]
    command = [sys.executable, NODES / "replay", *arguments, "--robots", folder / "robots.yaml"]
    environment = {n: v for n, v in os.environ.items() if not n.startswith("ROS_")}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as server:
        yield server.stdout.readline().split()[4]
        server.send_signal(signal.SIGINT)


@pytest.mark.long
def test_the_panel_shows_the_slider_s_moment(page_of):
    rows = json.load(urllib.request.urlopen(f"{page_of}recording/vda5050?at={BEGIN + 15}"))
    assert [(row["id"], row["order"], row["past"]["age"]) for row in rows] == [(1, "tour", 5.0)]
    with browser(PATIENCE) as page:
        page.open(f"{page_of}#t=15&see=kiva1")
        page.until("page.timeline.player.chunk && page.selected === 'kiva1'")
        page.until(f"{PANEL}.includes('tour, update 3')")
        text = page.read(PANEL)
        assert "c1_0 → c2_0 (2)" in text and "c3_0 (1)" in text and "driving" in text
        page.read("void page.timeline.seek(30)")
        page.until(f"{PANEL}.includes('the left wheel is jammed')")
        text = page.read(PANEL)
        assert "c2_0 (1)" in text and "pick RUNNING" in text and "c3_0" not in text
        page.read("void page.timeline.seek(1)")
        page.until(f"!{PANEL}.includes('tour') && {PANEL}.includes('online')")
        page.read("void page.timeline.seek(50)")
        page.until(f"{PANEL}.includes('offline')")
        assert page.complaints() == []


def test_without_a_broker_s_recording_none_is_asked_for(folder):
    index = request(application(FileRecording(folder / NAME)), "/recording/index")
    assert json.loads(index.body)["vda5050"] is False


@pytest.mark.parametrize("text", ["", "nan", "now", "inf"])
def test_a_moment_that_is_none_is_refused(folder, text):
    past = Vda5050Past(folder / "broker.jsonl.zst", folder / "robots.yaml")
    app = application(FileRecording(folder / NAME), vehicles=past.routes())
    answer = request(app, "/recording/vda5050", f"at={text}")
    assert answer.status == 422
    expected = f"at is {text!r}; seconds since 1970 were expected"
    assert json.loads(answer.body)["detail"] == expected


def test_replay_says_what_is_wrong_with_the_broker_s_recording(folder):
    def said(*arguments):
        command = [sys.executable, NODES / "replay", folder, "--no-browser", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False).stderr

    recorded = folder / "empty.jsonl.zst"
    Writer(recorded).close()
    assert f"replay: {recorded}: no vehicle in it is a robot" in said("--vda5050", recorded)
    assert f"replay: {folder / NAME}:1: no zstd" in said("--vda5050", folder / NAME)
    assert f"replay: {folder / NAME}: " in said("--vda5050", recorded, "--robots", folder / NAME)
    assert "--robots is of use with --vda5050 alone" in said("--robots", folder / "robots.yaml")


def test_the_file_of_what_was_added_while_the_master_ran_counts_too(folder):
    def numbers():
        past = Vda5050Past(folder / "broker.jsonl.zst", robots)
        return [moment.number for moment in past._moments.at(BEGIN + 15)]

    robots = folder / "robots.yaml"
    robots.write_text("5: {manufacturer: acme, serial: other}\n")
    assert numbers() == [7], "that of its serial"
    added = folder / "robots.onboarded.yaml"
    added.write_text("12: {manufacturer: acme, serial: '0007', origin: [0, 0, 0]}\n")
    assert numbers() == [12]
