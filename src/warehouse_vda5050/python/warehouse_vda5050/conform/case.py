# SPDX-License-Identifier: Apache-2.0
"""A case: one sentence of the specification, and the function that tries it on a vehicle."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from warehouse_vda5050.conform.probe import Probe

Trial = Callable[["Probe"], None]
EVERY = ("2.0.0", "2.1.0", "3.0.0")


@dataclass(frozen=True)
class Case:
    """id: chapter.name. section: of 2.1.0, unless `versions` is 3.0.0 alone. sentence: the demand,
    in short. trial() returns if the vehicle conforms, and raises Ended otherwise. edges: how many
    edges it drives. actions: those that the factsheet must have. strict: tried on request alone,
    since the specification recommends it. audit: judges all messages of the run, and drives
    nothing."""

    id: str
    section: str
    sentence: str
    trial: Trial
    edges: int = 0
    actions: tuple[str, ...] = ()
    strict: bool = False
    audit: bool = False
    versions: tuple[str, ...] = EVERY

    @property
    def chapter(self) -> str:
        """The part of the specification that it belongs to."""
        return self.id.partition(".")[0]


class Chapter:
    """The cases of one file, in their order."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.cases: list[Case] = []

    def case(
        self,
        name: str,
        section: str,
        *,
        edges: int = 0,
        actions: Iterable[str] = (),
        strict: bool = False,
        audit: bool = False,
        versions: tuple[str, ...] = EVERY,
    ) -> Callable[[Trial], Trial]:
        """Returns a decorator that makes a function the trial of a case; its docstring is the
        sentence."""

        def add(trial: Trial) -> Trial:
            id, sentence = f"{self.name}.{name}", " ".join((trial.__doc__ or "").split())
            needs = edges, tuple(actions), strict, audit, versions
            self.cases.append(Case(id, section, sentence, trial, *needs))
            return trial

        return add
