# SPDX-License-Identifier: Apache-2.0
"""Parts of reports: the pages' design, charts in it, tables, files for spreadsheets."""
