# SPDX-License-Identifier: Apache-2.0
"""What reports are made of: the pages' design, charts in it, tables, files for spreadsheets."""
