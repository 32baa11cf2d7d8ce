# SPDX-License-Identifier: Apache-2.0
"""Transports of storage units: requests, records, and who charges, tows or waits."""
