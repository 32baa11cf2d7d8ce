# SPDX-License-Identifier: Apache-2.0
"""Its presence lets pytest find the helpers in this folder from the folders below it."""
