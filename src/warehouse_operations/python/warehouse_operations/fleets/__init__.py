# SPDX-License-Identifier: Apache-2.0
"""The fleets that a shift in one process drives: ideal robots, or those of a simulated world."""
