# SPDX-License-Identifier: Apache-2.0
"""Models of a placed warehouse, and SDF worlds: read, written, added to a running world."""
