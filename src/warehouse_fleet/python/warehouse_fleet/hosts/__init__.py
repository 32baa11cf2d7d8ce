# SPDX-License-Identifier: Apache-2.0
"""Where a fleet is controlled: in a node over topics, or in one process with its world."""
