# SPDX-License-Identifier: Apache-2.0
"""Instances of RAWSim-O are read whatever their spacing and age, and shifts in them are good."""

import os

import numpy as np
import pytest
from instance_file import (
    BASIC_INSTANCE,
    write_configuration,
    write_hall_instance,
    write_instance,
    write_tiers_instance,
)

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout import convert as formats
from warehouse_layout.file import layout_file
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.place import placement
from warehouse_operations.goods.kinds import MOST_BINS, Goods, Kinds
from warehouse_operations.policies import Policies, PolicyError, rawsim_policies
from warehouse_operations.runs import simulation
from warehouse_operations.runs.rawsim import InstanceError, read_instance
from warehouse_operations.runs.rawsim_settings import read_settings
from warehouse_operations.runs.simulation import (
    Description,
    open_operations,
    simulate,
    with_settings,
)
from warehouse_operations.stock.inventory import Reason
from warehouse_operations.stock.site import Site
from warehouse_operations.stock.travel import Travel


@pytest.mark.parametrize("spacing, old", [(1.0, False), (1.04, True), (1.0571, False)])
def test_an_instance(tmp_path, spacing, old):
    site = read_instance(write_instance(tmp_path / "a.xinst", spacing=spacing, old=old))
    plan = site.plan
    plan.check()
    assert plan.spacing == pytest.approx(spacing, abs=1e-3)
    assert plan.shape == (22, 27)
    assert len(site.robots) == 16 and len(site.units) == 178
    assert [(s.name, s.kind, len(s.cells), s.service) for s in plan.stations] == [
        ("pick1", "PICK", 8, 3),
        ("pick2", "PICK", 8, 3),
        ("replenish1", "REPLENISH", 8, 3),
        ("replenish2", "REPLENISH", 8, 3),
    ]
    # The street at the bottom leads east, the one at its right end north.
    assert plan.exits[0, 6] & 0b0101 == 0b0001 and plan.exits[5, 22] & 0b1010 == 0b0010
    assert site.kinematics.quarter_turn == 0.625
    settings = site.settings.of("pick1")
    assert (settings.slots, settings.piece_s, settings.pick_s) == (12, 10.0, 3.0)


PUBLISHED = 110.4  # pieces that RAWSim-O picks on its BasicInstance in 600 s, mean of five seeds
BOUND = 120  # pieces that two stations can pick in 600 s


@pytest.fixture
def basic_instance(tmp_path):
    """The floor of RAWSim-O's BasicInstance, as its generator makes it."""
    layout = tmp_path / "basic.layout.yaml"
    formats.convert(write_configuration(tmp_path / "basic.xlayo", **BASIC_INSTANCE), layout)
    file = layout_file.read(layout)
    plan = Site.of_layout(placement.place(file, 1), "").plan
    assert (plan.shape, file.storage_units, file.robots) == ((28, 56), 428, 16)
    return str(layout)


def test_ten_minutes_on_the_basic_instance_are_limited_by_its_stations(basic_instance):
    """Two stations are the limit, as in RAWSim-O, but for the way of the first units. Those take
    the short cuts of queues, and come earlier than RAWSim-O's: 115 pieces."""
    pieces = []
    for seed in range(1, 21):
        with open_operations(Description(layout=basic_instance, seed=seed, physics=False)) as ops:
            ops.run(minutes=10)
            figures = ops.kpis()
        pieces.append(figures["items_picked"])
        assert figures["item_upper_bound_per_hour"] == pytest.approx(6 * BOUND)
    assert PUBLISHED <= np.mean(pieces) <= 1.06 * PUBLISHED < BOUND


def test_a_layout_configuration_is_an_instance_with_pods_full_by_weight(tmp_path):
    values = {**BASIC_INSTANCE, "PodCapacity": 50, "TurnSpeed": 4, "ItemBundleTransferTime": 7}
    site = read_instance(write_configuration(tmp_path / "basic.xlayo", **values))
    assert (site.plan.shape, len(site.units), len(site.robots)) == ((28, 56), 428, 16)
    assert site.name == "1-2-2-16-0.85" and site.kinematics.quarter_turn == 1.0
    assert set(site.goods.limits.values()) == {50.0}
    assert site.settings.of("pick1").slots == 12
    assert site.settings.of("replenish1").bundle_s == 7


