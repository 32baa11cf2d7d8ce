# SPDX-License-Identifier: Apache-2.0
"""All that makes one vehicle faulty."""

from warehouse_vda5050.driver import Driver
from warehouse_vda5050.faults.active import ActiveFaults, Happened
from warehouse_vda5050.faults.faulty_driver import FaultyDriver
from warehouse_vda5050.faults.wire import FaultyWire


class VehicleFaults:
    """The `active` faults of a vehicle, its `driver` and its `wire`."""

    def __init__(self, driver: Driver, happened: Happened) -> None:
        self.active = ActiveFaults(happened)
        self.driver = FaultyDriver(driver, self.active)
        self.wire = FaultyWire(self.active)

    def tick(self, now: float) -> None:
        """Ends faults that are over, and holds the robot where a fault asks for it. now: any clock
        [s]."""
        self.active.update(now)
        self.driver.control(now)

    @property
    def is_busy(self) -> bool:
        """Whether tick() has something to do, however quiet the robot is."""
        return bool(self.active) or self.wire.is_waiting
