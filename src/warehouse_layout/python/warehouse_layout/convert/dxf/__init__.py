# SPDX-License-Identifier: Apache-2.0
"""Drawings, `.dxf`: layers named walls, storage, station and so on become cells."""
