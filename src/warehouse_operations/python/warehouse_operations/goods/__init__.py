# SPDX-License-Identifier: Apache-2.0
"""Goods by weight: SKUs with weights and bundle sizes, and units that are full by weight (kinds);
the sizes of drawn orders (order_sizes); empty bins by unit (empty_bins)."""
