# SPDX-License-Identifier: Apache-2.0
"""What shifts came to, for a person: figures, comparisons, charts, pages and tables."""
