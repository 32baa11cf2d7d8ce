# SPDX-License-Identifier: Apache-2.0
"""A working warehouse: orders, stock, stations and policies over a fleet.

from kiva_plugin_cpp import World
from warehouse_operations import Operations

ops = Operations(World.preset("large"), orders="fill", seed=1, physics=False)
ops.run(hours=1)
print(ops.kpis()["item_score"])
"""

from warehouse_operations.operations import Operations
from warehouse_operations.policies import Policies, PolicyError
from warehouse_operations.shift import Settings, Shift
from warehouse_operations.site import Site

__all__ = ["Operations", "Policies", "PolicyError", "Settings", "Shift", "Site"]
