# SPDX-License-Identifier: Apache-2.0
"""Recordings that a hub plays while nothing runs."""

import pytest

from warehouse_sim.hub import keeping, recordings
from warehouse_sim.hub.recordings import EXAMPLE, EXAMPLE_FILE, Recordings, UnknownRecording
from warehouse_viewer.replay.file import FileRecording

MOST_EXAMPLE = 300_000  # [bytes]: it is fetched after the first view


def test_the_example_can_be_played():
    """scripts/pages/hub_recording records it again after the protocol has changed."""
    example = FileRecording(EXAMPLE_FILE)
    assert not example.cut
    assert 60 <= example.chunks[-1].end - example.chunks[0].begin <= 300
    assert EXAMPLE_FILE.stat().st_size < MOST_EXAMPLE


def test_recordings_of_simulations_and_files_are_listed(tmp_path):
    stopped, folder = tmp_path / "hub/one", tmp_path / "recordings"
    (folder / "shift").mkdir(parents=True)
    stopped.mkdir(parents=True)
    data = EXAMPLE_FILE.read_bytes()
    for file in (
        stopped / "recording.kiva",
        folder / "shift/recording.kiva",
        folder / "day.kiva",
        folder / "-bad name.kiva",
    ):
        file.write_bytes(data)
    (folder / "broken.kiva").write_text("no recording")
    (folder / "notes.txt").write_text("none")
    book = Recordings(folder, lambda: [("one", stopped), ("two", tmp_path / "hub/two")])
    rows = {row["name"]: row for row in book.rows()}
    assert set(rows) == {EXAMPLE, "one", "shift.kiva", "day.kiva", "broken.kiva"}
    assert rows["one"]["url"] == "/recordings/one/" and rows["one"]["seconds"] > 0
    assert rows["broken.kiva"]["url"] == "" and "expected" in rows["broken.kiva"]["reason"]
    assert book.application("one") is book.application("one")
    with pytest.raises(UnknownRecording, match="no recording 'three'"):
        book.application("three")
    book.close()


def test_only_some_files_stay_open(tmp_path, monkeypatch):
    monkeypatch.setattr(recordings, "MOST_OPEN", 2)
    data = EXAMPLE_FILE.read_bytes()
    for number in range(5):
        (tmp_path / f"{number}.kiva").write_bytes(data)
    book = Recordings(tmp_path)
    assert len(book.rows()) == 6
    assert len(book._open) == 2
    book.close()
    assert not book._open


def test_a_recording_that_can_not_be_read_leaves_no_file(tmp_path):
    with pytest.raises(OSError):
        keeping.keep("http://localhost:9", tmp_path / "recording.kiva", {})
    assert not [*tmp_path.iterdir()]
