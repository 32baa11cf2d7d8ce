# SPDX-License-Identifier: Apache-2.0
"""The server's side of the page /whatif: scenarios in a folder, their runs in processes of their
own, and how they compare. Imports no ROS.

A scenario is a folder with scenario.yaml, a sweep without a grid, and one folder seed-N for each of
its runs with what `simulate --out` writes: `report` and `sweep` read both.
"""
