# SPDX-License-Identifier: Apache-2.0
"""All cases for masters, a file a subject. Sections are those of 2.1.0, or of 3.0.0 where that
alone has the case."""

from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.master.cases import (
    actions,
    connection,
    errors,
    horizon,
    instant,
    limits,
    messages,
    modes,
    order,
    paths,
    states,
    update,
    zones,
)

# What needs an accident comes first, and what judges all orders of the run last.
MODULES = (
    modes,
    errors,
    connection,
    states,
    horizon,
    limits,
    actions,
    instant,
    paths,
    zones,
    order,
    update,
    messages,
)
_ALL = [case for module in MODULES for case in module.chapter.cases]
CASES: tuple[Case, ...] = tuple(sorted(_ALL, key=lambda case: case.audit))


def cases_of(version: str, strict: bool = False) -> list[Case]:
    """Returns the cases of a version; `strict`: recommendations as well."""
    return [c for c in CASES if version in c.versions and (strict or not c.strict)]
