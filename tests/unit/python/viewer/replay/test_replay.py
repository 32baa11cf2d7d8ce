# SPDX-License-Identifier: Apache-2.0
"""What was shown is recorded, found by its time, and played; damaged files say where they are."""

import json
import math
import os
import random
import signal
import struct
import subprocess
import sys
import urllib.request

import numpy as np
import pytest
import rosbag
import rospy
from asgi import request
from paths import ROOT
from rostest_support import axe
from rostest_support.browser import browser
from sample_messages import World, fleet, objects, scenery, states
from std_msgs.msg import Header

from warehouse_msgs.msg import Event
from warehouse_operations.forecast.request import ForecastError
from warehouse_viewer.page import protocol
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.replay import blocks, chunk
from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.chunk import Chunk, Mark, OpenChunk, messages, unpacked
from warehouse_viewer.replay.file import NAME, FileRecording, FileWriter
from warehouse_viewer.replay.forecasts import RecordedForecasts, asked_of
from warehouse_viewer.replay.live import LiveRecording
from warehouse_viewer.replay.memory import MemoryStore
from warehouse_viewer.replay.opening import open_recording
from warehouse_viewer.replay.recorder import LENGTH, Recorder
from warehouse_viewer.replay.standalone import RECORDED, application

PATIENCE = 60.0  # with a machine that has much to do [s, wall]
NODES = ROOT / "src" / "warehouse_viewer" / "nodes"


def event(stamp, kind="DONE", model="kiva1"):
    return {"time": stamp, "kind": kind, "command": 1, "model": model, "other": "", "text": "x"}


class Run:
    """A warehouse whose robot kiva1 drives 0.1 m/s, recorded into a store."""

    def __init__(self, store, figures=lambda: None, clock=lambda: None):
        self.world, self.journal = World(), Journal()
        self.recorder = Recorder(store, self.world.model, self.journal, figures, clock)

    def go(self, begin, end, step=0.25):
        for stamp in np.arange(begin, end, step):
            self.at(float(stamp))
        return self

    def at(self, stamp, **other):
        self.world.turn(fleet=fleet(x=(stamp / 10, 1.0), stamp=stamp), **other)
        self.recorder.take()


def told(recording, number, kind=chunk.TEXT):
    """[(stamp, message)] of a kind in a chunk."""
    rows = messages(unpacked(recording.chunk_data(number)))
    return [(s, json.loads(m) if kind == chunk.TEXT else m) for k, s, m in rows if k == kind]


def robots(update):
    """{index: x} of the robots in an update."""
    count = struct.unpack_from("<I", update, 20)[0]
    rows = np.frombuffer(update, protocol.ROBOT, count, 40)
    return dict(zip(rows["index"].tolist(), rows["x"].tolist()))


@pytest.fixture
def file(tmp_path):
    """A recording of a minute and a quarter."""
    writer = FileWriter(tmp_path / NAME, {"name": "small"})
    run = Run(writer, lambda: {"kpis": {"orders_completed": 7}}).go(0, 40)
    run.journal.add(event(40.1, "COLLISION"))
    run.go(40, 75).recorder.close()
    return tmp_path / NAME


def test_a_recording_is_read_as_it_was_written(file):
    recording = FileRecording(file)
    assert recording.about == {"name": "small"}
    assert recording.cut == ""
    begins = [chunk.begin for chunk in recording.chunks]
    assert begins == [0, LENGTH, 2 * LENGTH]
    second = recording.chunks[1]
    assert second.marks == (Mark(40.1, "COLLISION", "kiva1", "x"),)
    scene = json.loads(unpacked(recording.scene_data(second.scene)))
    assert scene["robots"] == [1, 2]
    updates = told(recording, second.number, chunk.UPDATE)
    # Everything first, at half a second each; then what has changed alone.
    assert [stamp for stamp, _ in updates] == list(np.arange(30, 60, 0.5))
    assert robots(updates[0][1]) == {0: pytest.approx(3, abs=1e-3), 1: 1.0}
    assert robots(updates[20][1]) == {0: pytest.approx(4, abs=1e-3)}


def test_a_chunk_alone_tells_the_figures_and_the_events_before_it(file):
    recording = FileRecording(file)
    texts = told(recording, recording.chunks[2].number)
    assert texts[0][1]["type"] == "past"
    assert [text["kind"] for text in texts[0][1]["events"]] == ["COLLISION"]
    assert texts[1] == (60, {"type": "figures", "kpis": {"orders_completed": 7}})


