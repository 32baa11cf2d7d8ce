# SPDX-License-Identifier: Apache-2.0
"""What stands in the world, told by the names and poses of its models."""

from dataclasses import dataclass, field

from warehouse_client import routes
from warehouse_layout import files, models
from warehouse_layout.cells import Cells

BELT = files.box_size("conveyor_belt")[:2]  # length and width [m]


@dataclass
class Survey:
    """Poses (x, y, yaw) in world [m, rad] by number; `others` by name."""

    kiva: dict = field(default_factory=dict)
    storage_unit: dict = field(default_factory=dict)
    item: dict = field(default_factory=dict)
    conveyor_belt: dict = field(default_factory=dict)
    floor_markings: dict = field(default_factory=dict)
    others: dict = field(default_factory=dict)
    taken: set | None = None  # grid points in the way of which others are; None: not known

    def __str__(self):
        nouns = {"kiva": "robot", "storage_unit": "storage unit", "item": "item"}
        nouns |= {"conveyor_belt": "conveyor belt", "others": "other model"}
        counts = ((len(getattr(self, kind)), noun) for kind, noun in nouns.items())
        parts = [f"{n} {noun}{'' if n == 1 else 's'}" for n, noun in counts if n]
        return ", ".join(parts) or "an empty floor"

    def obstacles(self):
        """Grid points that no robot may pass, with a load or without, but for those of robots."""
        belts = [p for pose in self.conveyor_belt.values() for p in routes.covered(*pose, *BELT)]
        return {*belts, *(self._guessed() if self.taken is None else self.taken)}

    def _guessed(self):
        """How large the others are is not known; a person and a wall's end reach this far."""
        return [p for x, y, _ in self.others.values() for p in routes.covered(x, y, 0, 1, 1)]


def of_models(poses):
    """A Survey of models, {name: (x, y, yaw)}; the floor is left out."""
    survey = Survey()
    for name, pose in poses.items():
        kind, number = models.kind_and_number(name)
        if kind:
            getattr(survey, kind)[number] = pose
        elif name != models.FLOOR:
            survey.others[name] = pose
    return survey


def of_engine(engine, without=("item",)):
    """A Survey of the running world. Poses of the kinds `without` are left out, to save time."""
    kinds = {name: models.kind_and_number(name)[0] for name in engine.names()}
    survey = of_models({n: None if k in without else engine.pose(n) for n, k in kinds.items()})
    grid = engine.map()
    if abs(grid.info.resolution - 1) < 1e-6:
        survey.taken = Cells.of_map(grid).points()
    return survey