def test_a_shift_on_a_layout_configuration_keeps_to_the_weights(tmp_path):
    path = write_configuration(tmp_path / "basic.xlayo", **BASIC_INSTANCE)
    with open_operations(Description(instance=str(path), physics=False)) as ops:
        ops.run(minutes=10)
        weight = ops.site.goods.weight
        for bins in ops.shift.inventory.of_unit.values():
            assert sum(weight(b.sku) * (b.quantity + b.expected) for b in bins) <= 500
        assert ops.kpis()["items_picked"] > 0.9 * BOUND


def test_a_layout_configuration_with_robots_that_stand_is_refused(tmp_path):
    path = write_configuration(tmp_path / "a.xlayo", MaxVelocity=0)
    with pytest.raises(InstanceError, match="MaxVelocity and MaxAcceleration above 0 were"):
        read_instance(path)


def test_ten_minutes_with_physics_on_a_layout_configuration(tmp_path):
    path = write_configuration(tmp_path / "basic.xlayo", **BASIC_INSTANCE)
    assert with_physics(1, instance=str(path))["items_picked"] == pytest.approx(PUBLISHED, rel=0.05)


SETTINGS = """<SettingConfiguration><SimulationDuration>600</SimulationDuration><Seed>3</Seed>
<InventoryConfiguration><OrderMode>{mode}</OrderMode><InitialInventory>0.6</InitialInventory>
<DemandInventoryConfiguration><OrderCount>50</OrderCount><BundleCount>40</BundleCount>
<InventoryLevelBundleStopThreshold>0.8</InventoryLevelBundleStopThreshold>
<InventoryLevelBundleRestartThreshold>{begin}</InventoryLevelBundleRestartThreshold>
</DemandInventoryConfiguration></InventoryConfiguration></SettingConfiguration>"""


def test_settings(tmp_path):
    path = tmp_path / "a.xsett"
    path.write_text(SETTINGS.format(mode="Fill", begin=0.5))
    settings = read_settings(path)
    assert (settings.orders, settings.duration_s, settings.seed, settings.level) == (
        "fill:50",
        600,
        3,
        0.6,
    )
    assert settings.policies["replenishment"] == {
        "name": "threshold",
        "begin": 0.5,
        "stop": 0.8,
        "waiting": 40,
    }
    for mode, begin, message in (
        ("Fixed", 0.5, "OrderMode is 'Fixed'; Fill or Poisson was expected"),
        ("Fill", "low", "InventoryLevelBundleRestartThreshold is 'low'; a number"),
    ):
        path.write_text(SETTINGS.format(mode=mode, begin=begin))
        with pytest.raises(InstanceError, match=message):
            read_settings(path)


# As RAWSim-O writes its settings, but for the log's.
WHOLE_SETTINGS = """<?xml version="1.0" encoding="utf-8"?>
<SettingConfiguration xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <Name>SKU1000</Name>
  <SimulationWarmupTime>0</SimulationWarmupTime>
  <SimulationDuration>86400</SimulationDuration>
  <UseAcceleration>false</UseAcceleration>
  <UseTurnDelay>true</UseTurnDelay>
  <InventoryConfiguration>
    <ItemType>SimpleItem</ItemType>
    <OrderMode>Fill</OrderMode>
    <BundleSizeMin>4</BundleSizeMin>
    <OrderPositionCountMean>2.5</OrderPositionCountMean>
    <DemandInventoryConfiguration>
      <OrderCount>50</OrderCount>
      <InventoryLevelOrderStopThreshold>0.1</InventoryLevelOrderStopThreshold>
    </DemandInventoryConfiguration>
    <SimpleItemConfiguration>
      <GeneratorConfigFile>MaTi-1000.xgenc</GeneratorConfigFile>
    </SimpleItemConfiguration>
  </InventoryConfiguration>
</SettingConfiguration>
"""


