# SPDX-License-Identifier: Apache-2.0
"""The database of a warehouse: written, read back, searched and checked."""
