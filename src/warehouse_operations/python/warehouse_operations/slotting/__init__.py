# SPDX-License-Identifier: Apache-2.0
"""Which SKUs lie together, on which units, and what that gains.

sku_master  skus.csv: weights, sizes, pieces a bin, classes
proposal    SKUs that are ordered together share units; the most ordered stand near stations
trial       shifts with the stock as proposed and as drawn by chance, seed by seed
"""
