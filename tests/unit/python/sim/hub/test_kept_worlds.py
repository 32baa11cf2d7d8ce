# SPDX-License-Identifier: Apache-2.0
"""Worlds by name: those of the package, and those that were saved."""

import pytest

from warehouse_sim.hub.wish import WishError
from warehouse_sim.hub.worlds import Taken, UnknownWorld, Worlds

SDF = '<sdf version="1.9"><world name="a"><model name="m"><link name="l"/></model></world></sdf>'


def test_a_saved_world_has_a_name(tmp_path):
    worlds = Worlds(tmp_path / "worlds")
    worlds.save("mine", SDF)
    assert worlds.names()[0] == "mine" and "paper" in worlds.names()
    assert worlds.text("mine") == SDF
    assert worlds.resolved("mine") == str(tmp_path / "worlds/mine.sdf")
    assert worlds.resolved("paper") == "paper"
    assert worlds.rows()[0]["saved"]
    with pytest.raises(Taken, match="replace: true"):
        worlds.save("mine", SDF)
    worlds.save("mine", SDF.replace("m", "m", 1), True)
    worlds.delete("mine")
    assert "mine" not in worlds.names()


@pytest.mark.parametrize(
    "name, text, field, reason",
    [
        ("My Hall", SDF, "world", "small letters"),
        ("../x", SDF, "world", "small letters"),
        (None, SDF, "world", "small letters"),
        ("mine", None, "text", "text of an SDF world"),
        ("mine", "<robot/>", "text", "<world> was expected"),
        ("mine", "no xml", "text", "not XML"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, name, text, field, reason):
    with pytest.raises(WishError, match=reason) as error:
        Worlds(tmp_path).save(name, text)
    assert error.value.field == field
    assert not [*tmp_path.iterdir()]


def test_worlds_of_the_package_stay(tmp_path):
    worlds = Worlds(tmp_path)
    for act in (lambda: worlds.save("paper", SDF, True), lambda: worlds.delete("paper")):
        with pytest.raises(Taken, match="comes with the warehouse"):
            act()
    for act in (worlds.text, worlds.delete):
        with pytest.raises(UnknownWorld, match="no world 'mars'"):
            act("mars")
