# SPDX-License-Identifier: Apache-2.0
"""The names under which RWARE registers its tasks; ours have `kiva-` before them."""

from collections.abc import Iterable, Iterator
from itertools import product
from typing import Any

from gymnasium import register

from warehouse_learning.rware.task import ObservationType, RewardType

SIZES = {"tiny": (1, 3), "small": (2, 3), "medium": (2, 5), "large": (3, 5)}  # rows, columns
REQUESTS_PER_AGENT = {"-easy": 2, "": 1, "-hard": 0.5}
MOST_AGENTS = 19
VECTORS = {"": ObservationType.FLATTENED}
IMAGES = {"-img": ObservationType.IMAGE, "-imgdict": ObservationType.IMAGE_DICT}
REWARDS = {
    "indiv": RewardType.INDIVIDUAL,
    "global": RewardType.GLOBAL,
    "twostage": RewardType.TWO_STAGE,
}
RANGES = {"": 1} | {f"-{cells}s": cells for cells in range(2, 6)}


def _views(kinds: dict[str, ObservationType]) -> Iterator[tuple[str, dict[str, Any]]]:
    """(part of a name, options) of each kind of observation; pictures turned and not."""
    for name, kind in kinds.items():
        yield name, {"observation_type": kind}
        if kind is not ObservationType.FLATTENED:
            yield f"{name}-Nd", {"observation_type": kind, "image_observation_directional": False}


def _sizes(
    rows: int, columns: int, height: int, agents: int, requests: int, cells: int
) -> dict[str, int]:
    return {
        "shelf_rows": rows,
        "shelf_columns": columns,
        "column_height": height,
        "n_agents": agents,
        "request_queue_size": requests,
        "sensor_range": cells,
    }


def _sized(
    views: Iterable[tuple[str, dict[str, Any]]], ranges: dict[str, int], heights: dict[str, int]
) -> Iterator[tuple[str, dict[str, Any]]]:
    agents = range(1, MOST_AGENTS + 1)
    for size, diff, (view, observes), (sight, cells), (tall, height), n in product(
        SIZES, REQUESTS_PER_AGENT, views, ranges.items(), heights.items(), agents
    ):
        rows, columns = SIZES[size]
        name = f"rware{view}{sight}-{size}{tall}-{n}ag{diff}-v2"
        requests = int(n * REQUESTS_PER_AGENT[diff])
        yield name, observes | _sizes(rows, columns, height, n, requests, cells)


def plain() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields (name, options) of the tasks that importing RWARE registers."""
    return _sized(list(_views(VECTORS)), {"": 1}, {"": 8})


def of_images() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields (name, options) of those that its image_registration adds."""
    return _sized(list(_views(IMAGES)), {"": 1}, {"": 8})


def full() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yields (name, options) of those that its full_registration adds, some hundred thousand."""
    views = list(_views(VECTORS | {"-img": ObservationType.IMAGE}))
    yield from _sized(views, RANGES, {f"-{height}h": height for height in range(1, 16)})
    agents = range(1, MOST_AGENTS + 1)
    for rows, columns, height, n, requests, reward, (view, observes), sight in product(
        range(1, 5), range(3, 10, 2), range(1, 16), agents, agents, REWARDS, views, RANGES
    ):
        name = f"rware{view}{sight}-{rows}x{columns}-{height}h-{n}ag-{requests}req-{reward}-v2"
        sizes = _sizes(rows, columns, height, n, requests, RANGES[sight])
        yield name, observes | sizes | {"reward_type": REWARDS[reward]}


def register_all(tasks: Iterable[tuple[str, dict[str, Any]]]) -> None:
    """Registers (name, options) as kiva-NAME, alone and vectorised."""
    for name, options in tasks:
        register(
            id=f"kiva-{name}",
            entry_point="warehouse_learning.rware.env:Warehouse",
            vector_entry_point="warehouse_learning.rware.vector:RwareVectorEnv",
            kwargs=options,
        )
