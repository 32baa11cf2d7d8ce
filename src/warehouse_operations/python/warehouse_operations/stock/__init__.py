# SPDX-License-Identifier: Apache-2.0
"""Stock and demand of a warehouse: SKUs, bins, orders, stations, and where units stand."""