def test_a_new_alarm_is_a_mark_once():
    alarms = []
    store = MemoryStore()
    run = Run(store, lambda: {"fleet": {"alarms": list(alarms)}}).go(0, 10)
    alarms.append("pick1 has waited for a person for 15 s")
    run.go(10, 30)
    alarms[:] = ["pick1 has waited for a person for 35 s", "kiva3 does not move"]
    run.go(30, 50).recorder.close()
    assert [(m.kind, m.time, m.text) for c in store.chunks for m in c.marks] == [
        ("ALARM", 10.0, "pick1 has waited for a person for 15 s"),
        ("ALARM", 30.0, "kiva3 does not move"),
    ]


def test_another_warehouse_begins_another_scene():
    store = MemoryStore()
    run = Run(store).go(0, 5)
    run.at(5.0, objects=objects(items=2))
    run.recorder.close()
    first, second = store.chunks
    assert first.scene != second.scene
    assert len(json.loads(unpacked(store.scene_data(second.scene)))["items"]) == 2


@pytest.mark.parametrize("kind", ["memory", "file"])
def test_what_was_undone_is_not_played(kind, tmp_path):
    store = MemoryStore() if kind == "memory" else FileWriter(tmp_path / NAME, {})
    Run(store).go(0, 70).go(45, 50).recorder.close()
    recording = store if kind == "memory" else FileRecording(tmp_path / NAME)
    times = [(chunk.begin, chunk.end) for chunk in recording.chunks]
    assert times == [(0, 29.5), (30, 45), (45, 49.5)]


def test_memory_keeps_an_hour_and_no_more_than_it_may():
    store = MemoryStore(seconds=60)
    Run(store).go(0, 300, 0.5).recorder.close()
    assert store.chunks[0].begin == 210
    assert store.chunks[-1].end == 299.5
    small = MemoryStore(most_bytes=3000)
    for begin in range(20):
        data = bytes(1000)
        small.add(Chunk(small.next_number(), 1, begin, begin + 1, None, (), data))
    assert small.size <= 3000
    assert small.chunks[-1].end == 20


def test_a_file_that_was_cut_off_is_played_up_to_there(file):
    file.write_bytes(file.read_bytes()[:-100])
    recording = FileRecording(file)
    assert "cut off" in recording.cut or "beyond the end" in recording.cut
    assert len(recording.chunks) == 2


def damaged(file, at):
    data = bytearray(file.read_bytes())
    data[at] ^= 0xFF
    file.write_bytes(data)


def test_a_damaged_chunk_says_so_and_the_others_play(file):
    second = FileRecording(file).chunks[1].number
    with file.open("rb") as opened:
        parts, _ = blocks.read_blocks(opened, "")
    block = [part for part in parts if part.what == blocks.CHUNK][1]
    damaged(file, block.at + block.json_length + 20)
    recording = FileRecording(file)
    with pytest.raises(RecordingError, match=rf"{NAME}: byte {block.at}: the block is damaged"):
        recording.chunk_data(second)
    assert recording.chunk_data(recording.chunks[0].number)
    answer = request(application(recording), f"/recording/chunks/{second}")
    assert answer.status == 500
    assert b"is damaged" in answer.body


def hostile(path, about, what=blocks.CHUNK, data=b""):
    """A recording with a block that tells that of itself."""
    with path.open("wb") as opened:
        opened.write(blocks.MAGIC)
        blocks.write_block(opened, blocks.HEAD, {"protocol": protocol.VERSION, "about": {}})
        blocks.write_block(opened, blocks.SCENE, {"number": 1})
        blocks.write_block(opened, what, about, data)
    return path


GOOD = {"number": 2, "scene": 1, "begin": 0.0, "end": 1.0, "wall": None, "marks": []}


@pytest.mark.parametrize(
    ("about", "message"),
    [
        (GOOD | {"begin": "soon"}, "a number was expected, not 'soon'"),
        (GOOD | {"end": float("nan")}, "a number was expected, not nan"),
        (GOOD | {"begin": 5.0}, "times from -inf on were expected, not 5.0"),
        (GOOD | {"scene": 7}, "scene 7 has not come before"),
        (GOOD | {"marks": [3]}, "TypeError"),
        ({"number": 2}, "KeyError"),
        ([], "TypeError"),
        ("x" * 10, "TypeError"),
    ],
)
def test_an_index_that_can_not_be_is_refused(tmp_path, about, message):
    with pytest.raises(RecordingError, match=message):
        FileRecording(hostile(tmp_path / NAME, about))


