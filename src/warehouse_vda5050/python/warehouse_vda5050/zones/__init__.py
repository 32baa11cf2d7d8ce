# SPDX-License-Identifier: Apache-2.0
"""Zone sets of VDA 5050 3.0.0.

zone: zones, their requests and responses as plain values. outline: the geometry of their polygons.
store: the zone sets that a vehicle has, and which of them is enabled. route: which zones an order
comes to. releases: requests for RELEASE zones, and what became of them. vehicle.zone_guard keeps a
vehicle to them.
"""
