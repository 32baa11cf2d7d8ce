# SPDX-License-Identifier: Apache-2.0
"""Days that are not ideal: the real module in this process, and no ROS."""

import numpy as np
import pytest
from test_failures import Fleet

from kiva_plugin_cpp import DescriptionError, EventKind, Status, World, worlds_folder
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports

KIVA = (worlds_folder() / "models" / "kiva" / "model.sdf").read_text()


def robots(rows, columns, **options):
    """A world of robots, each in the middle of 7 x 7 cells of its own, out of sight of others."""
    world = World(**options)
    for row in range(rows):
        for column in range(columns):
            x, y = 9 * (column - columns // 2), 9 * (row - rows // 2)
            world.spawn_model("kiva", f"kiva{row * columns + column + 1}", x, y)
    world.events()
    return world


def wander(world, random, seconds, steps=100):
    """Robots drive about in their cells; yields who is done, after every tenth of a second."""
    fleet = world.fleet
    home = np.round(np.stack([fleet.x, fleet.y], axis=1))
    end = world.time + seconds
    while world.time < end:
        idle = np.flatnonzero(fleet.status == Status.IDLE)
        if len(idle):
            yield idle
            goal = home[idle] + random.integers(-3, 4, (len(idle), 2))
            world.mov(fleet.kiva_id[idle], goal[:, 0], goal[:, 1])
        world.step(steps)


# --- how it is asked for


def test_nothing_is_real_unless_it_is_asked_for():
    assert not any(section["enabled"] for section in World().realism.values())
    assert not any(section["enabled"] for section in World(realism="ideal").realism.values())
    typical = World(realism="typical").realism
    assert typical["localisation"]["enabled"] and typical["lasers"]["enabled"]


def test_a_section_of_which_anything_is_given_is_on_with_its_defaults(tmp_path):
    file = tmp_path / "day.yaml"
    file.write_text("lasers:\n  range_noise: 0.05\nradio: {}\nlocalisation: false\n")
    loaded = World(realism=file).realism
    assert loaded["lasers"] == {"enabled": True, "range_noise": 0.05, "dropped_rays": 0.002}
    assert loaded["radio"]["enabled"] and loaded["radio"]["latency_mean"] > 0
    assert not loaded["localisation"]["enabled"]
    assert World(realism={"lasers": {"range_noise": 0.05}, "radio": {}}).realism == loaded


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("lasers:\n  rang_noise: 1\n", r"day\.yaml.*'lasers/rang_noise'.*'lasers/range_noise'"),
        ("laser:\n  range_noise: 1\n", r"day\.yaml.*unknown parameter 'laser/range_noise'"),
        (
            "lasers:\n  range_noise: .nan\n",
            r"day\.yaml.*'lasers/range_noise' is 'nan'.*from 0 to 1",
        ),
        ("lasers:\n  dropped_rays: 1.5\n", r"day\.yaml.*'1.5', expected a number from 0 to 1"),
        ("lasers:\n  dropped_rays: many\n", r"day\.yaml.*'many', expected a number"),
        ("lasers: perhaps\n", r"day\.yaml.*'lasers' is 'perhaps', expected true or false"),
        ("lasers: [1\n", r"day\.yaml.*line 2"),
        ("5\n", r"day\.yaml: sections with their numbers were expected"),
    ],
)
def test_what_makes_no_sense_is_refused_by_file_and_key(tmp_path, text, complaint):
    file = tmp_path / "day.yaml"
    file.write_text(text)
    with pytest.raises(DescriptionError, match=f"(?s){complaint}"):
        World(realism=file)


def test_an_unknown_preset_is_reported_with_those_there_are():
    with pytest.raises(FileNotFoundError, match="'sunny'.*bad_day, ideal, typical"):
        World(realism="sunny")


def kiva_with(realism):
    return KIVA.replace("<drive>traction</drive>", f"<drive>traction</drive>{realism}")


def test_a_robots_model_says_it_unless_the_world_was_told():
    noisy = "<realism><lasers><range_noise>0.02</range_noise></lasers></realism>"
    world = World()
    world.spawn(kiva_with(noisy), "kiva1", (0, 0, 0, 0))
    assert world.realism["lasers"]["range_noise"] == 0.02
    world.spawn(kiva_with(noisy), "kiva2", (0, 2, 0, 0))
    with pytest.raises(DescriptionError, match="<realism> is not that of the robots before"):
        world.spawn(kiva_with(noisy.replace("0.02", "0.03")), "kiva3", (0, 4, 0, 0))
    with pytest.raises(DescriptionError, match="'realism/lasers/noise'"):
        World().spawn(kiva_with("<realism><lasers><noise>1</noise></lasers></realism>"), "kiva1")
    ideal = World(realism="ideal")
    ideal.spawn(kiva_with(noisy), "kiva1", (0, 0, 0, 0))
    assert not ideal.realism["lasers"]["enabled"]


