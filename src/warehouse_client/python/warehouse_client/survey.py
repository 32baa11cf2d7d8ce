# SPDX-License-Identifier: Apache-2.0
"""The models of the world, by kind, with their poses."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from warehouse_client import routes
from warehouse_client.engine import Engine
from warehouse_layout.file import files
from warehouse_layout.generate.cells import Cells
from warehouse_layout.models import models

BELT = files.box_size("conveyor_belt")[:2]  # length and width [m]


@dataclass
class Survey:
    """Poses (x, y, yaw) in world [m, rad] by number; `others` by name."""

    kiva: dict = field(default_factory=dict)
    storage_unit: dict = field(default_factory=dict)
    item: dict = field(default_factory=dict)
    conveyor_belt: dict = field(default_factory=dict)
    floor_markings: dict = field(default_factory=dict)
    layout_walls: dict = field(default_factory=dict)
    others: dict = field(default_factory=dict)
    spacing: float = 1.0  # of the grid [m]
    taken: set | None = None  # grid points blocked by others; None: unknown

    def __str__(self) -> str:
        nouns = {"kiva": "robot", "storage_unit": "storage unit", "item": "item"}
        nouns |= {"conveyor_belt": "conveyor belt", "others": "other model"}
        counts = ((len(getattr(self, kind)), noun) for kind, noun in nouns.items())
        parts = [f"{n} {noun}{'' if n == 1 else 's'}" for n, noun in counts if n]
        return ", ".join(parts) or "an empty floor"

    def obstacles(self) -> set[routes.Point]:
        """Returns the grid points that no robot may pass, loaded or not; robots' own ones are not
        included."""
        belts = [p for pose in self.conveyor_belt.values() for p in routes.covered(*pose, *BELT)]
        return {*belts, *(self._guessed() if self.taken is None else self.taken)}

    def _guessed(self) -> list[routes.Point]:
        """Returns the grid points near others of unknown size: people and walls."""
        return [p for x, y, _ in self.others.values() for p in routes.covered(x, y, 0, 1, 1)]


def of_models(poses: Mapping[str, tuple[float, float, float] | None]) -> Survey:
    """Returns the Survey of models, {name: (x, y, yaw)}; the floor is left out."""
    survey = Survey()
    for name, pose in poses.items():
        kind, number = models.kind_and_number(name)
        if kind:
            getattr(survey, kind)[number] = pose
        elif name != models.FLOOR:
            survey.others[name] = pose
    return survey


def of_engine(engine: Engine, without: Sequence[str] = ("item",)) -> Survey:
    """Returns the Survey of the running world; leaves out the kinds `without`, to save time."""
    kinds = {name: models.kind_and_number(name)[0] for name in engine.names()}
    survey = of_models({n: None if k in without else engine.pose(n) for n, k in kinds.items()})
    grid = engine.map()
    survey.spacing = grid.info.resolution
    if abs(survey.spacing - 1) < 1e-6:
        survey.taken = Cells.of_map(grid).points()
    return survey
