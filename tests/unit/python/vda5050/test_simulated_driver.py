# SPDX-License-Identifier: Apache-2.0
"""The simulated robot as a Driver: charging, as orders and instant actions ask for it."""

from dataclasses import replace

import pytest
from grid_robot import GRID, order, row

from warehouse_layout.message_enums import RobotMode, Status
from warehouse_vda5050.model import Action, BlockingType, InstantActions, OperatingMode
from warehouse_vda5050.simulated_driver import Sighting, SimulatedDriver
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

PARKED = Sighting(0, 0, 0, 0, 0, 0, Status.IDLE, 0, 0, 0, 0, 0, 0.5, RobotMode.AUTOMATIC)


class Paths:
    """Notes the paths that a robot is sent along; it has no coordinator."""

    def __init__(self):
        self.sent, self.taken = [], {}

    def note_taken(self, kiva_id, before):
        self.taken[kiva_id] = before

    def taken_before(self, kiva_id):
        return self.taken.get(kiva_id)

    def follow(self, _kiva_id, path_id, _first, points, _released, _speeds):
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


class World(Paths):
    """A world with a coordinator, which knows the mode of its one robot."""

    def __init__(self):
        super().__init__()
        self.mode = RobotMode.AUTOMATIC

    def set_mode(self, _kiva_id, mode):
        self.mode = mode
        return ""

    def cancel(self, _kiva_id):
        pass


def begun(world):
    """A vehicle whose program begins in that world."""
    driver = SimulatedDriver(1, world)
    vehicle = Vehicle(driver, GRID, VehicleSettings(linger=2.0))
    return driver, vehicle


def test_a_program_that_was_killed_in_mid_order_is_usable_again():
    world = World()
    driver, vehicle = begun(world)
    driver.sighting = PARKED
    vehicle.update(0.0)
    assert vehicle.on_order(order("o", row(0, 3)), 0.0) and world.mode == RobotMode.MANUAL

    driver, vehicle = begun(world)  # the first ended without a word
    drives = replace(PARKED, mode=RobotMode.MANUAL, status=Status.BUSY)
    for now in range(1, 10):
        driver.sighting = drives
        vehicle.update(float(now))
    assert world.mode == RobotMode.MANUAL  # the coordinator has no robot that drives for another
    driver.sighting = replace(drives, status=Status.IDLE)
    vehicle.update(10.0)
    assert vehicle.state().mode is OperatingMode.AUTOMATIC
    assert vehicle.on_order(order("p", row(0, 2)), 10.0), vehicle.state().errors


def test_a_robot_whose_program_was_killed_goes_back_to_the_coordinator():
    world = World()
    driver, vehicle = begun(world)
    driver.sighting = PARKED
    vehicle.update(0.0)
    vehicle.on_order(order("o", row(0, 3)), 0.0)
    driver, vehicle = begun(world)
    for now in range(4):
        driver.sighting = replace(PARKED, mode=world.mode)
        vehicle.update(float(now))
    assert world.mode == RobotMode.AUTOMATIC and world.taken == {1: None}
    assert not begun(world)[1].is_taken


def test_a_person_who_takes_a_robot_keeps_it():
    world = World()
    driver, vehicle = begun(world)
    driver.sighting = replace(PARKED, mode=RobotMode.MANUAL)
    vehicle.update(0.0)
    assert vehicle.state().mode is OperatingMode.MANUAL


def test_a_robot_that_is_taken_again_at_once_goes_back_to_what_it_was():
    """The world tells the mode some moments after it was set."""
    world = World()
    driver, _ = begun(world)
    driver.sighting = PARKED
    driver.take()
    driver.sighting = replace(PARKED, mode=RobotMode.MANUAL)
    driver.give_back()
    assert world.mode == RobotMode.AUTOMATIC
    assert driver.report().mode is OperatingMode.AUTOMATIC
    driver.take()
    driver.give_back()
    assert world.mode == RobotMode.AUTOMATIC
