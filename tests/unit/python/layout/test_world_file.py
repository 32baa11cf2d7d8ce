# SPDX-License-Identifier: Apache-2.0
"""What a world file adds to the world that runs."""

import xml.etree.ElementTree as ElementTree

import pytest

from warehouse_layout.models.world_file import WorldFileError, find, insertable

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
    loaded = insertable(file, standing=["kiva7"])
    assert loaded.names == ["ground_plane", "kiva1", "person", "crate"]
    assert 'name="ground_plane"' in loaded.xml
    assert (loaded.renamed, loaded.left_out) == ({}, [])


def test_the_floor_stays_at_home_where_there_is_one(file):
    loaded = insertable(file, standing=["ground_plane"])
    assert loaded.names == ["kiva1", "person", "crate"]
    assert loaded.left_out == ["ground_plane"]
    assert "ground_plane" not in loaded.xml
    assert "model://kiva" in loaded.xml


@pytest.mark.parametrize(
    "second",
    [
        '<model name="ground_plane"/>',
        "<include><uri>model://ground_plane</uri></include>",
        "<include><uri>model://ground_plane</uri><name>floor</name></include>",
        "<include><uri>https://fuel.example/models/ground_plane/</uri></include>",
    ],
)
def test_of_several_floors_one_is_enough(tmp_path, second):
    path = tmp_path / "w.sdf"
    path.write_text(WORLD.replace("</world>", f"{second}</world>"))
    assert insertable(path, []).names == ["ground_plane", "kiva1", "person", "crate"]
    assert insertable(path, ["ground_plane"]).names == ["kiva1", "person", "crate"]


def test_what_is_numbered_takes_free_numbers(tmp_path):
    path = tmp_path / "w.sdf"
    path.write_text("""<sdf version="1.9"><world name="w">
      <include><uri>model://kiva</uri><name>kiva1</name></include>
      <include><uri>model://kiva</uri><name>kiva3</name></include>
      <model name="storage_unit1"><pose relative_to="kiva1">1 0 0 0 0 0</pose></model>
    </world></sdf>""")
    loaded = insertable(path, ["kiva1", "kiva2", "storage_unit1", "storage_unit2"])
    assert loaded.names == ["kiva4", "kiva3", "storage_unit3"]
    assert loaded.renamed == {"kiva1": "kiva4", "storage_unit1": "storage_unit3"}
    world = ElementTree.fromstring(loaded.xml).find("world")
    assert [i.findtext("name") for i in world.iter("include")] == ["kiva4", "kiva3"]
    assert world.find("model").get("name") == "storage_unit3"
    assert world.find("model/pose").get("relative_to") == "kiva4"


def test_what_exists_already_is_named(file):
    with pytest.raises(WorldFileError, match="w.sdf: nothing was added.* already: crate, person$"):
        insertable(file, ["person", "kiva1", "crate", "ground_plane"])


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
    "text, words", [("<sdf", "is not XML: .*line 1"), ("<sdf/>", "holds no <sdf> with a <world>")]
)
def test_no_world_in_it(tmp_path, text, words):
    path = tmp_path / "bad.sdf"
    path.write_text(text)
    with pytest.raises(WorldFileError, match=f"bad.sdf {words}"):
        insertable(path, [])
