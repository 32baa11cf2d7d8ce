# SPDX-License-Identifier: Apache-2.0
"""The numbers of robots and stations for a wish: the program `size`.

A wish (wish) is a number of orders an hour with a limit on late ones. A point is a number of robots
and of open stations; its shifts differ by their seeds (point), are kept (store) and judged
(verdict). The search judges only the points that the answer needs, and page shows it.
"""
