# SPDX-License-Identifier: Apache-2.0
"""Graphs of nodes and edges: VDMA's Layout Interchange Format, and plant models of openTCS."""