def test_settings_that_are_not_followed_are_named(tmp_path):
    path = tmp_path / "whole.xsett"
    path.write_text(WHOLE_SETTINGS)
    remarks = simulation.remarks(Description(settings=str(path)))
    inventory = "InventoryConfiguration/"
    assert remarks == [
        f"{path}: {inventory}DemandInventoryConfiguration/InventoryLevelOrderStopThreshold 0.1 is"
        " not followed",
        f"{path}: GeneratorConfigFile MaTi-1000.xgenc is not followed: it does not lie beside it",
    ]


def test_an_instance_where_robots_could_jam_is_told_with_physics_and_without(tmp_path):
    path = write_instance(tmp_path / "a.xinst")
    edge = "<Waypoint>9</Waypoint>"
    text = path.read_text()
    assert edge in text
    path.write_text(text.replace(edge, ""))  # no way leads into it any more
    with pytest.raises(InstanceError, match="no loaded robot can drive there") as error:
        open_operations(Description(instance=str(path)))
    (remark,) = simulation.remarks(Description(instance=str(path), physics=False))
    cause, _, advice = str(error.value).partition("; simulate without physics: ")
    assert remark == f"{cause}; {advice}"


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("</Instance>", "", r":\d+: no element found"),
        ("Instance", "Layout", "<Layout>; <Instance> was expected"),
        ('ID="3" Tier="0"', 'ID="3" Tier="1"', "Bot 3 is on Tier 1, which has no Waypoint"),
        ('MaxVelocity="1.5"', 'MaxVelocity="fast"', "Bot 0: MaxVelocity is 'fast'"),
        ('MaxVelocity="1.5"', 'MaxVelocity="2"', "bots of 2 kinds"),
        ("<Waypoint>7</Waypoint>", "<Waypoint>9999</Waypoint>", "has a path to 9999, which is not"),
        ("<Waypoint>7</Waypoint>", "<Waypoint>200</Waypoint>", "are no neighbours on a grid"),
        ('OutputStation="0"', 'OutputStation="-1"', "OutputStation 0 has no Waypoint"),
        ('PodStorageLocation="true"', 'PodStorageLocation="false"', "on no PodStorageLocation"),
    ],
)
def test_a_wrong_instance_is_told(tmp_path, old, new, message):
    path = write_instance(tmp_path / "a.xinst")
    text = path.read_text()
    assert old in text
    everywhere = old in ("Instance", 'PodStorageLocation="true"')
    path.write_text(text.replace(old, new) if everywhere else text.replace(old, new, 1))
    with pytest.raises(InstanceError, match=message) as error:
        read_instance(path)
    assert str(error.value).startswith(str(path))


LANDING, ABOVE = 450, 905  # waypoints of the elevator in a file of two tiers


@pytest.mark.parametrize(
    "old, new, message",
    [
        (f"{LANDING}/{ABOVE}/10", "a/b", r"Elevator 0: Timing is 'a/b'; a/b/s, the numbers"),
        (f"{LANDING}/{ABOVE}/10", f"{ABOVE}/{LANDING}/9", f"no Timing from Waypoint {LANDING} to"),
        (f"{LANDING}/{ABOVE}/10", f"{LANDING}/{ABOVE}/-1", f"Timing is '{LANDING}/{ABOVE}/-1'"),
        ("<Waypoints><Waypoint>4", "<Waypoints><Waypoint>94", "Elevator 0 names Waypoint 9450: n"),
        (
            f"{LANDING}</Waypoint><Waypoint>{ABOVE}",
            f"{LANDING}</Waypoint><Waypoint>{LANDING}",
            "tw",
        ),
        (f"{LANDING}</Waypoint><Waypoint>{ABOVE}", "7</Waypoint><Waypoint>8", "on each of its ti"),
        (f"<Waypoint>{ABOVE}</Waypoint></Waypoints>", "</Waypoints>", "no Elevator joins Tier 1"),
        (
            "<Waypoint>7</Waypoint>",
            "<Waypoint>700</Waypoint>",
            "Waypoints .* and 700 are on two ti",
        ),
    ],
)
def test_a_wrong_elevator_is_told(tmp_path, old, new, message):
    path = write_tiers_instance(tmp_path / "a.xinst")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InstanceError, match=message) as error:
        read_instance(path)
    assert str(error.value).startswith(str(path))


