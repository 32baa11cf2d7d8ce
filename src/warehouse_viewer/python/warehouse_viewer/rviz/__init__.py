# SPDX-License-Identifier: Apache-2.0
"""The warehouse in RViz: markers, paths, the chosen robot and the first view."""
