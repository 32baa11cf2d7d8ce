# SPDX-License-Identifier: Apache-2.0
"""The table of RAWSim-O's instances: ours beside what footprints of RAWSim-O say."""

import subprocess
import sys

import pytest
from instance_file import write_instance
from paths import ROOT

sys.path.insert(0, str(ROOT / "bench"))

import footprints  # noqa: E402


def line(robots=16, seconds=300, pieces=44, settings=""):
    """A run's footprint.csv: figures in their places among zeros."""
    values = ["0"] * footprints.ENTRIES
    values[:2] = "a", settings
    values[14], values[16], values[35], values[44] = map(str, (seconds, robots, pieces, 123.5))
    return ";".join(values)


def table(*arguments):
    """Runs the program; returns what it prints, and its errors."""
    run = subprocess.run(
        ["/usr/bin/python3", ROOT / "bench" / "rawsim_table", *map(str, arguments)],
        capture_output=True,
        check=False,
        text=True,
        timeout=300,
    )
    return run.stdout, run.stderr


def test_a_footprint_without_a_header_and_a_collection_with_one(tmp_path):
    alone = tmp_path / "footprint.csv"
    alone.write_text(line() + "\n")
    (first,) = footprints.read(alone)
    assert (first.instance, first.robots, first.seconds) == ("a", 16, 300)
    assert first.figures[0] == 44 and first.figures[2] == 123.5
    names = [entry for entry, _ in [*footprints.KEYS.values(), *footprints.FIGURES.values()]]
    many = tmp_path / "footprints.csv"
    many.write_text(";".join(names) + "\nb;few;600;8;1;2;3;4;5;6\n")
    (second,) = footprints.read(many)
    assert second == ("b", "few", 8, 600, (1, 2, 3, 4, 5, 6))


@pytest.mark.parametrize(
    "text, message",
    [
        ("", "it is empty"),
        ("1;2;3", ":1: 3 entries, 273 were expected"),
        ("Instance;Duration", ":1: there is no entry ItemsHandled in the header"),
        (line(pieces="many"), ":1: ItemsHandled is 'many'; a number was expected"),
    ],
)
def test_what_is_no_footprint_is_refused(tmp_path, text, message):
    path = tmp_path / "footprint.csv"
    path.write_text(text)
    with pytest.raises(footprints.FootprintError, match=message):
        footprints.read(path)


def test_the_table_has_theirs_where_robots_and_time_agree_and_names_what_is_refused(tmp_path):
    write_instance(tmp_path / "a.xinst")
    text = write_instance(tmp_path / "tiers.xinst").read_text()
    (tmp_path / "tiers.xinst").write_text(text.replace('ID="3" Tier="0"', 'ID="3" Tier="1"', 1))
    footprint = tmp_path / "footprint.csv"
    footprint.write_text(line() + "\n" + line(robots=8, pieces=999) + "\n")
    out, err = table(tmp_path, footprint, "--seeds", 1)
    header, _, row, *rest = out.splitlines()
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert header.count("RAWSim-O") == len(footprints.FIGURES), err
    assert cells[:3] == ["a", "16", "5 min"] and float(cells[3]) > 20
    assert cells[10] == "44" and cells[12] == "124"
    assert any("on Tier 1, which has no Waypoint" in text for text in rest)
    out, err = table(tmp_path / "a.xinst", footprint, "--seeds", 1, "--seconds", 60)
    assert out.splitlines()[2].endswith("|  |  |  |  |  |  |")


def test_runs_with_other_settings_are_not_compared(tmp_path):
    write_instance(tmp_path / "a.xinst")
    settings = tmp_path / "few.xsett"
    settings.write_text("<SettingConfiguration><Name>few</Name></SettingConfiguration>")
    footprint = tmp_path / "footprint.csv"
    footprint.write_text(line(settings="many", seconds=60) + "\n")
    arguments = tmp_path / "a.xinst", footprint, "--seeds", 1, "--seconds", 60
    out, err = table(*arguments, "--settings", settings)
    assert "RAWSim-O:" not in out.splitlines()[0], err
    assert "Not compared: RAWSim-O ran a with the settings many, not few" in out
    footprint.write_text(line(settings="few", seconds=60) + "\n")
    out, err = table(*arguments, "--settings", settings)
    assert "| 44 |" in out and "Not compared" not in out, err
