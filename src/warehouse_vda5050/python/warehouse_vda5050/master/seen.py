# SPDX-License-Identifier: Apache-2.0
"""All vehicles that were seen at the broker, robots of this warehouse or not."""

from dataclasses import dataclass

from warehouse_vda5050.model import (
    Connection,
    ConnectionState,
    Factsheet,
    InvalidFactsheet,
    VehicleState,
)
from warehouse_vda5050.topics import Identity

MOST = 1000  # vehicles that are remembered: a broker may be open to strangers


@dataclass
class SeenVehicle:
    """The newest messages of one vehicle; None before the first. `fault`: of a factsheet that
    can't be read."""

    identity: Identity
    connection: ConnectionState | None = None
    state: VehicleState | None = None
    sheet: Factsheet | None = None
    fault: str = ""

    @property
    def is_connected(self) -> bool:
        """Whether it is there, by the last message about it."""
        is_online = self.connection is ConnectionState.ONLINE
        return is_online or (self.connection is None and self.state is not None)

    def take(self, message: VehicleState | Connection | Factsheet | InvalidFactsheet) -> None:
        """Keeps a message."""
        if isinstance(message, VehicleState):
            self.state = message
        elif isinstance(message, Factsheet):
            self.sheet, self.fault = message, ""
        elif isinstance(message, InvalidFactsheet):
            self.fault = message.fault
        else:
            self.connection = message.state


class SeenVehicles:
    """The vehicles, by name."""

    def __init__(self) -> None:
        self._vehicles: dict[Identity, SeenVehicle] = {}

    def take(
        self,
        identity: Identity,
        message: VehicleState | Connection | Factsheet | InvalidFactsheet,
    ) -> None:
        """Keeps a vehicle's message; drops those of one more vehicle than MOST."""
        if identity not in self._vehicles:
            if len(self._vehicles) >= MOST:
                return
            self._vehicles[identity] = SeenVehicle(identity)
        self._vehicles[identity].take(message)

    def get(self, identity: Identity) -> SeenVehicle | None:
        """Returns a vehicle, None if it was never seen."""
        return self._vehicles.get(identity)

    def all(self) -> list[SeenVehicle]:
        """Returns the vehicles, by manufacturer and serial."""
        by = sorted(self._vehicles, key=lambda who: (who.manufacturer, who.serial))
        return [self._vehicles[identity] for identity in by]
