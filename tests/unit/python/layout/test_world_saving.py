# SPDX-License-Identifier: Apache-2.0
"""A world that runs becomes a file: each model's own text, at its present place."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from warehouse_layout.floor import poses
from warehouse_layout.models import sdf_world, world_saving
from warehouse_layout.models.world_saving import UNKNOWN, Standing

HALL = """<?xml version="1.0"?><sdf version="1.9"><world name="hall">
<gravity>0 0 -9.8</gravity>
<model name="wall1"><static>true</static><pose>1 2 0 0 0 0</pose><link name="l"/></model>
<include><uri>model://kiva</uri><name>kiva1</name></include>
<include><uri>beside.dae</uri><name>art</name></include>
<light name="sun" type="directional"/>
<state world_name="hall"><model name="kiva1"><pose>9 9 9 0 0 0</pose></model></state>
</world></sdf>"""
ALONE = '<sdf version="1.9"><model name="box"><link name="l"/></model></sdf>'


def at(x=0.0, y=0.0, yaw=0.0):
    return poses.planar(x, y, yaw)


def saved(*models, documents=(HALL, ALONE), folder="/nowhere"):
    from pathlib import Path

    return world_saving.text_of("mine", documents, models, Path(folder))


def pose_in(xml, name):
    world = sdf_world.parse(xml, "mine.sdf")
    return next(model.pose for model in world.models if model.name == name)


def test_models_keep_their_texts_and_stand_where_they_are():
    out = saved(
        Standing("wall1", 0, "wall1", at(1, 2), at(1, 2)),
        Standing("kiva7", 0, "kiva1", at(), at(3, 4, 0.5)),
        Standing("crate", 1, "box", at(), at(-1, 0)),
    )
    assert (out.models, out.left_out) == (3, [])
    root = ElementTree.fromstring(out.xml.partition("\n")[2])
    world = root[0]
    assert (root.tag, world.get("name")) == ("sdf", "mine")
    assert [sdf_world.name_of(e) for e in world if e.tag in ("model", "include")] == [
        "wall1",
        "kiva7",
        "crate",
    ]
    assert world.find("light") is not None and world.find("state") is None
    assert world.find("model[@name='wall1']/pose").text == "1 2 0 0 0 0"
    assert world.findtext("include/uri") == "model://kiva"
    np.testing.assert_allclose(pose_in(out.xml, "kiva7"), at(3, 4, 0.5), atol=1e-6)
    np.testing.assert_allclose(pose_in(out.xml, "crate"), at(-1, 0), atol=1e-6)


def test_any_orientation_is_kept():
    turned = np.array([1, 2, 3, *world_saving._quaternion(0.3, -0.7, 2.5)])
    out = saved(Standing("kiva1", 0, "kiva1", at(), turned))
    np.testing.assert_allclose(pose_in(out.xml, "kiva1"), turned, atol=1e-6)


def test_a_placement_frame_is_taken_into_account():
    """The text's pose places a frame of the model that is 1 m beside the model itself."""
    out = saved(Standing("wall1", 0, "wall1", at(2, 2), at(10, 0, np.pi / 2)))
    np.testing.assert_allclose(pose_in(out.xml, "wall1")[:2], [10, -1], atol=1e-6)


def test_what_has_no_text_is_named():
    urdf = '<robot name="r"/>'
    out = saved(
        Standing("person4", UNKNOWN, "", at(), at()),
        Standing("rover", 2, "r", at(), at()),
        Standing("gone", 1, "other", at(), at()),
        documents=(HALL, ALONE, urdf),
    )
    assert (out.models, out.left_out) == (0, ["person4", "rover", "gone"])


def test_without_the_worlds_own_text_an_empty_one_stands_around():
    out = saved(Standing("crate", 1, "box", at(), at(1, 1)), documents=("", ALONE))
    assert out.models == 1
    assert sdf_world.parse(out.xml, "mine.sdf").models[0].name == "crate"


def test_files_beside_the_old_world_get_whole_paths(tmp_path):
    (tmp_path / "beside.dae").touch()
    out = saved(Standing("art", 0, "art", at(), at()), folder=tmp_path)
    assert f"<uri>{tmp_path}/beside.dae</uri>" in out.xml


@pytest.mark.parametrize("pose", ["1 2", "a b c d e f", ""])
def test_a_pose_that_can_not_be_read_is_replaced(pose):
    text = ALONE.replace('<model name="box">', f'<model name="box"><pose>{pose}</pose>')
    out = saved(Standing("box", 1, "box", at(5, 5), at(1, 1)), documents=(HALL, text))
    assert out.models == 1
