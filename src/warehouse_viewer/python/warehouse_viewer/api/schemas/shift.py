# SPDX-License-Identifier: Apache-2.0
"""A shift that is started on request."""

from typing import TYPE_CHECKING

from pydantic import Field

from warehouse_viewer.api.schemas.base import Person
from warehouse_viewer.api.schemas.pydantic_versions import Body, number

if TYPE_CHECKING:
    Factor = float
else:
    Factor = number(0.01, 1000)


class NewShift(Body):
    """How a shift begins."""

    factor: Factor = Field(1.0, description="real-time factor of its first minute [wall] at least")
    by: Person = ""
