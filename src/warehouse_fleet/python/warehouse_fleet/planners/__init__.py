# SPDX-License-Identifier: Apache-2.0
"""Planners: which cell each robot enters next. EPIBT is in C++, learned ones are here."""