def test_a_bomb_is_not_unpacked(monkeypatch, tmp_path):
    import zlib

    path = hostile(tmp_path / NAME, GOOD, data=zlib.compress(bytes(100_000)))
    monkeypatch.setattr("warehouse_viewer.replay.file.unpacked", lambda d: unpacked(d, 5000))
    with pytest.raises(RecordingError, match="5000 bytes at most were expected"):
        FileRecording(path).chunk_data(2)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "a recording was expected; this file is not one"),
        (b"#ROSBAG V2.0\n", "a recording was expected; this file is not one"),
        (blocks.MAGIC, "nothing is recorded in it; byte 8: it was cut off"),
        (blocks.MAGIC + bytes(40), "byte 8: a block was expected; the file is damaged"),
        (blocks.MAGIC + struct.pack("<4sIIQ", b"CHNK", 0, 9, 2**60), "beyond the end of the file"),
        (blocks.MAGIC + struct.pack("<4sIIQ", b"HEAD", 0, 3, 0) + b"{x}", "JSON was expected"),
    ],
)
def test_what_is_no_recording_says_so(tmp_path, content, message):
    path = tmp_path / NAME
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        open_recording(path, tmp_path)


def test_another_version_s_recording_is_refused(tmp_path):
    path = hostile(tmp_path / NAME, {"protocol": 1, "about": {}}, blocks.HEAD)
    with pytest.raises(RecordingError, match=f"protocol {protocol.VERSION} was expected, not 1"):
        FileRecording(path)


def test_a_folder_without_a_recording_says_what_was_expected(tmp_path):
    with pytest.raises(RecordingError, match="a folder of `simulate --record` was expected"):
        open_recording(tmp_path, tmp_path)
    with pytest.raises(RecordingError, match="no such file or folder"):
        open_recording(tmp_path / "none", tmp_path)


def test_a_page_gets_the_index_and_chunks_as_they_lie_there(file):
    app = application(FileRecording(file))
    index = json.loads(request(app, "/recording/index").body)
    assert (index["begin"], index["end"], index["live"]) == (0, 74.5, False)
    assert index["marks"] == [[40.1, "COLLISION", "kiva1", "x"]]
    number, scene, begin, *_ = index["chunks"][1]
    assert begin == LENGTH
    packed = request(app, f"/recording/chunks/{number}", headers={"accept-encoding": "deflate"})
    assert packed.headers["content-encoding"] == "deflate"
    plain = request(app, f"/recording/chunks/{number}")
    assert unpacked(packed.body) == plain.body
    assert json.loads(request(app, f"/recording/scenes/{scene}").body)["robots"] == [1, 2]
    assert request(app, "/recording/chunks/99").status == 404
    refused = request(app, "/api/v1/simulation/pause", method="POST")
    assert (refused.status, json.loads(refused.body)["detail"]) == (409, RECORDED)


def test_a_chunk_is_compressed_while_it_grows():
    """All of it as it came would be most of what the last hour of a large warehouse takes."""
    growing, update = OpenChunk(0, 0.0, None), bytes(range(250)) * 160
    for stamp in range(60):
        growing.add_update(float(stamp), update)
    parts = [p for kept in vars(growing).values() for p in (kept, *_members(kept))]
    taken = sum(len(part) for part in parts if isinstance(part, bytes | bytearray))
    assert taken <= growing.size < chunk.COMPRESSOR + len(update)
    now = messages(unpacked(growing.packed(1).data))
    growing.add_update(60.0, update)
    later = messages(unpacked(growing.packed(1).data))
    assert now == later[:-1] == [(chunk.UPDATE, float(stamp), update) for stamp in range(60)]


def test_what_goes_on_is_played_up_to_now():
    world = World()
    live = LiveRecording(world.model, Journal(), lambda: None)
    for stamp in np.arange(0, 40, 0.5):
        world.turn(fleet=fleet(x=(stamp, 1.0), stamp=float(stamp)))
        live.take()
    routes = {route.path: route for route in live.routes()}
    index = json.loads(request(_app(routes), "/recording/index").body)
    assert (index["live"], index["end"], len(index["chunks"])) == (True, 39.5, 2)
    data = request(_app(routes), f"/recording/chunks/{index['open']}").body
    assert messages(data)[-1][1] == 39.5
    assert 0 < live.size - live.store.size < chunk.COMPRESSOR + len(data)


def _members(kept):
    return kept if isinstance(kept, list | tuple) else ()


def _app(routes):
    from starlette.applications import Starlette

    return Starlette(routes=list(routes.values()))