STOCK = """<SettingConfiguration><InventoryConfiguration><OrderMode>Fill</OrderMode>
<InitialInventory>0.6</InitialInventory>
<ItemWeightMin>5</ItemWeightMin><ItemWeightMax>5</ItemWeightMax>
<BundleSizeMin>6</BundleSizeMin><BundleSizeMax>6</BundleSizeMax>
<PositionCountMin>2</PositionCountMin><PositionCountMax>2</PositionCountMax>
<OrderPositionCountMin>1</OrderPositionCountMin><OrderPositionCountMax>1</OrderPositionCountMax>
<SimpleItemConfiguration><GeneratorConfigFile>three.xgenc</GeneratorConfigFile>
</SimpleItemConfiguration></InventoryConfiguration></SettingConfiguration>"""
SKUS = """<SimpleItemGeneratorConfiguration>
<ItemDescriptions><P><Key>0</Key><Value>9</Value></P><P><Key>1</Key><Value>9</Value></P>
<P><Key>2</Key><Value>9</Value></P></ItemDescriptions>
<ItemDescriptionWeights><P><Key>1</Key><Value>50</Value></P></ItemDescriptionWeights>
<ItemDescriptionBundleSizes><P><Key>1</Key><Value>11</Value></P></ItemDescriptionBundleSizes>
<ItemWeights><P><Key>0</Key><Value>3</Value></P><P><Key>1</Key><Value>4</Value></P>
</ItemWeights></SimpleItemGeneratorConfiguration>"""


def small_pods(tmp_path, capacity, skus=SKUS):
    """The description of a shift on pods of that capacity, with the stock of STOCK."""
    path = write_instance(tmp_path / "a.xinst")
    path.write_text(path.read_text().replace('Capacity="500"', f'Capacity="{capacity}"'))
    (tmp_path / "a.xsett").write_text(STOCK)
    if skus:
        (tmp_path / "three.xgenc").write_text(skus)
    settings = str(tmp_path / "a.xsett")
    return with_settings(Description(instance=str(path), settings=settings, physics=False))


@pytest.mark.parametrize("capacity, bundles", [(500, 16), (50, 1)])
def test_pods_hold_bundles_by_weight(tmp_path, capacity, bundles):
    with open_operations(small_pods(tmp_path, capacity, skus="")) as ops:
        inventory = ops.shift.inventory
        unit = next(iter(inventory.of_unit))
        for bin_ in inventory.of_unit[unit]:
            if bin_.available:
                inventory.move(bin_, bin_.sku, -bin_.available, Reason.SHORT)
        taken = 0
        for bin_ in inventory.of_unit[unit]:
            if inventory.takes(bin_, bin_.sku, 6):
                inventory.expect(bin_, bin_.sku, 6)
                taken += 1
        assert taken == bundles and not inventory.takes(bin_, "sku-1", 6)
        ops.run(minutes=20)
        for bins in inventory.of_unit.values():
            assert sum(5 * (bin_.quantity + bin_.expected) for bin_ in bins) <= capacity
        assert inventory.level == pytest.approx(5 * inventory.total / (capacity * 178))
        assert inventory.level > 0.4


def test_stock_and_orders_follow_the_settings_and_their_file_of_skus(tmp_path):
    description = small_pods(tmp_path, 500)
    (remark,) = simulation.remarks(description)
    assert "1 of 3 SKUs are left out: no pod holds a bundle of them" in remark
    with open_operations(description) as ops:
        # A bundle of sku-2 weighs 550: no pod holds it.
        assert ops.shift.assortment.skus == ("sku-1", "sku-3")
        assert ops.shift.assortment.popularity.tolist() == [0.75, 0.25]
        assert ops.shift.inventory.level == pytest.approx(0.6, abs=0.01)
        ops.run(minutes=10)
        assert {tuple(line.quantity for line in order.lines) for order in ops.orders.values()} == {
            (2,)
        }
        assert ops.kpis()["items_picked"] > 60


