# SPDX-License-Identifier: Apache-2.0
"""Slotting: assigns SKUs to units by the orders, and measures the gain.

proposal: SKUs that are ordered together share units, the most ordered stand near stations; trial:
shifts with the proposed and with a random stock, seed by seed.
"""
