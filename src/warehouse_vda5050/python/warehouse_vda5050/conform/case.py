# SPDX-License-Identifier: Apache-2.0
"""A case: one sentence of the specification, and the function that tries it on a vehicle, or on a
master."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TypeVar

Trial = Callable[[Any], None]  # its argument is a Probe, or a Stage where a master is tried
SomeTrial = TypeVar("SomeTrial", bound=Trial)
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
    ) -> Callable[[SomeTrial], SomeTrial]:
        """Returns a decorator that makes a function the trial of a case; its docstring is the
        sentence."""

        def add(trial: SomeTrial) -> SomeTrial:
            id, sentence = f"{self.name}.{name}", " ".join((trial.__doc__ or "").split())
            needs = edges, tuple(actions), strict, audit, versions
            self.cases.append(Case(id, section, sentence, trial, *needs))
            return trial

        return add
