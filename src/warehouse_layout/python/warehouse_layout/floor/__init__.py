# SPDX-License-Identifier: Apache-2.0
"""The floor that robots drive on, cell by cell: streets, stations with lanes, markings."""
