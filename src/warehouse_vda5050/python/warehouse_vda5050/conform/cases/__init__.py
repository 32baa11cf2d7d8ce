# SPDX-License-Identifier: Apache-2.0
"""All cases, a file a subject. Sections are those of 2.1.0, or of 3.0.0 in version_3 and zones."""

from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.cases import (
    actions,
    blocking,
    cancel,
    connection,
    errors,
    factsheet,
    fields,
    header,
    horizon,
    instant,
    malformed,
    order,
    pause,
    places,
    progress,
    recovery,
    state,
    update,
    version_3,
    zones,
)

# In the order in which they are tried: header and progress judge the run so far, in which nothing
# was cut; recovery cuts the connection.
MODULES = (
    connection,
    factsheet,
    state,
    instant,
    order,
    update,
    horizon,
    cancel,
    pause,
    actions,
    blocking,
    errors,
    malformed,
    fields,
    version_3,
    zones,
    places,
    header,
    progress,
    recovery,
)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.chapter.cases)


def cases_of(version: str, strict: bool = False) -> list[Case]:
    """Returns the cases of a version; `strict`: recommendations as well."""
    return [c for c in CASES if version in c.versions and (strict or not c.strict)]