@pytest.mark.parametrize(
    "old, new, message",
    [
        ("<Key>1</Key><Value>50<", "<Key>1</Key><Value>x<", "Key '1' with Value 'x'; numbers were"),
        ("<Key>1</Key><Value>50<", "<Key>7</Key><Value>5<", "ItemDescriptionWeights has Key 7"),
        ("<Value>11<", "<Value>0<", "ItemDescriptionBundleSizes of Key 1 is 0; 1 to 10000 was"),
        ("<Key>0</Key><Value>9</Value>", "", "ItemDescriptions has Key '' with Value ''"),
    ],
)
def test_a_wrong_file_of_skus_is_refused(tmp_path, old, new, message):
    assert SKUS.count(old) == 1
    with pytest.raises(InstanceError, match=message) as error:
        read_settings(small_pods(tmp_path, 500, SKUS.replace(old, new)).settings)
    assert str(error.value).startswith(str(tmp_path / "three.xgenc"))


def test_a_floor_too_narrow_for_bodies_is_refused_with_physics(tmp_path):
    path = str(write_instance(tmp_path / "a.xinst", spacing=0.45))
    with pytest.raises(InstanceError, match="waypoints are 0.45 m apart; 0.97 m or more"):
        open_operations(Description(instance=path))
    (remark,) = simulation.remarks(Description(instance=path, physics=False))
    assert remark.endswith("ideal robots, which pass through each other, work there")


def test_pods_too_small_for_any_bundle_are_refused(tmp_path):
    with pytest.raises(InstanceError, match="fits on a pod of Capacity 7; a Capacity for the"):
        open_operations(small_pods(tmp_path, 7, ""))


@pytest.mark.parametrize("capacity, bins", [(0.0, 1), (7.0, 1), (1e12, MOST_BINS)])
def test_pods_of_any_capacity_have_bins_that_fit_in_memory(capacity, bins):
    assert len(Goods(Kinds.drawn(), {1: capacity}).items()) == bins


def test_a_wrong_range_of_settings_is_refused(tmp_path):
    path = tmp_path / "a.xsett"
    for old, new, message in (
        ("<BundleSizeMin>6", "<BundleSizeMin>7", "BundleSizeMin is 7 and BundleSizeMax 6; above 0"),
        ("<PositionCountMin>2", "<PositionCountMin>3", "PositionCountMin and PositionCountMax are"),
    ):
        path.write_text(STOCK.replace(old, new))
        with pytest.raises(InstanceError, match=message):
            read_settings(path)


def test_a_shift_with_settings(tmp_path):
    path = write_instance(tmp_path / "a.xinst")
    (tmp_path / "a.xsett").write_text(SETTINGS.format(mode="Fill", begin=0.5))
    description = Description(
        instance=str(path), settings=str(tmp_path / "a.xsett"), seconds=300, physics=False
    )
    run, faults = simulate(description, tmp_path / "out")
    assert faults == [] and run.kpis["items_picked"] > 30


@pytest.mark.parametrize("physics", [False, True])
def test_robots_take_short_cuts_into_queues(tmp_path, physics):
    """Ideal ones never drive the turns between them, simulated ones while others are ahead."""
    path = str(write_hall_instance(tmp_path / "a.xinst"))
    with open_operations(Description(instance=path, physics=physics, seed=1)) as ops:
        ops.run(minutes=5)
        for station in ops.site.plan.stations:
            passes = ops.fleet.passages().flat[station.cells]
            turns = passes[5:8]  # between the cell with a short cut and that with an entry
            assert (turns < passes[11]).all() and passes[11] > 2, station.name
            assert physics or not turns.any()
        assert ops.fleet.stuck == 0


