# SPDX-License-Identifier: Apache-2.0
"""Reports on shifts for people: figures, comparisons, charts, pages and tables."""
