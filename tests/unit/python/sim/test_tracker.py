# SPDX-License-Identifier: Apache-2.0
"""What the tracking nodes publish, and when they don't."""

import resource
from types import SimpleNamespace

import pytest
import rospy
from fake_ros import FakeRos
from geometry_msgs.msg import PoseStamped
from rospy.topics import _PublisherImpl

from warehouse_client import tracking
from warehouse_client.latest import LatestMessages, LazyPublisher
from warehouse_layout.floor import poses
from warehouse_msgs.msg import TrackedObjects, UnitStates, WarehouseObjects
from warehouse_sim import tracker


@pytest.fixture
def ros():
    return FakeRos()


def pose_topics(ros, limit=100, **options):
    def advertise(topic):
        return ros.Publisher(topic, PoseStamped)

    return tracker.PoseTopics("/units", advertise, limit, **{"linger": 0, **options})


def scene(*xs, names=None, stamp=0):
    """Units in a row at those x; the message pair that tells of them."""
    names = names or [f"storage_unit{i + 1}" for i in range(len(xs))]
    objects, states = WarehouseObjects(storage_units=names), UnitStates()
    states.header.stamp = rospy.Time(stamp)
    states.pose = [v for x in xs for v in poses.planar(x, 0, 0)]
    states.carrier = [0] * len(xs)
    return objects, states


def sent(ros):
    """How many messages went to each pose topic."""
    return {topic: len(publisher.sent) for topic, publisher in ros.publishers.items()}


def test_only_what_moves_is_published(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros))
    assert follow.update(*scene(1, 2)) == (True, False)
    assert follow.update(*scene(1, 2)) == (False, False)
    assert follow.update(*scene(1, 3, stamp=7)) == (True, False)
    assert sent(ros) == {"/units/storage_unit1/pose": 1, "/units/storage_unit2/pose": 2}
    message = ros.publishers["/units/storage_unit2/pose"].sent[-1]
    assert (message.pose.position.x, message.header.frame_id) == (3, "world")
    assert message.header.stamp == rospy.Time(7)


def test_an_empty_warehouse_is_told_of(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros))
    assert follow.message() is None
    assert follow.update(*scene()) == (True, False)
    assert follow.message().objects == []


def test_topics_go_with_their_objects(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros))
    follow.update(*scene(1, 2))
    differs, _ = follow.update(*scene(1))
    assert differs
    assert ros.publishers["/units/storage_unit1/pose"].open
    assert not ros.publishers["/units/storage_unit2/pose"].open
    assert [o.name for o in follow.message().objects] == ["storage_unit1"]


def test_a_name_that_comes_back_gets_its_topic_back(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros))
    for xs in ((1, 2), (1,), (1, 2)):
        follow.update(*scene(*xs))
    publisher = ros.publishers["/units/storage_unit2/pose"]
    assert publisher.open
    assert len(publisher.sent) == 1


def test_topics_outlive_a_warehouse_that_is_created_again(ros):
    now = 0.0
    topics = pose_topics(ros, linger=5, clock=lambda: now)
    follow = tracker.Tracker(tracking.StorageUnits, topics)
    follow.update(*scene(1, 2))
    publishers = dict(ros.publishers)
    assert follow.update(*scene()) == (True, False)
    now = 4.9
    assert follow.go_on() is False
    follow.update(*scene(1, 3))
    now = 20.0
    follow.go_on()
    assert ros.publishers == publishers  # none was advertised again
    assert [p.open for p in publishers.values()] == [True, True]
    assert sent(ros) == {"/units/storage_unit1/pose": 2, "/units/storage_unit2/pose": 2}
    follow.update(*scene(1))
    now = 25.0
    assert follow.go_on() is False
    assert [p.open for p in publishers.values()] == [True, False]


def test_thousands_of_topics_come_in_batches(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros, limit=1000))
    crowd = scene(*range(tracker.BATCH + 5))
    assert follow.update(*crowd) == (True, True)
    assert len(ros.publishers) == tracker.BATCH
    assert follow.go_on() is False
    assert set(sent(ros).values()) == {1}
    assert len(ros.publishers) == tracker.BATCH + 5


