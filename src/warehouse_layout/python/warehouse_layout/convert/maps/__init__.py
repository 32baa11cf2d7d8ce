# SPDX-License-Identifier: Apache-2.0
"""Maps and grids: map_server, MovingAI, spreadsheets."""
