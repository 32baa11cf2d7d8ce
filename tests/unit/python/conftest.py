# SPDX-License-Identifier: Apache-2.0
"""Its presence lets pytest find the helpers in this folder from the folders below it; those of
rostests, which lead browsers, are found too."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "rostest"))