def test_no_way_leads_through_the_lane_of_another_station(tmp_path):
    """Even where a short cut, the service cell and the exit would be nearer than the streets."""
    plan = read_instance(write_hall_instance(tmp_path / "a.xinst")).plan
    travel = Travel(plan, Kinematics())
    for station in plan.stations:
        lane = set(station.cells.tolist())
        before = next(cell for cell, _ in station.short_cuts if cell not in lane)
        last = int(station.cells[-1])
        steps = [dx + dy * plan.width for dx, dy in STEPS]
        after = next(last + step for h, step in enumerate(steps) if plan.exits.flat[last] >> h & 1)
        ways = [travel.loaded_from(before).cells(after), travel.loaded_to(after).cells(before)]
        assert [lane & set(way) for way in ways] == [set(), set()]
        assert before in travel.loaded_to(station.service_cell).cells(before)
        out = travel.loaded_from(station.service_cell).cells(after)
        assert set(out) & lane == set(station.cells[station.service :].tolist())


def with_physics(seed, minutes=10, **site):
    """The figures of a shift; no robot touched, blocked or held up another for long."""
    with open_operations(Description(seed=seed, **site)) as ops:
        ops.run(minutes=minutes)
        figures = ops.kpis()
        assert ops.fleet.stuck == 0
        assert ops.fleet.plan.spacing == pytest.approx(ops.fleet.world.grid_spacing)
    assert [figures[name] for name in ("collisions", "blocked", "watchdog")] == [0, 0, 0]
    return figures


@pytest.mark.long
def test_ten_minutes_with_physics_on_the_basic_instance_are_no_fewer_than_rawsims(basic_instance):
    seeds = range(1, int(os.environ.get("INSTANCE_SEEDS", "3")) + 1)
    runs = [with_physics(seed, layout=basic_instance) for seed in seeds]
    pieces = np.mean([figures["items_picked"] for figures in runs])
    assert PUBLISHED <= pieces <= 1.06 * PUBLISHED
    assert np.mean([figures["bundles_stored"] for figures in runs]) > 50


def test_shifts_with_physics_on_an_instance(tmp_path):
    path = write_instance(tmp_path / "a.xinst", spacing=1.04)
    assert with_physics(1, instance=str(path))["item_score"] > 0.9


def test_halls_buffers_and_winding_queues(tmp_path):
    """The upper bound is reached but for the first units' way."""
    path = write_hall_instance(tmp_path / "a.xinst")
    lanes = {(s.name[:-1], len(s.cells), s.service) for s in read_instance(path).plan.stations}
    assert lanes == {("pick", 16, 12), ("replenish", 16, 12)}
    assert with_physics(1, 15, instance=str(path))["item_score"] > 0.9


XCONF = """<?xml version="1.0" encoding="utf-8"?>
<ControlConfiguration xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <PathPlanningConfig xsi:type="FARPathPlanningConfiguration"/>
  <TaskAllocationConfig xsi:type="BalancedTaskAllocationConfiguration">
    <OutputPodOrderType>WorkAmountSameTier</OutputPodOrderType>
  </TaskAllocationConfig>
  <StationActivationConfig xsi:type="ActivateAllStationActivationConfiguration"/>
  <ItemStorageConfig xsi:type="ReactiveItemStorageConfiguration"/>
  <PodStorageConfig xsi:type="FixedPodStorageConfiguration"/>
  <RepositioningConfig xsi:type="DummyRepositioningConfiguration"/>
  <OrderBatchingConfig xsi:type="DefaultOrderBatchingConfiguration">
    <OrderSelectionRule>FCFS</OrderSelectionRule>
  </OrderBatchingConfig>
  <MethodManagementConfig xsi:type="NoChangeMethodManagementConfiguration"/>
</ControlConfiguration>
"""


def test_policies_of_a_controller_are_taken_and_others_named(tmp_path):
    path = tmp_path / "one.xconf"
    path.write_text(XCONF)
    assert Policies.read(path).choices == {
        "robots": "balanced",
        "storage": "fixed",
        "orders": "first come",
        "units": "most work",
    }
    assert rawsim_policies.remarks(path) == [
        f"{path}: ItemStorageConfig Reactive is not followed",
        f"{path}: PathPlanningConfig FAR is not followed",
    ]
    path.write_text("<Instance/>")
    with pytest.raises(PolicyError, match="<Instance>; <ControlConfiguration> was expected"):
        Policies.read(path)
