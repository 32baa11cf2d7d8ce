# SPDX-License-Identifier: Apache-2.0
"""A shift: orders go to stations, units to the orders, pieces into totes; stock is refilled."""
