# SPDX-License-Identifier: Apache-2.0
"""Episodes as files: the options, the seed and every action, as JSON. Played again they are
the same, bit by bit.

    python3 -m warehouse_learning.watch episode.json
"""

import dataclasses
import json
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.file import user_file
from warehouse_learning.options import Options

FORMAT = "kiva-episode 1"


class EpisodeError(ValueError):
    """A file that is not an episode; the message names it and why."""


def save(path: str | Path, options: Options, seed: int, actions: ArrayLike) -> None:
    """Writes an episode; actions are (decisions, robots) or, for wheels, (decisions, robots, 3)."""
    content = {
        "format": FORMAT,
        "options": dataclasses.asdict(options),
        "seed": seed,
        "actions": np.asarray(actions).tolist(),
    }
    Path(path).write_text(json.dumps(content))


def load(path: str | Path) -> tuple[Options, int, np.ndarray]:
    """Returns (Options, seed, actions) of a file. Raises EpisodeError."""
    try:
        content = json.loads(user_file.read_text(path))
        if content["format"] != FORMAT:
            raise EpisodeError(f"{path}: its format is {content['format']!r}, not {FORMAT!r}")
        return Options.of(content["options"]), int(content["seed"]), np.array(content["actions"])
    except (OSError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, EpisodeError):
            raise
        raise EpisodeError(f"{path}: {error!r}") from error
