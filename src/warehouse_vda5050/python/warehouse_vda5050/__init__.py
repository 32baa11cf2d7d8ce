# SPDX-License-Identifier: Apache-2.0
"""VDA 5050: any master drives the robots of a warehouse, and any vehicle may be one of them."""
