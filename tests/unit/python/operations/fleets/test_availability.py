# SPDX-License-Identifier: Apache-2.0
"""Batteries, failures and repair of ideal robots are those of simulated ones."""

from xml.etree import ElementTree

import numpy as np
import paths
import pytest
from operations_site import site

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.transports.transport_book import Kind
from warehouse_operations.fleets import availability, consumption
from warehouse_operations.fleets.availability import Availability, Energy, Failures, Upkeep
from warehouse_operations.fleets.consumption import ROBOT, Drain, Way
from warehouse_operations.fleets.ideal import IdealFleet
from warehouse_operations.runs.simulation import Description, open_operations

MODELS = paths.ROOT / "worlds" / "models"


def parts(model):
    """(mass, moment about z, distance from z) of the links of a model."""
    for link in ElementTree.parse(MODELS / model / "model.sdf").iter("link"):
        at = [float(text) for text in (link.findtext("pose") or "0 0 0 0 0 0").split()]
        inertial = link.find("inertial")
        mass = float(inertial.findtext("mass"))
        yield mass, float(inertial.findtext("inertia/izz")), np.hypot(*at[:2])


@pytest.mark.parametrize("model, body", [("kiva", ROBOT), ("storage_unit", consumption.UNIT)])
def test_bodies_are_those_of_the_models(model, body):
    assert body.mass == sum(mass for mass, _, _ in parts(model))
    moment = sum(own + mass * arm**2 for mass, own, arm in parts(model))
    # Upright wheels: their own moment about z is that about a diameter.
    assert body.inertia == pytest.approx(moment, rel=0.01)
    assert consumption.ITEM.mass == next(parts("item"))[0]


def test_constants_are_those_of_the_model():
    robot = ElementTree.parse(MODELS / "kiva" / "model.sdf")
    plugin = {part.get("name"): part for part in robot.iter("plugin")}
    motion, lift = plugin["motion"], plugin["lift"]
    assert float(motion.findtext("wheel_radius")) == consumption.WHEEL_RADIUS
    assert float(motion.findtext("wheel_separation")) == consumption.WHEEL_SEPARATION
    assert float(motion.findtext("wheel_inertia")) == consumption.WHEEL_INERTIA
    assert float(lift.findtext("height")) == consumption.STROKE


def test_a_run_takes_its_rolling_and_its_kinetic_energy():
    free = Drain(rolling_resistance=0.0, drive_efficiency=1.0, regeneration=0.0)
    wheels = 2 * consumption.WHEEL_INERTIA / consumption.WHEEL_RADIUS**2
    kinetic = (ROBOT.mass + wheels) * 1.5**2 / 2
    assert free.runs([10.0], Kinematics(), ROBOT) == pytest.approx(kinetic)
    # 1 m is too short for the top speed: v² = a s.
    assert free.runs([1.0], Kinematics(), ROBOT) == pytest.approx(kinetic / 1.5**2)
    rolls = Drain(drive_efficiency=1.0, regeneration=1.0)
    assert rolls.runs([10.0], Kinematics(), ROBOT) == pytest.approx(0.015 * 145 * 9.81 * 10)


def test_others_on_the_floor_and_late_releases_cost_energy():
    way, unit, kinematics = Way((10.0,), 1, 1), 1, Kinematics()

    def drive(density=0.0, delay=0.0, loaded=unit):
        used = consumption.Consumption(Drain(), kinematics, lambda _: 0.0, 1.0, delay)
        return used.drive(way, 1, loaded, density)

    stop = Drain().changes(kinematics.speed**2, ROBOT + consumption.UNIT)
    stops = 10.0 * consumption.STOPS_LOADED * 0.02
    assert drive(0.02) - drive() == pytest.approx(stops * stop)
    assert drive(0.02, loaded=None) / drive(loaded=None) > drive(0.02) / drive()
    assert drive(delay=consumption.LATE) == drive()
    late = drive(delay=consumption.LATE + 0.1) - drive()
    assert drive(delay=consumption.LATE + 0.2) - drive() == pytest.approx(2 * late)
    assert 0 < late < 10.0 * stop


def test_a_way_is_its_straight_runs():
    assert Way.along([0, 1, 2, 12, 22, 21], 0.5).runs == (1.0, 1.0, 0.5)
    assert Way.along([7], 1.0).runs == ()


