# SPDX-License-Identifier: Apache-2.0
"""Whole shifts, from a description to a folder of results, and many of them side by side."""
