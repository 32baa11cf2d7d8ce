# SPDX-License-Identifier: Apache-2.0
"""The warehouse's page of an environment: what it is served, and that it changes nothing."""

import json
import socket
import threading
import urllib.error
import urllib.request

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="scripts/learning_packages brings it from PyPI")

from wsproto import ConnectionType, WSConnection  # noqa: E402
from wsproto.events import BytesMessage, Ping, Request, TextMessage  # noqa: E402

import warehouse_learning  # noqa: E402
from warehouse_learning import episodes, rware, watch  # noqa: E402
from warehouse_learning.marl import policy  # noqa: E402
from warehouse_learning.page import Page  # noqa: E402
from warehouse_learning.warehouses import Warehouses  # noqa: E402
from warehouse_viewer.page import protocol  # noqa: E402

PATIENCE = 60  # with a machine that has much to do [s, wall]
PAUSED = 0.3  # that nothing happens [s, wall]
STAMP, COUNT, HEAD = 8, 20, 40  # places in an update, of warehouse_viewer.protocol
RAYS = 32  # and in a scan
STAY, FORWARD, LEFT = 0, 1, 2


class Browser:
    """Who opens the page, as far as its WebSocket goes."""

    def __init__(self, url):
        host = url.split("/")[2]
        name, port = host.split(":")
        self._socket = socket.create_connection((name, int(port)), timeout=PATIENCE)
        self._connection = WSConnection(ConnectionType.CLIENT)
        self._socket.sendall(self._connection.send(Request(host=host, target="/live")))
        self._part, self._texts = None, {}
        self.time, self.robots, self.events = 0.0, {}, set()  # (x, y) by index; kinds
        self.scans = {}  # (rays,) [m] by robot

    def until(self, holds):
        """Reads until holds() does."""
        while not holds():
            data = self._socket.recv(1 << 16)
            assert data, "the page's server has closed the connection"
            self._connection.receive_data(data)
            for event in self._connection.events():
                self._take(event)

    def told(self, kind):
        """The newest message of that type."""
        self.until(lambda: kind in self._texts)
        return self._texts[kind]

    def watch(self, **wishes):
        """Asks for extras, such as scans=[ids]."""
        self._send({"watch": wishes})

    def close(self):
        self._socket.close()

    def _send(self, message):
        self._socket.sendall(self._connection.send(TextMessage(json.dumps(message))))

    def _take(self, event):
        if isinstance(event, Ping):
            self._socket.sendall(self._connection.send(event.response()))
        if not isinstance(event, TextMessage | BytesMessage):
            return
        self._part = event.data if self._part is None else self._part + event.data
        if event.message_finished:
            (self._hear if isinstance(event, TextMessage) else self._see)(self._part)
            self._part = None

    def _hear(self, text):
        message = json.loads(text)
        self._texts[message["type"]] = message
        self.events |= {event["kind"] for event in message.get("events", [])}

    def _see(self, update):
        """Takes an update in, and answers as a page does."""
        if update[0] == protocol.SCAN:
            self.scans[int(np.frombuffer(update, "<u4", 1, 4)[0])] = np.frombuffer(
                update, "<f4", -1, RAYS
            )
            return
        self._send({"ack": 1})
        self.time = float(np.frombuffer(update, "<f8", 1, STAMP)[0])
        count = int(np.frombuffer(update, "<u4", 1, COUNT)[0])
        for row in np.frombuffer(update, protocol.ROBOT, count, HEAD):
            self.robots[int(row["index"])] = float(row["x"]), float(row["y"])


def get(url):
    with urllib.request.urlopen(url, timeout=PATIENCE) as answer:
        return answer.read()


def post(url, **body):
    head = {"content-type": "application/json"}
    request = urllib.request.Request(url, json.dumps(body).encode(), head, method="POST")
    return get(request)


@pytest.fixture
def watched():
    """(environment, its page)."""
    env = warehouse_learning.parallel_env(size="tiny", render_mode="human")
    env.reset(seed=1)
    post(f"{env.page.url}api/v1/simulation/speed", factor=0)
    yield env, env.page
    env.close()


