# SPDX-License-Identifier: Apache-2.0
"""What the page and the HTTP API tell of a coordinated fleet, and what they ask of it."""

import asyncio
import struct
from types import SimpleNamespace

import numpy as np
import pytest
import rospy
from fake_hub import FakeFeed, Socket, hub_of
from fake_ros import FakeRos
from pydantic import ValidationError
from sample_messages import World, coordinator_state, fleet

from warehouse_msgs.msg import CoordinatorPaths, TransportEvent
from warehouse_viewer.api.schemas import fleet as fleet_schemas
from warehouse_viewer.api.transport_book import TransportBook
from warehouse_viewer.page import protocol
from warehouse_viewer.page.hub import Page
from warehouse_viewer.ros import feed as feeds
from warehouse_viewer.ros.coordination import NONE_RUNS, Coordination
from warehouse_viewer.ros.feed import Feed
from warehouse_viewer.ros.simulation import RefusedError
from warehouse_viewer.rviz import fleet_ways
from warehouse_viewer.rviz.picture import way_shapes


def paths(stamp=1.0):
    """Robot 1 has been released two points and plans two, robot 2 stands and waits for it."""
    return CoordinatorPaths(
        stamp=rospy.Time(stamp),
        kiva_id=np.array([1, 2]),
        released=np.array([2, 1]),
        planned=np.array([2, 0]),
        x=np.array([0.0, 1, 2, 2, 5]),
        y=np.array([0.0, 0, 0, 1, 5]),
        waits_for=np.array([0, 1]),
        goal_x=np.array([2, np.nan]),
        goal_y=np.array([9, np.nan]),
    )


def test_ways_are_of_the_wanted_robots_and_as_described():
    whole, part = protocol.ways(paths()), protocol.ways(paths(), {2})
    assert struct.unpack_from("<II", whole) == (protocol.WAYS, 2)
    assert len(whole) == 8 + 2 * 24 + 5 * 8
    assert struct.unpack_from("<II", part) == (protocol.WAYS, 1)
    row = np.frombuffer(part, protocol.WAY, 1, 8)[0]
    assert (row["kiva_id"], row["waits_for"], row["released"], row["planned"]) == (2, 1, 1, 0)
    assert np.isnan(row["goal"]).all()
    assert np.frombuffer(part, "<f4", 2, 8 + 24).tolist() == [5, 5]


def test_a_page_is_told_of_the_fleet_once_and_of_its_end():
    async def scenario():
        socket, hub = Socket(), hub_of(World())
        page = Page(socket, 0)
        running = coordinator_state(manual_kiva=[3], waiting_kiva=[4], waiting_for=[0])
        for newest in (None, running, None):
            hub._feed.coordinator = newest
            await hub._send_changes(page)
            await hub._send_changes(page)
        first, last = socket.texts
        assert first["fleet"]["manual"] == [3]
        assert last == {"type": "fleet", "fleet": None}

    asyncio.run(scenario())


def test_a_page_gets_the_ways_that_it_wants():
    async def scenario():
        socket, hub = Socket(), hub_of(World())
        page, asked = Page(socket, 0), []
        hub._pages.add(page)
        hub._feed = FakeFeed(ways=paths())
        hub._feed.subscribe_extras = lambda paths, ways, scans: asked.append(ways)
        for wish in ([], [2], "all"):
            await hub._handle(page, {"watch": {"ways": wish}})
            await hub._send_changes(page)
            await hub._send_changes(page)
        assert asked == [False, True, True]
        assert socket.updates == [protocol.ways(paths(), {2}), protocol.ways(paths())]

    asyncio.run(scenario())


class Subscriber(SimpleNamespace):
    def unregister(self):
        pass


class Ros(FakeRos):
    """Lasts as long as a coordinator is connected."""

    coordinators = 1

    def Subscriber(self, topic, *args, **options):  # noqa: N802 (rospy's name)
        super().Subscriber(topic, *args, **options)
        return Subscriber(get_num_connections=lambda: self.coordinators)


