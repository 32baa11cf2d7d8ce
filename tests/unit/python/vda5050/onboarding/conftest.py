# SPDX-License-Identifier: Apache-2.0
"""Lets these tests import what the other tests of VDA 5050 share."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