def test_topics_that_linger_make_room(ros):
    topics = pose_topics(ros, limit=2, linger=5, clock=lambda: 0.0)
    follow = tracker.Tracker(tracking.StorageUnits, topics)
    follow.update(*scene(1, 2))
    follow.update(*scene(3, 4, names=["storage_unit3", "storage_unit2"]))
    assert {t: p.open for t, p in ros.publishers.items()} == {
        "/units/storage_unit1/pose": False,
        "/units/storage_unit2/pose": True,
        "/units/storage_unit3/pose": True,
    }


def test_a_topic_that_goes_gives_its_file_back():
    """rospy itself keeps it until garbage is collected."""
    impl = _PublisherImpl("/units/storage_unit1/pose", PoseStamped)
    poller = impl.connection_poll.poller
    publisher = SimpleNamespace(impl=impl, publish=impl.publish, unregister=impl.close)
    tracker.PoseTopic(SimpleNamespace(Publisher=lambda *_, **__: publisher), "").unregister()
    assert poller.closed


def test_no_more_topics_than_allowed(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros, limit=2))
    follow.update(*scene(1, 2, 3))
    follow.update(*scene(1, 2, 4))
    assert len(ros.publishers) == 2
    assert len(follow.message().objects) == 3


@pytest.mark.parametrize(
    "limits, allowed, raised",
    [
        ((1024, 4096), 1000, (1500, 4096)),
        ((1024, 1200), 700, (1200, 1200)),
        ((1024, resource.RLIM_INFINITY), 1000, (1500, resource.RLIM_INFINITY)),
        ((4096, 4096), 1000, None),
        ((100, 100), 0, (100, 100)),
    ],
)
def test_each_topic_needs_a_file(monkeypatch, limits, allowed, raised):
    calls = []
    monkeypatch.setattr(resource, "getrlimit", lambda _: limits)
    monkeypatch.setattr(resource, "setrlimit", lambda _, new: calls.append(new))
    assert tracker.topics_allowed(1000) == allowed
    assert calls == ([raised] if raised else [])


def test_the_list_is_up_to_date_however_seldom_it_is_read(ros):
    follow = tracker.Tracker(tracking.StorageUnits, pose_topics(ros))
    for xs in ((1, 2), (1, 3), (4, 3)):
        follow.update(*scene(*xs))
    assert [o.pose.position.x for o in follow.message().objects] == [4, 3]


def test_nothing_is_made_that_nobody_reads(ros):
    asked = []
    listing = LazyPublisher(
        ros, "/units", TrackedObjects, lambda: asked.append(1) or TrackedObjects()
    )
    listing.publish()
    assert not asked
    publisher = ros.publishers["/units"]
    publisher.connect()
    assert len(publisher.sent) == 1
    listing.publish()
    assert len(publisher.sent) == 2


def test_nothing_is_sent_before_there_is_anything_to_tell(ros):
    LazyPublisher(ros, "/units", TrackedObjects, lambda: None)
    ros.publishers["/units"].connect()
    assert ros.publishers["/units"].sent == []


def test_messages_that_do_not_fit_each_other_are_waited_out(ros):
    newest = LatestMessages(ros, objects=("/o", WarehouseObjects), states=("/s", UnitStates))
    assert newest.units_and_objects is None
    ros.callbacks["/o"](WarehouseObjects(revision=2))
    ros.callbacks["/s"](UnitStates(revision=1))
    assert newest.units_and_objects is None
    ros.callbacks["/s"](UnitStates(revision=2))
    assert newest.units_and_objects == (newest["objects"], newest["states"])


def test_waiting_ends_with_a_message_or_the_time(ros):
    newest = LatestMessages(ros, states=("/s", UnitStates))
    assert not newest.wait(0)
    ros.callbacks["/s"](UnitStates())
    assert newest.wait(0)
    assert not newest.wait(0)
