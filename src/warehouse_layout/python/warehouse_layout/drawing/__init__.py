# SPDX-License-Identifier: Apache-2.0
"""Draws a layout file as a plan."""
