# SPDX-License-Identifier: Apache-2.0
"""VDA 5050 2.1.0; and 2.0.0, which has no maps in what is sent here, and instant actions twice.

What is read is what peers in the field send: `instantActions` for `actions`, `position` for
`nodePosition`, small letters in enumerations, missing headers and blocking types.
"""

from collections.abc import Callable
from typing import Any

from warehouse_vda5050.codec.base import Codec
from warehouse_vda5050.codec.factsheet import factsheet_json, read_factsheet
from warehouse_vda5050.codec.orders import (
    instant_actions_json,
    order_json,
    read_instant_actions,
    read_order,
)
from warehouse_vda5050.codec.states import (
    connection_json,
    read_connection,
    read_state,
    read_visualization,
    state_json,
    visualization_json,
)
from warehouse_vda5050.model import (
    Connection,
    Factsheet,
    Header,
    InstantActions,
    Message,
    VehicleOrder,
    VehicleState,
    Visualization,
)
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.fields import Fields

WRITERS: dict[type, Callable[[Any], dict[str, Any]]] = {
    VehicleOrder: order_json,
    InstantActions: instant_actions_json,
    VehicleState: state_json,
    Connection: connection_json,
    Visualization: visualization_json,
    Factsheet: factsheet_json,
}
READERS: dict[Kind, Callable[[Fields, Header], Any]] = {
    Kind.ORDER: read_order,
    Kind.INSTANT_ACTIONS: read_instant_actions,
    Kind.STATE: read_state,
    Kind.CONNECTION: read_connection,
    Kind.VISUALIZATION: read_visualization,
    Kind.FACTSHEET: read_factsheet,
}


class CodecV2(Codec):
    """2.0.0 or 2.1.0."""

    def newer(self, kind: Kind, value: dict[str, Any]) -> dict[str, Any]:
        """Returns a message of a master with the names of this version."""
        if self.version == "2.0.0" and "actions" in value:
            return {**value, "instantActions": value["actions"]}  # some peers of 2.0.0 read this
        return value

    def to_json(self, message: Message) -> dict[str, Any]:
        """Returns the object that stands for a message."""
        value = WRITERS[type(message)](message)
        if self.version == "2.0.0":
            value.pop("maps", None)
            if isinstance(message, InstantActions):
                return self.newer(Kind.INSTANT_ACTIONS, value)
        return value

    def read(self, kind: Kind, fields: Fields) -> Any:
        """Returns the message that an object stands for. Raises MessageError."""
        if kind not in READERS:
            raise MessageError(f"{self.version} has no {kind.value}")
        return READERS[kind](fields, self.read_header(fields))
