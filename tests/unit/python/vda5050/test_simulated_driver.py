# SPDX-License-Identifier: Apache-2.0
"""The simulated robot as a Driver: charging, as orders and instant actions ask for it."""

from dataclasses import replace

import pytest
from grid_robot import GRID, order, row

from warehouse_fleet.message_enums import Mode, Status
from warehouse_vda5050.model import Action, BlockingType, InstantActions
from warehouse_vda5050.simulated_driver import Sighting, SimulatedDriver
from warehouse_vda5050.vehicle import Vehicle

PARKED = Sighting(0, 0, 0, 0, 0, 0, Status.IDLE, 0, 0, 0, 0, 0, 0.5, Mode.AUTOMATIC)


class Paths:
    """Notes the paths that a robot is sent along; it has no coordinator."""

    def __init__(self):
        self.sent = []

    def follow(self, _kiva_id, path_id, _first, points, _released):
        self.sent.append((path_id, [*points]))

    def set_mode(self, _kiva_id, _mode):
        return ""


class Charger:
    """A vehicle that stands at a charger."""

    def __init__(self):
        self.world = Paths()
        self.driver = SimulatedDriver(1, self.world)
        self.vehicle = Vehicle(self.driver, GRID)
        self.now = 0.0
        self.see(PARKED, at_charger=True)

    def see(self, sighting, **changes):
        self.driver.sighting = replace(sighting, **changes)
        self.now += 1.0
        self.vehicle.update(self.now)
        return self.vehicle.state()

    def instant(self, type):
        """Sends an instant action; returns what became of it, and whether it charges."""
        action = Action(type, f"{type}-{self.now}", BlockingType.NONE)
        self.vehicle.on_instant_actions(InstantActions((action,)), self.now)
        state = self.see(self.driver.sighting)
        return state.actions[-1].status.value, state.battery.charging


@pytest.fixture
def charger():
    return Charger()


def test_it_charges_where_it_stands_until_it_is_told_to_stop(charger):
    assert charger.vehicle.state().battery.charging
    assert charger.instant("stopCharging") == ("FINISHED", False)
    assert charger.instant("stopCharging") == ("FINISHED", False)
    assert charger.instant("startCharging") == ("FINISHED", True)


def test_at_the_next_charger_it_charges_again(charger):
    charger.instant("stopCharging")
    charger.see(PARKED, at_charger=False)
    assert charger.see(PARKED, at_charger=True).battery.charging


def test_elsewhere_it_can_only_stop(charger):
    charger.see(PARKED, at_charger=False)
    assert charger.instant("startCharging") == ("FAILED", False)
    assert charger.instant("stopCharging") == ("FINISHED", False)


def test_an_order_that_begins_by_stopping_to_charge_is_driven(charger):
    stop = Action("stopCharging", "s", BlockingType.HARD)
    assert charger.vehicle.on_order(order("o", row(0, 2), actions={0: [stop]}), charger.now)
    charger.see(PARKED, at_charger=True)
    state = charger.see(PARKED, at_charger=True)
    assert state.actions[0].status.value == "FINISHED" and not state.battery.charging
    assert [points for _, points in charger.world.sent] == [[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]]
