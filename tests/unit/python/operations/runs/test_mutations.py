# SPDX-License-Identifier: Apache-2.0
"""Files that users write, damaged: each is read, or refused in words that name it.

MUTATIONS: how many of each kind; thousands in make test-long.
"""

import os

import numpy as np
import pytest
from instance_file import write_instance
from mutations import mutated

from kiva_plugin_cpp import DescriptionError, World
from warehouse_operations.policies import Policies, PolicyError
from warehouse_operations.runs import sweep
from warehouse_operations.runs.rawsim import InstanceError, read_instance
from warehouse_operations.runs.rawsim_settings import read_settings
from warehouse_operations.stock.demand import DemandError, read_csv

COUNT = int(os.environ.get("MUTATIONS", "60"))
SETTINGS = """<?xml version="1.0"?>
<SettingConfiguration>
  <Seed>7</Seed>
  <SimulationDuration>3600</SimulationDuration>
  <InventoryConfiguration>
    <OrderMode>Fill</OrderMode>
    <InitialInventory>0.7</InitialInventory>
    <DemandInventoryConfiguration>
      <OrderCount>150</OrderCount>
      <BundleCount>100</BundleCount>
      <InventoryLevelBundleRestartThreshold>0.6</InventoryLevelBundleRestartThreshold>
      <InventoryLevelBundleStopThreshold>0.8</InventoryLevelBundleStopThreshold>
    </DemandInventoryConfiguration>
  </InventoryConfiguration>
</SettingConfiguration>
"""
SWEEP = """out: results
size: medium
minutes: 20
physics: false
seeds: 3
orders: fill:100
policies: {storage: nearest, replenishment: {name: threshold, begin: 0.6, stop: 0.8}}
grid:
  policies.orders: [random, pile-on]
  policies.units: [nearest, most lines]
  orders: [fill, "poisson:300"]
"""
POLICIES = """orders: pile-on
units: {name: most lines}
storage: cache
bins: emptiest
replenishment: {name: threshold, begin: 0.6, stop: 0.8}
charging: {name: opportunity, low: 0.2, high: 0.9, enough: 0.5}
"""
REALISM = """localisation:
  missed_codes: 0.01
lasers: true
radio: {latency_mean: 0.1, lost: 0.01}
failures:
  per_robot_hour: 0.1
  repair_time: 300
energy: false
"""
ORDERS = """reference,sku,quantity,at,due,priority
A-17,sku-3,2,0,1800,0
A-17,sku-9,1,0,1800,0
B-2,sku-4,3,60.5,0,200
"""


def instance(folder):
    path = write_instance(folder / "whole.xinst", bots=2, picking=1, replenishing=1, rows=1)
    return path.read_text()


# Name of the file: its text, how it is read, and what a wrong one raises.
READERS = {
    "file.xinst": (instance, read_instance, InstanceError),
    "file.xsett": (SETTINGS, read_settings, InstanceError),
    "sweep.yaml": (SWEEP, sweep.read, sweep.SweepError),
    "policies.yaml": (POLICIES, Policies.read, PolicyError),
    "realism.yaml": (REALISM, lambda path: World(realism=path), DescriptionError),
    "orders.csv": (ORDERS, read_csv, DemandError),
}


def text_of(name, folder):
    text = READERS[name][0]
    return text(folder) if callable(text) else text


def complaint(path, content):
    """What the reader of such a file says of it; "" if it takes it."""
    _, read, error = READERS[path.name]
    path.write_bytes(content)
    try:
        read(path)
    except error as refusal:
        return str(refusal)
    return ""


@pytest.mark.parametrize("name", READERS)
def test_a_damaged_file_is_read_or_refused_in_words(tmp_path, name):
    text, path = text_of(name, tmp_path), tmp_path / name
    assert complaint(path, text.encode()) == ""
    for seed in range(COUNT):
        content = mutated(text, np.random.default_rng(seed))
        try:
            text_of_error = complaint(path, content)
        except Exception as error:
            raise AssertionError(f"seed {seed}: {content.decode(errors='replace')}") from error
        assert not text_of_error or name in text_of_error, f"seed {seed}: {text_of_error}"
        assert "Traceback" not in text_of_error and " object at 0x" not in text_of_error, (
            f"seed {seed}: {text_of_error}"
        )


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("file.xsett", 'version="1.0"', 'version="1.0" encoding="queues-8"', "file.xsett:1: "),
        ("file.xsett", ">150<", ">nan<", "OrderCount is 'nan'; a number from 0 to 1e+09"),
        ("file.xsett", ">7<", ">1e400<", "Seed is '1e400'"),
        ("sweep.yaml", "out: results", "out: 5", "out is 5; the name of a folder was expected"),
        ("sweep.yaml", "out: results", "out: ~", "out is None; the name of a folder"),
        ("sweep.yaml", "orders: fill:100", "orders: 5", "orders is 5; fill, fill:N"),
        ("sweep.yaml", "seeds: 3", "seeds: 10000000000000000000", "seeds is 1000"),
        (
            "sweep.yaml",
            "seeds: 3",
            "seeds: [10000000000000000000]",
            "from 0 to 9223372036854775807",
        ),
        ("sweep.yaml", "minutes: 20", "minutes: .nan", "minutes is nan; a number above 0"),
        ("sweep.yaml", "minutes: 20", "minutes: @20", "sweep.yaml:3: "),
        ("sweep.yaml", "  orders:", "  true:", "'True' can't be varied"),
        ("policies.yaml", "units:", "2024-02-31:", "day is out of range for month"),
        ("realism.yaml", "true", "\udcff", "invalid start byte"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(tmp_path, name, old, new, message):
    text = text_of(name, tmp_path).replace(old, new, 1)
    text_of_error = complaint(tmp_path / name, text.encode(errors="surrogateescape"))
    assert message in text_of_error and (text_of_error == "") == (message == ""), text_of_error


def test_an_instance_in_an_encoding_that_nobody_knows(tmp_path):
    text = text_of("file.xinst", tmp_path)
    text = '<?xml version="1.0" encoding="queues-8"?>' + text[text.index("<Instance") :]
    assert "file.xinst:1: " in complaint(tmp_path / "file.xinst", text.encode())