# --- all of it


def test_the_ideal_is_what_it_was():
    hashes = []
    for realism in (None, "ideal"):
        world = robots(2, 2, realism=realism)
        for _ in wander(world, np.random.default_rng(1), 20):
            pass
        hashes.append(world.state_hash())
    assert hashes[0] == hashes[1]


def run(seed, threads=1, listens=False):
    world = robots(5, 5, realism="bad_day", seed=seed, threads=threads)
    for _ in wander(world, np.random.default_rng(1), 20):
        if listens:
            world.scans()
    return world


def test_equal_seeds_give_equal_days_whoever_steps_and_listens():
    world = run(seed=3)
    assert run(seed=3, threads=3, listens=True).state_hash() == world.state_hash()
    assert run(seed=4).state_hash() != world.state_hash()


def test_a_checkpoint_goes_on_in_the_middle_of_things():
    world = run(seed=3)
    world.mov(world.fleet.kiva_id, np.round(world.fleet.x), np.round(world.fleet.y))
    saved = world.checkpoint()  # some drive, and commands are on the air
    other = World()
    other.restore(saved)
    for w in (world, other):
        w.step(3000)
    assert other.state_hash() == world.state_hash()
    assert other.realism == world.realism


# --- localisation


def typical_but(*without):
    """The sections of a typical day, but for those."""
    sections = World(realism="typical").realism.items()
    numbers = {name: dict(section) for name, section in sections if name not in without}
    return {name: section for name, section in numbers.items() if section.pop("enabled")}


def test_robots_stop_on_their_grid_points_by_what_they_believe():
    world = robots(6, 6, realism=typical_but("failures", "energy"), seed=2)
    fleet, off, unsure = world.fleet, [], []
    for idle in wander(world, np.random.default_rng(2), 600):
        at = np.stack([fleet.x, fleet.y], axis=1)[idle]
        off.extend(np.hypot(*(at - np.round(at)).T))
        unsure.extend(np.hypot(*(at - fleet.believed[idle, :2]).T))
    off = np.array(off)
    assert len(off) > 2500
    assert np.mean(off < 0.005) >= 0.999
    assert np.median(off) > 1e-4 and np.median(unsure) > 1e-4  # it is no longer the truth
    kinds = world.events()["kind"]
    assert not np.isin(kinds, (EventKind.LOST, EventKind.BLOCKED, EventKind.COLLISION)).any()


def test_a_robot_that_reads_no_code_stops_and_says_that_it_is_lost():
    world = World(realism={"localisation": {"missed_codes": 1, "lost_after": 3.5}})
    world.spawn_model("kiva", "kiva1", -5, 0)
    world.mov(1, 5, 0)
    world.step(12000)
    events = world.events()
    lost = events[events["kind"] == EventKind.LOST]
    assert len(lost) == 1 and "no code for 3.5 m" in lost[0]["text"]
    assert events["kind"][-1] == EventKind.BLOCKED and "lost" in events["text"][-1]
    assert -1.5 <= world.fleet.x[0] < 0  # where it could stop
    assert world.fleet.status[0] == Status.IDLE and world.fleet.vx[0] == 0


def test_a_robot_that_was_lost_goes_on_when_it_finds_a_code():
    world = World(realism={"localisation": {"missed_codes": 0.6, "lost_after": 2.5}}, seed=5)
    world.spawn_model("kiva", "kiva1", -5, 0)
    lost = arrived = 0
    for goal in (5, -5) * 6:
        for _ in range(20):
            world.mov(1, goal, 0)
            world.step(15000)
            kinds = world.events()["kind"].tolist()
            lost += kinds.count(EventKind.LOST)
            if kinds[-1] == EventKind.DONE:
                break
        arrived += abs(world.fleet.x[0] - goal) < 0.03
    assert lost > 3 and arrived == 12


# --- lasers


def test_lasers_are_noisy_and_drop_rays():
    def scans(realism):
        world = World(realism=realism)
        world.spawn_model("kiva", "kiva1", 0, 0)
        world.spawn_model("wall", "wall1", 2, 0, yaw=np.pi / 2)
        out = []
        for _ in range(200):
            world.step(100)
            out.append(world.scans()[0].copy())
        assert np.array_equal(world.scans()[0], out[-1])  # for each reader
        return np.array(out)

    ideal = scans(None)
    real = scans({"lasers": {"range_noise": 0.02, "dropped_rays": 0.1}})
    hit = np.isfinite(ideal)
    assert hit.sum() > 5000
    dropped = np.isinf(real[hit]).mean()
    visible = hit & np.isfinite(real)
    error = real[visible] - ideal[visible]
    assert dropped == pytest.approx(0.1, abs=0.02)
    assert error.std() == pytest.approx(0.02, rel=0.05) and abs(error.mean()) < 0.002
    assert np.isinf(real[~hit]).all()


