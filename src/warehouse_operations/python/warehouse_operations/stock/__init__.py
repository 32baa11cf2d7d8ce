# SPDX-License-Identifier: Apache-2.0
"""What a warehouse has and is asked for: SKUs, bins, orders, stations, and where units stand."""
