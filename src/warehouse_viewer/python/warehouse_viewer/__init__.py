# SPDX-License-Identifier: Apache-2.0
"""The warehouse in a browser: a live picture and an HTTP API.

feed → model → hub → browser, and api → commander, simulation, coordination → world. Only feed and
these three talk to ROS, through the `ros` they are given.
"""
