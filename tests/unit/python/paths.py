# SPDX-License-Identifier: Apache-2.0
"""Where tests find the repository, and each other's helpers."""

from pathlib import Path

HELPERS = Path(__file__).resolve().parent  # of several folders' tests
ROOT = HELPERS.parents[2]
WORLDS = ROOT / "tests" / "worlds"
