# SPDX-License-Identifier: Apache-2.0
"""The numbers of robots and stations that a wish takes: the program `size`.

A wish (wish) is a number of orders an hour, of which hardly any may be late. A point is a number of
robots and of open stations; its shifts differ by their seeds (point), are kept (store) and judged
(verdict). The search asks for no more of them than the answer needs, and page shows it.
"""
