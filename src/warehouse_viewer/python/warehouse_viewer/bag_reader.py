# SPDX-License-Identifier: Apache-2.0
"""The messages in a bag, which anybody may have written."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import rosbag

from warehouse_client import message_check
from warehouse_layout.file import user_file

if TYPE_CHECKING:
    from genpy import Message


class Recorded(NamedTuple):
    """A message, when it was recorded [s], and how much of the bag is read with it, 0 … 1."""

    topic: str
    message: Message
    time: float
    part: float


def messages(path: str | Path, topics: Sequence[str], error: type[Exception]) -> Iterator[Recorded]:
    """Yields the messages of topics. Raises `error` where the bag, or one of them, is damaged."""
    try:
        user_file.check(path)
        with rosbag.Bag(str(path)) as bag:
            if bag.get_message_count() == 0:  # it has no times either
                return
            begin, end = bag.get_start_time(), bag.get_end_time()
            for topic, message, at in bag.read_messages(topics=[*topics]):
                if reason := message_check.fault(message):
                    raise error(f"{path}: {topic} at {at.to_sec():.3f} s: {reason}")
                part = (at.to_sec() - begin) / max(end - begin, 1e-9)
                yield Recorded(topic, message, at.to_sec(), part)
    except error:
        raise
    except (rosbag.ROSBagException, OSError) as why:
        raise error(f"{path}: {why}") from why
    except Exception as why:  # rosbag reads what is damaged as if it were not
        raise error(f"{path}: is damaged: {why!r}; `rosbag reindex` may mend it") from why
