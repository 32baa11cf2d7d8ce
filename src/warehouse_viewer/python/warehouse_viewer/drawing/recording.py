# SPDX-License-Identifier: Apache-2.0
"""A bag of the warehouse's array topics as Moments, and as a film."""

import shutil
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from matplotlib import animation
from PIL import Image

from warehouse_viewer import bag_reader
from warehouse_viewer.drawing.drawing import Drawing, Moment

PARTS = {
    "/warehouse/objects": "objects",
    "/warehouse/unit_states": "states",
    "/warehouse/fleet": "fleet",
    "/warehouse/scenery": "scenery",
}


class RecordingError(ValueError):
    """The bag holds no picture, or no program here can write the film."""


def moments(path: str, period: float) -> Iterator[Moment]:
    """Yields Moments of a bag, one each `period` simulated seconds. Raises RecordingError."""
    moment, due = Moment(), None
    for message in bag_reader.messages(path, list(PARTS), RecordingError):
        setattr(moment, PARTS[message.topic], message.message)
        now = moment.fleet.stamp.to_sec() if moment.complete else None
        if now is None or (due is not None and due - 10 * period < now < due):
            continue
        due = now + period
        yield moment
    if due is None:
        needed = ", ".join(list(PARTS)[:3])
        raise RecordingError(f"{path}: no picture in it; record at least {needed}")


def film(bag: str, path: str, speed: float, rate: float, **look: Any) -> None:
    """Writes a GIF or an MP4, `speed` simulated seconds per second, `rate` frames per second.

    `look` are further arguments of Drawing. Raises RecordingError.
    """
    frames = _frames(bag, speed / rate, look)
    (_write_gif if path.endswith(".gif") else _write_mp4)(path, frames, rate)


def _frames(bag: str, period: float, look: Mapping[str, Any]) -> Iterator[Drawing]:
    drawing = None
    for moment in moments(bag, period):
        drawing = drawing or Drawing(moment, **look)
        drawing.draw(moment)
        yield drawing


def _write_gif(path: str, frames: Iterable[Drawing], rate: float) -> None:
    first, *rest = (Image.fromarray(d.pixels()).quantize(64) for d in frames)
    first.save(path, save_all=True, append_images=rest, duration=round(1000 / rate), loop=0)


def _write_mp4(path: str, frames: Iterator[Drawing], rate: float) -> None:
    if not shutil.which("ffmpeg"):
        raise RecordingError(f"{path}: an MP4 needs ffmpeg (apt install ffmpeg); a GIF does not")
    writer = animation.FFMpegWriter(fps=rate)
    first = next(frames)
    with writer.saving(first.figure, path, first.figure.dpi):
        writer.grab_frame()
        for _ in frames:
            writer.grab_frame()
