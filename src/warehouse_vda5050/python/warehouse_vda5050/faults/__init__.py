# SPDX-License-Identifier: Apache-2.0
"""Faults of vehicles on demand, by which masters are tried.

kinds: what a vehicle can be asked for, and the request. active: which faults it has, and how long.
faulty_driver: those of the robot itself: place, heading, battery, speed, errors, refusals. wire:
those of its messages: silence, states that are lost, doubled or reordered, a clock that is off.
vehicle_faults: the three of one vehicle together. script: faults at times, of a file.
"""
