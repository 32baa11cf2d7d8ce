# SPDX-License-Identifier: Apache-2.0
"""Robots, batteries and people that are other than usual are found within 2 % by a recording of
them: real physics, a real bag and a real database."""

from pathlib import Path

import pytest
import rosbag
import rospy
import yaml
from fleet_bag import message_of, record

from kiva_plugin_cpp import World
from warehouse_layout.message_enums import State
from warehouse_msgs.msg import KivaStatus
from warehouse_operations.calibrate import program
from warehouse_operations.runs.simulation import Description, open_operations

FILES = Path(__file__).resolve().parents[4] / "rostest" / "vda5050" / "long" / "calibrate"
MOTION = {"speed": 1.1, "acceleration": 0.7, "quarter_turn_time": 0.9, "lift_time": 3.1}
ENERGY = {
    "capacity": 30,
    "electronics": 60,
    "charge_power": 900,
    "charge_taper": 0.55,
    "drive_efficiency": 0.65,
    "initial_least": 0.2,
    "initial_most": 0.5,
}
FAILURES = {"per_robot_hour": 6, "repair_time": 40}
SERVICE = {
    "seconds_a_piece": {"mean": 7.0, "sd": 2.0},
    "seconds_a_line": 2.5,
    "pick_seconds": 2.0,
    "seconds_a_bundle": 15.0,
}
CLOSE = 0.02


def measure(sources, tmp_path, capacity=960.0):
    out = tmp_path / "found.yaml"
    print(program.write(program.read([str(s) for s in sources]), capacity, out))
    return yaml.safe_load(out.read_text()), out.read_text()


def within(text, key):
    """The interval of a number of a file."""
    line = next(line for line in text.splitlines() if line.strip().startswith(f"{key}:"))
    low, _, high = line.partition("# ")[2].partition(",")[0].partition(" to ")
    return float(low), float(high)


def orders(path, count, together=1, every=0):
    """Writes orders of two lines, so many at a time of the same SKUs; returns the path."""
    rows = ["reference,sku,quantity,at"]
    for n in range(count):
        group = n // together
        skus = [(group * 7 + k * 11) % 24 + 1 for k in range(2)]
        rows += [f"o{n},sku{s},{1 + (n + k) % 3},{group * every}" for k, s in enumerate(skus)]
    path.write_text("\n".join(rows) + "\n")
    return str(path)


@pytest.fixture(scope="module")
def hall(tmp_path_factory):
    """(the layout of a small hall with many chargers, its folder)."""
    folder = tmp_path_factory.mktemp("physics")
    text = (FILES / "believed.layout.yaml").read_text().replace("vp^p", "vc^p")
    (folder / "hall.layout.yaml").write_text(text.replace("vp^s", "vc^s"))
    (folder / "stock.csv").write_text((FILES / "stock.csv").read_text())
    return str(folder / "hall.layout.yaml"), folder


def test_robots_and_batteries_are_found_in_a_bag_of_real_physics(hall, tmp_path):
    layout, folder = hall
    truth = {"motion": MOTION, "energy": ENERGY, "failures": FAILURES}
    (folder / "truth.yaml").write_text(yaml.safe_dump(truth))
    bag = tmp_path / "fleet.bag"
    description = Description(
        layout=layout,
        robots=8,
        orders=orders(tmp_path / "orders.csv", 30),
        realism=str(folder / "truth.yaml"),
        seed=3,
    )
    with open_operations(description) as ops:
        record(ops, 700, bag)
    measured, text = measure([bag], tmp_path, ENERGY["capacity"])
    for key in ("speed", "acceleration", "quarter_turn_time"):
        assert measured["motion"][key] == pytest.approx(MOTION[key], rel=CLOSE), key
    for key in ("electronics", "charge_power", "drive_efficiency"):
        assert measured["energy"][key] == pytest.approx(ENERGY[key], rel=CLOSE), key
    for section in (MOTION, FAILURES):
        for key, value in section.items():
            low, high = within(text, key)
            slack = CLOSE * value if section is MOTION else 0.0
            assert low - slack <= value <= high + slack, key


def test_chargers_are_found_by_robots_that_stand_there(hall, tmp_path):
    world = World.layout(hall[0], robots=8, seed=2, realism={"energy": ENERGY})
    bag = tmp_path / "parked.bag"
    with rosbag.Bag(str(bag), "w") as file:
        for _ in range(200):
            world.step(1000)
            message = message_of(world)
            file.write("/warehouse/fleet", message, message.stamp)
    measured, _ = measure([bag], tmp_path, ENERGY["capacity"])
    for key in ("electronics", "charge_power", "charge_taper"):
        assert measured["energy"][key] == pytest.approx(ENERGY[key], rel=CLOSE), key


def test_lifts_are_found_by_reports_at_each_change(tmp_path):
    world = World(realism={"motion": MOTION})
    for n in range(1, 7):
        world.spawn_model("kiva", f"kiva{n}", 3 * n, 0)
        world.spawn_model("storage_unit", f"storage_unit{n}", 3 * n, 0)
    ids, bag, before = list(range(1, 7)), tmp_path / "lifts.bag", {}
    with rosbag.Bag(str(bag), "w") as file:
        for round_ in range(4):
            world.lift(ids, [int(round_ % 2 == 0)] * 6, ids)
            for _ in range(4000):
                world.step()
                fleet = world.fleet
                for number, state in zip(fleet.kiva_id.tolist(), fleet.state.tolist()):
                    if before.get(number) != state:
                        before[number] = state
                        status = KivaStatus(kiva_id=number, state=state)
                        status.header.stamp = rospy.Time.from_sec(world.time)
                        file.write(f"/kiva{number}/status", status, status.header.stamp)
    assert State.LIFTING not in before.values()
    measured, _ = measure([bag], tmp_path)
    assert measured == {"motion": {"lift_time": pytest.approx(MOTION["lift_time"], rel=CLOSE)}}


def test_people_are_found_in_the_database_of_a_shift(hall, tmp_path):
    layout, _ = hall
    stations = {"pick2": {"seconds_a_piece": 9.0}}
    people = tmp_path / "people.yaml"
    people.write_text(yaml.safe_dump({"service": SERVICE | {"stations": stations}}))
    description = Description(
        layout=layout,
        robots=8,
        orders=orders(tmp_path / "orders.csv", 1400, together=4, every=100),
        physics=False,
        realism=str(people),
    )
    database = tmp_path / "run.db"
    with open_operations(description, str(database)) as ops:
        ops.step_until(10 * 3600.0)
    measured, _ = measure([database], tmp_path)
    service = measured["service"]
    of_both = service["stations"]
    assert of_both["pick1"]["seconds_a_piece"]["mean"] == pytest.approx(7.0, rel=CLOSE)
    assert of_both["pick2"]["seconds_a_piece"]["mean"] == pytest.approx(9.0, rel=CLOSE)
    assert of_both["pick1"]["seconds_a_piece"]["sd"] == pytest.approx(2.0, rel=0.1)
    for key in ("seconds_a_line", "pick_seconds", "seconds_a_bundle"):
        assert service[key] == pytest.approx(SERVICE[key], rel=CLOSE), key
