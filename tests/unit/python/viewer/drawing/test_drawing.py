# SPDX-License-Identifier: Apache-2.0
"""Pictures and films of the warehouse from above."""

import numpy as np
import pytest
import rosbag
import rospy
from PIL import Image
from sample_messages import fleet, objects, scenery, states

from warehouse_msgs.msg import Event
from warehouse_viewer.drawing import markers, recording
from warehouse_viewer.drawing.drawing import Drawing, Moment, bounds

FLOOR = [-2.0, 8.0, -3.0, 2.0]


def moment(**changes):
    floor = scenery()
    floor.floor = FLOOR
    parts = {"objects": objects(), "states": states(), "fleet": fleet(), "scenery": floor}
    return Moment(**parts | changes)


def pixels(what):
    drawing = Drawing(what, dpi=60)
    drawing.draw(what)
    return drawing.pixels()


def shows(picture, colour):
    """How many pixels have about that colour (each channel in 0…1)."""
    far = np.abs(picture / 255 - np.asarray(colour)[:3]).max(axis=2)
    return int((far < 0.02).sum())


def test_robots_have_the_colour_of_what_they_do():
    resting, _, working, _, needs_help = markers.COLOURS
    assert shows(pixels(moment()), resting) > shows(pixels(moment()), needs_help)
    stuck = pixels(moment(fleet=fleet(ended=(Event.BLOCKED, Event.BLOCKED))))
    assert shows(stuck, needs_help) > shows(pixels(moment()), needs_help) + 100
    loaded = fleet()
    loaded.shelf_id = [1] * len(loaded.kiva_id)
    assert shows(pixels(moment(fleet=loaded)), working) > shows(pixels(moment()), working) + 100


def test_a_robot_is_drawn_where_it_stands():
    near, far = pixels(moment()), pixels(moment(fleet=fleet(x=(0.0, 4.0))))
    differs = np.flatnonzero(np.any(near != far, axis=(0, 2)))
    width = near.shape[1]
    column = lambda x: (x - FLOOR[0]) / (FLOOR[1] - FLOOR[0]) * width  # noqa: E731
    assert column(0.5) < differs.min() < column(0.8)
    assert column(4.2) < differs.max() < column(4.6)


def test_the_floor_without_a_scenery_is_around_what_stands_there():
    x0, x1, *_ = bounds(moment(scenery=None))
    assert x0 < 0 and x1 > 5


def test_saves_a_picture(tmp_path):
    what = moment()
    drawing = Drawing(what, title="mine")
    drawing.draw(what)
    drawing.save(str(tmp_path / "a.png"))
    assert Image.open(tmp_path / "a.png").width > 500


def record(path, seconds=2.0):
    with rosbag.Bag(str(path), "w") as bag:
        for topic, message in (("objects", objects()), ("unit_states", states())):
            bag.write(f"/warehouse/{topic}", message, rospy.Time(1))
        bag.write("/warehouse/scenery", moment().scenery, rospy.Time(1))
        for stamp in np.arange(1.0, 1.0 + seconds, 0.1):
            bag.write("/warehouse/fleet", fleet(x=(stamp, 6.0), stamp=stamp), rospy.Time(stamp))
    return str(path)


def test_a_recording_is_read_at_even_steps(tmp_path):
    bag = record(tmp_path / "a.bag")
    stamps = [m.fleet.stamp.to_sec() for m in recording.moments(bag, 0.5)]
    assert stamps == pytest.approx([1.0, 1.5, 2.0, 2.5])


def test_a_recording_becomes_a_gif(tmp_path):
    path = str(tmp_path / "a.gif")
    recording.film(record(tmp_path / "a.bag"), path, speed=4, rate=10, dpi=40)
    assert Image.open(path).n_frames == 5


def test_an_mp4_needs_ffmpeg(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(recording.RecordingError, match=r"a\.mp4: .*apt install ffmpeg"):
        recording.film(record(tmp_path / "a.bag"), str(tmp_path / "a.mp4"), speed=4, rate=10)


def test_says_what_is_wrong_with_a_recording(tmp_path):
    empty = tmp_path / "empty.bag"
    rosbag.Bag(str(empty), "w").close()
    with pytest.raises(recording.RecordingError, match="record at least /warehouse/objects"):
        list(recording.moments(str(empty), 1.0))
    with pytest.raises(recording.RecordingError, match="nowhere.bag"):
        list(recording.moments(str(tmp_path / "nowhere.bag"), 1.0))
    noise = tmp_path / "noise.bag"
    noise.write_text("no bag at all\n")
    with pytest.raises(recording.RecordingError, match="noise.bag"):
        list(recording.moments(str(noise), 1.0))
