# SPDX-License-Identifier: Apache-2.0
"""One row of a message that a master has sent: an instant action, or a response."""

from dataclasses import dataclass
from typing import Any, ClassVar

from warehouse_vda5050.conform.log import Entry


@dataclass(frozen=True)
class Row:
    """The JSON of a row, and the message that it came in. `id_field` names what tells rows of a
    vehicle apart."""

    id_field: ClassVar[str]
    entry: Entry
    row: dict[str, Any]

    @property
    def key(self) -> tuple[str, str]:
        """The vehicle and the row's id."""
        return self.entry.vehicle, str(self.row.get(self.id_field))
