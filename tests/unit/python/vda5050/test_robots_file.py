# SPDX-License-Identifier: Apache-2.0
"""The file of robots behind a broker, and what is wrong with one."""

import pytest

from warehouse_vda5050.master.frame import Frame
from warehouse_vda5050.master.robots_file import RobotsFileError, read


def written(tmp_path, text):
    path = tmp_path / "robots.yaml"
    path.write_text(text)
    return path


def test_robots_are_read(tmp_path):
    text = "22: {manufacturer: acme, serial: '8'}\n21: {manufacturer: acme, serial: '7', origin: [4, 2, 1.5]}\n"
    first, second = read(written(tmp_path, text))
    assert (first.number, first.identity.serial, first.frame) == (21, "7", Frame(4, 2, 1.5))
    assert (second.number, second.frame) == (22, Frame())


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "robots were expected"),
        ("[1, 2]", "robots were expected"),
        ("21: {", "robots.yaml"),
        ("0: {manufacturer: a, serial: b}", "from 1 to"),
        ("x: {manufacturer: a, serial: b}", "must be whole"),
        ("21: acme", "manufacturer and serial were expected"),
        ("21: {manufacturer: a}", "serial must be a text, not None"),
        ("21: {manufacturer: a, serial: 7}", "put it in quotes"),
        ("21: {manufacturer: a, serial: 'b/c'}", "serial is 'b/c'"),
        ("21: {manufacturer: a, serial: b, orign: [0, 0, 0]}", "unknown field 'orign'"),
        ("21: {manufacturer: a, serial: b, origin: [0, 0]}", "origin must be [x, y, theta]"),
        ("21: {manufacturer: a, serial: b, origin: [0, 0, .nan]}", "origin must be"),
        ("21: {manufacturer: a, serial: b, action_parameters: 3}", "names with values"),
        ("21: {manufacturer: a, serial: b}\n22: {manufacturer: a, serial: b}", "are both a/b"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, text, why):
    with pytest.raises(RobotsFileError) as caught:
        read(written(tmp_path, text))
    assert why in str(caught.value)
    assert "robots.yaml" in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(RobotsFileError, match=r"robots\.yaml"):
        read(tmp_path / "robots.yaml")
