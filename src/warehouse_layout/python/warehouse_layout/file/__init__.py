# SPDX-License-Identifier: Apache-2.0
"""Layout files: read and written, with the drawing, the items and the stations that they name."""
