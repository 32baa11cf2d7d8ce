# SPDX-License-Identifier: Apache-2.0
"""What a file of orders says about the demand of a warehouse: the program `demand`.

description makes a demand_file.Demand of the orders, oddities lists the odd ones, and page draws
both.
"""