def test_the_page_has_its_files_and_the_warehouse(watched):
    env, page = watched
    for path in ("", "web/js/main.js", "web/design.css", "three/build/three.module.js"):
        assert get(page.url + path)
    browser = Browser(page.url)
    scene = browser.told("scene")
    assert scene["robots"] == [1, 2, 3] and len(scene["units"]) == 12 and scene["paint"]
    shapes = [link["shapes"] for link in scene["looks"][scene["robot_look"]]]
    assert any(shapes)
    status = browser.told("status")
    assert not status["away"] and status["lacks"]["reset"] and status["warehouse"] == "tiny"
    with pytest.raises(urllib.error.HTTPError, match="409"):
        post(f"{page.url}api/v1/robots/1/commands", command="ROT")
    browser.close()


def test_who_looks_sees_what_robots_do_and_nothing_changes_by_it(watched):
    env, page = watched
    alone = warehouse_learning.parallel_env(size="tiny")
    alone.reset(seed=1)
    browser = Browser(page.url)
    browser.told("scene")
    for action in (LEFT, FORWARD, FORWARD):
        actions = dict.fromkeys(env.agents, action)
        poses, expected = env.step(actions)[0], alone.step(actions)[0]
        assert all((poses[a] == expected[a]).all() for a in expected)
    fleet = env.world.fleet
    browser.until(lambda: "DONE" in browser.events and browser.time >= env.world.time - 1e-9)
    poses = [browser.robots[i] for i in range(3)]
    np.testing.assert_allclose(poses, np.stack([fleet.x, fleet.y], 1), atol=1e-4)
    browser.close()


def test_a_pause_holds_the_environment(watched):
    env, page = watched
    simulation = f"{page.url}api/v1/simulation/"
    post(simulation + "pause")
    stepping = threading.Thread(target=env.step, args=(dict.fromkeys(env.agents, LEFT),))
    stepping.start()
    stepping.join(PAUSED)
    assert stepping.is_alive()
    post(simulation + "resume")
    stepping.join(PATIENCE)
    assert not stepping.is_alive()


def test_a_saved_episode_is_played_as_it_was(tmp_path):
    env = warehouse_learning.parallel_env(size="tiny")
    env.reset(seed=3)
    for action in (LEFT, FORWARD, LEFT, FORWARD):
        env.step(dict.fromkeys(env.agents, action))
    env.save_episode(tmp_path / "episode.json")
    options, seed, actions = episodes.load(tmp_path / "episode.json")
    warehouses = Warehouses(1, options)
    warehouses.reset([0], [seed])
    page = Page(warehouses.worlds[0], options.title, speed=0)
    browser = Browser(page.url)
    browser.told("scene")
    watch.play(page, warehouses, actions)
    assert warehouses.worlds[0].state_hash() == env.world.state_hash()
    browser.until(lambda: browser.time >= env.world.time - 1e-9)
    browser.close()
    page.close()


def test_a_trained_policy_drives_on_the_page():
    trained = policy.load("tiny-4ag")
    env = rware.Warehouse(physics="bodies", **rware.options_of("tiny-4ag") | {"max_steps": 60})
    env.reset(seed=1)
    page = Page(env.motion.worlds[0], "tiny-4ag", speed=0)
    browser = Browser(page.url)
    try:
        assert len(browser.told("scene")["units"]) == 32
        assert watch.drive(page, env, trained, seed=1) >= 1
        browser.until(lambda: browser.time >= env.motion.time[0] - 1e-9)
        assert sorted(browser.told("requested")["units"]) != []
    finally:
        browser.close()
        page.close()


def sees_something(env):
    """(id, ranges [m]) of a robot with something in its laser's sight, once robots have turned."""
    while True:
        ranges = env.world.scans()
        seeing = np.flatnonzero((ranges < 5).any(axis=1))
        if len(seeing):
            return int(env.world.fleet.kiva_id[seeing[0]]), ranges[seeing[0]]
        env.step(dict.fromkeys(env.agents, LEFT))


def test_requests_and_lasers_are_shown():
    env = warehouse_learning.parallel_env(size="tiny", lasers=True, render_mode="human")
    env.reset(seed=1)
    browser = Browser(env.page.url)
    try:
        post(f"{env.page.url}api/v1/simulation/speed", factor=0)
        requested = browser.told("requested")["units"]
        assert len(requested) == 3
        assert requested == env._in.units_requested(0)
        robot, ranges = sees_something(env)
        browser.watch(scans=[robot])
        while not np.array_equal(browser.scans.get(robot), ranges):
            env.step(dict.fromkeys(env.agents, STAY))
            browser.until(lambda: browser.time >= env.world.time - 1e-9)
            ranges = env.world.scans([robot])[0]
        assert ranges.shape == (121,)
    finally:
        browser.close()
        env.close()