def test_charging_slows_down_from_the_taper_on_and_ends_where_electronics_take_all():
    energy = Energy()
    assert energy.charged(0.5, 360) == pytest.approx(0.5 + 1420 * 360 / energy.joules)
    charge, step = 0.5, 1.0
    for _ in range(5000):  # by the formula of simulated batteries, second by second
        power = 1500 * min(max((1 - charge) / 0.2, 0.05), 1.0) - 80
        charge += power * step / energy.joules
    assert energy.charged(0.5, 5000) == pytest.approx(charge, abs=1e-3)
    assert energy.charged(0.5, energy.seconds_to(0.5, 0.9)) == pytest.approx(0.9, abs=1e-3)


def test_a_full_robot_stays_at_its_charger_and_its_place_is_free():
    kept = Upkeep(Availability(Energy()), 1, np.array([5]), np.random.default_rng(1))
    kept.charge[0] = 0.5
    kept.begin(0, 5, 0.0)
    kept.note(0, 7200.0)
    kept.release_full(0)
    assert kept.charge[0] > 0.98 and kept.free_cells(0) == [5]
    charging = kept.charging_s
    kept.note(0, 14400.0)
    assert kept.charge[0] > 0.98 and kept.charging_s == charging


@pytest.mark.parametrize("realism", ["typical"])
def test_ideal_robots_use_what_simulated_ones_do(realism):
    common = {"orders": "fill", "realism": realism, "seconds": 600.0}
    used = []
    for physics in (True, False):
        with open_operations(Description("small", physics=physics, **common)) as ops:
            ops.step_until(1.0)
            if physics:
                robots = ops.fleet.robots
                charges = dict(zip(robots.kiva_ids.tolist(), robots.charge.tolist()))
            else:
                ops.fleet.set_charges(charges)
            ops.step_until(600.0)
            used.append(np.mean(list(charges.values())) - ops.fleet.energy["charge_mean"])
    assert used[1] == pytest.approx(used[0], rel=0.05)


def fleet_that_fails(duration, kind):
    """A fleet of two, the first of which breaks down a second after an event of its transport; the
    number of that robot, and all events."""
    where = site()
    cells = list(where.units.values())
    fleet = IdealFleet(where.plan, {1: cells[5], 2: cells[-1]}, where.units)
    fleet.keep_up(
        Availability(None, Failures(per_robot_hour=0.0)), np.random.default_rng(1), lambda _: 0.0
    )
    fleet.submit(1, "pick1")
    events, broken = [], 0
    while fleet.time < 3000:
        fleet.step_until(3000)
        news = fleet.take_events()
        events += news
        if not broken and kind in [event.kind for event in news]:
            broken = events[-1].kiva_id
            fleet.step_until(fleet.time + 1.0)
            fleet._trips._break_down(fleet._trips.robots[broken - 1], duration)
        for transport in list(fleet.book):
            fleet.release(transport.number)
    return fleet, broken, events


def test_another_robot_fetches_what_a_broken_one_was_to_fetch():
    _, broken, events = fleet_that_fails(1000.0, Kind.ASSIGNED)
    robots = {event.kiva_id for event in events if event.kind == Kind.LIFTED}
    assert robots == {3 - broken}
    assert [event.kind for event in events][-1] == Kind.STORED


def test_a_robot_that_is_repaired_late_loses_its_transport_and_stores_its_unit():
    fleet, broken, events = fleet_that_fails(300.0, Kind.LIFTED)
    kinds = [event.kind for event in events]
    assert Kind.FAILED in kinds and kinds[-1] == Kind.STORED
    assert {event.kiva_id for event in events if event.kind == Kind.STORED} == {broken}
    assert len(fleet.cell_of_unit) == len(site().units)
    assert events[-1].stamp > 300


def test_a_robot_that_is_repaired_soon_goes_on():
    _, _, events = fleet_that_fails(20.0, Kind.LIFTED)
    assert Kind.FAILED not in [event.kind for event in events]


def test_a_realism_of_presets_has_the_drain_of_its_file(tmp_path):
    file = tmp_path / "worn.yaml"
    file.write_text(
        "energy: {rolling_resistance: 0.03, health: 0.8}\nactuation: {motor_lag: 0.05}\n"
        "radio: {status_latency_mean: 0.1}\n"
    )
    read = availability.read(str(file))
    assert read.radio_delay == pytest.approx(0.13)  # with that of commands, at its default
    assert read.drain == Drain(rolling_resistance=0.03, motor_lag=0.05)
    assert read.energy.health == 0.8