# --- radio


def test_commands_come_late_are_lost_or_come_twice():
    radio = {"latency_least": 0.1, "latency_mean": 0.2, "lost": 0.3, "repeated": 0}
    world = robots(8, 8, realism={"radio": radio})
    world.rot(world.fleet.kiva_id, 1)
    world.step(99)
    assert len(world.events()) == 0
    world.step(3000)
    times = [e["time"] for e in world.events() if e["kind"] == EventKind.ACCEPTED]
    assert 64 * 0.5 < len(times) < 64 * 0.9
    assert np.mean(times) == pytest.approx(0.2, abs=0.06) and np.std(times) > 0.03

    twice = robots(1, 1, realism={"radio": {"repeated": 0.5, "lost": 0, "latency_mean": 0.005}})
    for _ in range(50):
        twice.rot(1, 1)
        twice.step(2000)
    kinds = twice.events()["kind"].tolist()
    assert kinds.count(EventKind.ACCEPTED) == 50 and 10 < kinds.count(EventKind.REFUSED) < 40


def test_who_stops_robots_does_not_wait_for_the_radio():
    world = World(realism={"radio": {"latency_least": 1, "latency_mean": 1, "lost": 0}})
    world.spawn_model("kiva", "kiva1", 0, 0)
    world.stop(0)
    world.step()
    assert world.fleet.stopped[0]


# --- a fleet at work


def work(realism, seconds, seed=1):
    """A driver that has kept the stations of a medium warehouse busy for so long."""
    driver = FleetDriver(World.preset("medium", seed=seed, realism=realism))
    try:
        demand = RandomTransports(driver.transports, seed=seed, exchange=12.0)
        while driver.time < seconds:
            demand.advance(driver.time, driver.transports.take_events())
            driver.step()
    finally:
        driver.close()
    return driver


def test_a_fleet_lives_with_a_bad_radio():
    radio = {"latency_least": 0.01, "latency_mean": 0.1, "lost": 0.02, "repeated": 0.02}
    driver = work({"radio": radio}, 180)
    assert driver.collisions == 0 and driver.watchdog == 0
    assert driver.transports.totals.delivered > 20 and driver.transports.totals.failed == 0


def test_a_fleet_works_with_robots_that_err():
    driver = work({"localisation": {}, "lasers": {}, "actuation": {}, "radio": {}}, 180)
    assert driver.collisions == 0 and driver.watchdog == 0
    assert driver.transports.totals.delivered > 25 and driver.transports.totals.failed == 0


# --- floors


def test_nobody_gets_stuck_on_a_floor_that_is_slippery_in_places():
    realism = {
        "localisation": True,
        "actuation": True,
        "floor": {"slippery_cells": 0.05, "friction": 0.25},
    }
    with Fleet("medium", **realism) as fleet:
        fleet.driver.events = []
        assert fleet.run(120) > 5
        texts = [event["text"] for events in fleet.driver.events for event in events]
        assert not [text for text in texts if "stuck" in text]
        assert fleet.driver.collisions == 0
        assert not fleet.traffic.robots.mode.any()


# --- codes


def test_a_robot_that_is_held_up_reads_the_code_on_which_it_stands():
    """Half of the codes are missed, those read are exact: of 48 robots that stop before another
    one, a quarter have then read none, where half would have without a second look."""
    count, way = 48, 8
    exact = {"missed_codes": 0.5, "code_position_noise": 0.0, "code_angle_noise": 0.0}
    world = World(realism={"localisation": {"lost_after": 100.0, **exact}})
    rows = 2.0 * np.arange(count) - count
    for number in range(2 * count):
        before, row = divmod(number, count)
        world.spawn_model("kiva", f"kiva{number + 1}", before * way, rows[row])
    ids = np.arange(1, count + 1)
    x, y = np.tile(np.arange(way + 1.0), count), np.repeat(rows, way + 1)
    world.follow(ids, np.ones_like(ids), np.zeros_like(ids), np.full_like(ids, way + 1), x, y)
    world.step(12_000)
    fleet = world.fleet
    assert (fleet.status[:count] == Status.BLOCKED).all()
    believed = fleet.believed[:count]
    wrong = np.hypot(believed[:, 0] - fleet.x[:count], believed[:, 1] - fleet.y[:count])
    assert 4 < np.count_nonzero(wrong > 1e-4) < 19
