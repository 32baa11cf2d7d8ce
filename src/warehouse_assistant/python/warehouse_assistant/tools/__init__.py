# SPDX-License-Identifier: Apache-2.0
"""The tools, designed by people's questions, not by the paths of the HTTP API.

simulations    what runs; start, stop, pause; logs
overview       a warehouse in words; what stands where; why something waits; alarms, events
floor          the picture of the floor
robots         commands to robots, transports of storage units
orders         orders and stock
stations       stations, and picks that are confirmed
forecasts      what will come of a shift
whatif         what-if runs
sizing         how many robots and stations a warehouse needs
reading        the documentation; the rest of long replies
"""
