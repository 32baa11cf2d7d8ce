# SPDX-License-Identifier: Apache-2.0
"""Layouts of warehouses: the floor that robots drive on and what stands where, without ROS.

    import numpy as np
    from warehouse_layout import Floor, check_layout

    floor = Floor(np.ones((20, 30)))              # 20 rows of 30 cells, all passable
    check_layout(floor)                           # [] : every loaded robot gets everywhere

A cell is a number, y * width + x; a heading counts quarter turns from +x towards +y.
"""

from warehouse_layout._core import Floor, FloorError, check_layout, layout_faults

__all__ = ["Floor", "FloorError", "check_layout", "layout_faults"]
