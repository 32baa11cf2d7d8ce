# SPDX-License-Identifier: Apache-2.0
"""Layouts of warehouses: the floor that robots drive on and what stands where, without ROS.

    import numpy as np
    from warehouse_layout import Floor, check_layout

    floor = Floor(np.ones((20, 30)))              # 20 rows of 30 cells, all passable
    check_layout(floor)                           # [] : every loaded robot gets everywhere

A cell is a number, y * width + x; a heading counts quarter turns from +x towards +y.

Rooms, from the lowest; a module imports from its own room and from lower ones:

    floor     cells: streets, stations with lanes, markings
    file      layout files, and what they name: items, stock, stations
    place     from a layout file to the place of each thing; the check that a fleet can work there
    models    SDF models of what was placed, and SDF worlds
    generate  layouts from counts, presets, or for the free floor of another world
    convert   formats of others
    drawing   plans
    cli       the program `layout`
"""

from warehouse_layout._core import Floor, FloorError, check_layout, layout_faults

__all__ = ["Floor", "FloorError", "check_layout", "layout_faults"]