def test_a_bag_is_converted_with_its_events(tmp_path):
    path = tmp_path / "shift.bag"
    with rosbag.Bag(str(path), "w") as bag:
        for topic, message in (("objects", objects()), ("scenery", scenery())):
            bag.write(f"/warehouse/{topic}", message, rospy.Time(1))
        bag.write("/warehouse/unit_states", states(), rospy.Time(1))
        for stamp in range(1, 40):
            bag.write("/warehouse/fleet", fleet(x=(stamp, 1.0), stamp=stamp), rospy.Time(stamp))
        blocked = Event(header=Header(stamp=rospy.Time(20)), kind=Event.BLOCKED, model="kiva1")
        bag.write("/warehouse/events", blocked, rospy.Time(20))
    recording = open_recording(path, tmp_path)
    assert (recording.chunks[0].begin, recording.chunks[-1].end) == (1, 39)
    assert [mark.kind for chunk in recording.chunks for mark in chunk.marks] == ["BLOCKED"]


def test_a_bag_with_nothing_to_play_says_what_is_missing(tmp_path):
    path = tmp_path / "empty.bag"
    with rosbag.Bag(str(path), "w") as bag:
        bag.write("/warehouse/fleet", fleet(), rospy.Time(1))
    with pytest.raises(RecordingError, match="nothing to play; at least /warehouse/objects"):
        open_recording(path, tmp_path)
    path.write_bytes(b"no bag")
    with pytest.raises(RecordingError, match="empty.bag"):
        open_recording(path, tmp_path)


def small_bag(path, compression):
    with rosbag.Bag(str(path), "w", compression=compression) as bag:
        for topic, message in (("objects", objects()), ("scenery", scenery())):
            bag.write(f"/warehouse/{topic}", message, rospy.Time(1))
        bag.write("/warehouse/unit_states", states(), rospy.Time(1))
        for stamp in range(1, 4):
            bag.write("/warehouse/fleet", fleet(x=(stamp, 1.0), stamp=stamp), rospy.Time(stamp))
    return path.read_bytes()


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_a_damaged_bag_is_played_or_refused_in_a_sentence(tmp_path, compression):
    path, chosen = tmp_path / "shift.bag", random.Random(1)
    whole = small_bag(path, compression)
    refused = 0
    for _ in range(120):
        damaged = bytearray(whole)
        at = chosen.randrange(len(damaged))
        damaged[at : at + 4] = chosen.choice((b"\xff" * 4, bytes(4), chosen.randbytes(4)))
        path.write_bytes(damaged)
        try:
            open_recording(path, tmp_path)
        except RecordingError as error:
            assert str(error).startswith(str(path))
            refused += 1
    assert refused > 20


def test_a_bag_whose_messages_are_not_sound_is_refused(tmp_path):
    path = tmp_path / "shift.bag"
    with rosbag.Bag(str(path), "w") as bag:
        bag.write("/warehouse/fleet", fleet(x=(math.nan, 1.0)), rospy.Time(3))
    with pytest.raises(RecordingError, match="/warehouse/fleet at 3.000 s: x is nan"):
        open_recording(path, tmp_path)


