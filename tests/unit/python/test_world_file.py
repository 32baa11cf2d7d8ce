# SPDX-License-Identifier: Apache-2.0
"""What a world file adds to the world that runs."""

import pytest

from warehouse_sim.world_file import WorldFileError, find, insertable

WORLD = """<sdf version="1.9"><world name="w">
  <gravity>0 0 -9.81</gravity>
  <model name="ground_plane"><static>true</static></model>
  <include><uri>model://kiva</uri><name>kiva1</name></include>
  <include><uri>model://person</uri></include>
  <model name="crate"/>
</world></sdf>"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "w.sdf"
    path.write_text(WORLD)
    return path


def test_all_models_are_added(file):
    xml, names = insertable(file, standing=["kiva7"])
    assert names == ["ground_plane", "kiva1", "person", "crate"]
    assert 'name="ground_plane"' in xml


def test_the_floor_stays_at_home_where_there_is_one(file):
    xml, names = insertable(file, standing=["ground_plane"])
    assert names == ["kiva1", "person", "crate"]
    assert "ground_plane" not in xml
    assert "model://kiva" in xml


@pytest.mark.parametrize("world", ["w", "w.sdf"])
def test_found_by_name(file, world):
    assert find(world, file.parent, cwd="/") == file


def test_found_by_path(file):
    assert find(str(file), "/nowhere", cwd="/") == file
    assert find("w.sdf", "/nowhere", cwd=file.parent) == file


def test_not_found(tmp_path):
    with pytest.raises(
        WorldFileError, match="no world 'mars'; tried /a/mars, /b/mars, /b/mars.sdf"
    ):
        find("mars", "/b", cwd="/a")


@pytest.mark.parametrize(
    "text, words", [("<sdf", "is no XML: .*line 1"), ("<sdf/>", "holds no <sdf> with a <world>")]
)
def test_no_world_in_it(tmp_path, text, words):
    path = tmp_path / "bad.sdf"
    path.write_text(text)
    with pytest.raises(WorldFileError, match=f"bad.sdf {words}"):
        insertable(path, [])