@pytest.fixture
def ros(monkeypatch):
    ros = Ros()
    ros.wall = 100.0
    monkeypatch.setattr(feeds.time, "monotonic", lambda: ros.wall)
    ros.feed = Feed(ros, print, print, lambda: None)
    ros.feed.subscribe()
    return ros


def test_a_coordinator_that_is_silent_or_gone_is_none(ros):
    ros.callbacks["warehouse/coordinator"](coordinator_state(1.0, automatic=2))
    ros.callbacks["warehouse/fleet"](fleet(stamp=60.0))
    assert ros.feed.coordinator.automatic == 2  # time passes fast
    ros.wall += feeds.SILENT + 1
    assert ros.feed.coordinator is None
    ros.callbacks["warehouse/fleet"](fleet(stamp=1.5))
    assert ros.feed.coordinator  # time stands still
    ros.coordinators = 0
    assert ros.feed.coordinator is None


def test_one_that_refuses_the_floor_says_so_as_long_as_it_lives(ros):
    ros.callbacks["warehouse/coordinator"](coordinator_state(1.0, alarms=["a deadlock"]))
    ros.callbacks["warehouse/fleet"](fleet(stamp=60.0))
    ros.wall += feeds.SILENT + 1
    assert ros.feed.coordinator.alarms == ["a deadlock"]


def event(number, kind, **fields):
    return TransportEvent(transport_id=number, kind=kind, shelf_id=7, **fields)


def test_the_book_tells_how_far_transports_are():
    book = TransportBook(kept=2)
    for number in (1, 2, 3):
        book.add(event(number, TransportEvent.RECEIVED, station="pick1"))
    book.add(event(3, TransportEvent.ASSIGNED, kiva_id=4))
    assert [t["id"] for t in book.newest_first()] == [3, 2]
    assert [t["id"] for t in book.newest_first("RECEIVED")] == [2]
    assert fleet_schemas.Transport(**book.get(3)).robot == "kiva4"
    assert book.get(1) is None


def test_another_coordinator_begins_another_book():
    book = TransportBook()
    for number in (1, 2, 1):
        book.add(event(number, TransportEvent.RECEIVED))
    assert [t["id"] for t in book.newest_first()] == [1]


@pytest.mark.parametrize(
    "fields", [{}, {"x": 1.0}, {"station": "pick1", "x": 1.0, "y": 2.0}, {"y": 2.0}]
)
def test_a_transport_needs_one_destination(fields):
    with pytest.raises(ValidationError, match="either a station or both x and y"):
        fleet_schemas.NewTransport(storage_unit=1, **fields)
    fleet_schemas.NewTransport(storage_unit=1, x=1.0, y=2.0)
    fleet_schemas.NewTransport(storage_unit=1, station="pick1")


def test_without_a_coordinator_it_is_said_what_to_do():
    ros = FakeRos()
    ros.get_master = lambda: SimpleNamespace(lookupService=lambda name: (-1, "unknown", ""))
    with pytest.raises(RefusedError, match=NONE_RUNS):
        Coordination(ros).release(3)


# --- in RViz
def test_segments_are_released_or_planned():
    released, planned = fleet_ways.released_and_planned(paths())
    assert released.tolist() == [[[0, 0], [1, 0]]]
    assert planned.round(6).tolist() == [[[1.3, 0], [1.7, 0]], [[2, 0.3], [2, 0.7]]]
    (tie,) = fleet_ways.ties(paths(), {1: (0, 0), 2: (5, 5)})
    assert tie.tolist() == [[5, 5], [0, 0]]


def test_markers_show_ways_while_somebody_coordinates():
    def points(now, coordinated):
        shapes = way_shapes(fleet(stamp=now), None, coordinated)
        return {shape.name: len(shape.points) for shape in shapes}

    assert points(1.5, paths()) == {"paths": 0, "released": 2, "planned": 4, "waits for": 2}
    assert set(points(9.0, paths()).values()) == set(points(9.0, None).values()) == {0}
