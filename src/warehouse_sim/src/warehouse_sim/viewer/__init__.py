# SPDX-License-Identifier: Apache-2.0
"""The warehouse in a browser: a live picture and an HTTP API.

feed → model → hub → browser, and api → commander, simulation → world. Only feed, commander and
simulation talk to ROS, through the `ros` they are given.
"""