def run(name, *arguments):
    command = [sys.executable, NODES / name, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_a_shift_is_simulated_recorded_and_served(tmp_path):
    done = run("simulate", "--size", "small", "--minutes", 1, "--record", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert f"{tmp_path}/{NAME}: " in done.stdout
    command = [sys.executable, NODES / "replay", tmp_path, "--port", "0", "--no-browser"]
    # Without ROS: no master, and nothing that would tell where one is.
    environment = {n: v for n, v in os.environ.items() if not n.startswith("ROS_")}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as server:
        try:
            url = server.stdout.readline().split()[4]
            index = json.load(urllib.request.urlopen(f"{url}recording/index", timeout=20))
            assert faults_on_a_phone(url) == []
        finally:
            server.send_signal(signal.SIGINT)
        assert server.wait(20) in (0, -signal.SIGINT)
    assert index["about"]["name"] == "small"
    assert (index["begin"], round(index["end"])) == (0, 60)
    first = FileRecording(tmp_path / NAME).chunks[0]
    kinds = {
        item["kind"]
        for _, m in told(FileRecording(tmp_path / NAME), first.number)
        if m["type"] == "events"
        for item in m["events"]
    }
    assert "ACCEPTED" in kinds
    figures = [m for _, m in told(FileRecording(tmp_path / NAME), first.number) if "fleet" in m]
    assert set(figures[-1]["fleet"]["queues"]) == {
        figure["name"] for figure in figures[-1]["stations"]
    }
    assert sum(figures[-1]["fleet"]["work"].values()) == figures[-1]["fleet"]["robots"]["automatic"]


FIRST_VIEW = 300_000  # of the page until something is to be seen, compressed [bytes]
WEIGHT = """performance.getEntries().filter(({ name }) => !name.includes('/recording/'))
  .reduce((sum, { encodedBodySize = 0 }) => sum + encodedBodySize, 0)"""
WAYS = "document.getElementById('ways').checkVisibility()"


def faults_on_a_phone(url):
    """What axe and the console find on the page of a minute, through which a finger leads."""
    with browser(PATIENCE) as page:
        page.be_phone()
        page.open(url)
        page.until("page.timeline.player.chunk && page.stage.frames")
        assert 200_000 < page.read(WEIGHT) < FIRST_VIEW
        track = "document.getElementById('replay-track').getBoundingClientRect().toJSON()"
        box = page.read(track)
        at = lambda part: (box["left"] + part * box["width"], box["top"] + box["height"] / 2)  # noqa: E731
        page.swipe([at(0.1), at(0.4), at(0.75)])
        page.until("Math.abs(page.timeline.player.time - 45) < 1")
        page.until("document.getElementById('time').textContent.startsWith('0:00:45')")
        # What the coordinator knew then: queues at the stations, and nothing that is of now.
        assert page.read("page.signs.queues.pick1") >= 1 and not page.read("page.signs.changes")
        assert page.read("page.fleet.runs") and not page.read(WAYS)
        return page.complaints() + (axe.findings(page) if axe.is_there() else [])


@pytest.mark.long
def test_a_forecast_begins_at_the_moment_of_the_slider(tmp_path):
    done = run("simulate", "--size", "small", "--minutes", 3, "--record", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    options = ("--port", "0", "--no-browser", "--forecast-seconds", "1")
    command = [sys.executable, NODES / "replay", tmp_path, *options]
    with (
        subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server,
        browser(PATIENCE, (1280, 800)) as page,
    ):
        try:
            page.open(server.stdout.readline().split()[4] + "#t=120")
            page.until("page.timeline.player.chunk && page.timeline.player.time === 120")
            page.click_on("replay-forecast")
            page.until("document.getElementById('ahead-table').checkVisibility()")
            assert page.read(f"{TITLE}.textContent") == "Forecast from 0:02:00"
            assert page.read(f"{AHEAD}.length") == 6
            assert page.read(f"{AHEAD}[0].cells[0].textContent") == "0:12:00"
            assert "orders done within 60 minutes" in page.read(f"{TEXT}.textContent")
            page.type("+0 close pick9", "ahead-change")
            page.click_on("ahead-look")
            page.until(f"{TEXT}.textContent.includes('pick9; there are pick1')")
            assert not page.read("document.getElementById('ahead-table').checkVisibility()")
            assert page.complaints() == []
        finally:
            server.send_signal(signal.SIGINT)


TITLE, TEXT = "document.getElementById('ahead-title')", "document.getElementById('ahead-text')"
AHEAD = "document.getElementById('ahead-table').tBodies[0].rows"


@pytest.mark.parametrize(
    ("body", "text"),
    [
        (b"[1]", "a JSON object with at, minutes, runs, changes was expected"),
        (b"{", "a JSON object with at, minutes, runs, changes was expected"),
        (b'{"at": 1, "until": 2}', "until is unknown: a JSON object with at, minutes,"),
        (b"{}", r"at has to be the time of the shift \[s\]"),
        (b'{"at": true}', r"at has to be the time of the shift \[s\]"),
        (b'{"at": 1, "minutes": "an hour"}', "minutes has to be a number"),
        (b'{"at": 1, "runs": 1.5}', "runs is 1.5; a whole number was expected"),
        (b'{"at": 1, "changes": "close pick1"}', "changes has to be a list of events"),
    ],
)
def test_a_forecast_that_can_not_be_asked_for_says_what_was_expected(body, text):
    with pytest.raises(ForecastError, match=text):
        asked_of(body)


def test_a_recording_without_its_database_offers_no_forecast(file):
    assert RecordedForecasts.beside(file) is None


def test_ideal_robots_are_not_recorded(tmp_path):
    done = run("simulate", "--size", "small", "--no-physics", "--record", "--out", tmp_path)
    assert done.returncode == 1
    assert "simulate: --record: ideal robots have no place between two cells" in done.stderr


def test_replay_says_what_it_can_not_play(tmp_path):
    done = run("replay", tmp_path / "none")
    assert done.returncode == 1
    assert done.stderr == f"replay: {tmp_path / 'none'}: no such file or folder\n"
    assert "port -1: 0 to 65535 was expected" in run("replay", tmp_path, "--port", -1).stderr
