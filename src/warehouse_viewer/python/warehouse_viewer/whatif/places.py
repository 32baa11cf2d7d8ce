# SPDX-License-Identifier: Apache-2.0
"""Where scenarios lie if no folder is named."""

import os
from collections.abc import Mapping
from pathlib import Path

HERE = Path("whatif")  # of the program


def of_viewer(environment: Mapping[str, str] = os.environ) -> Path:
    """Returns the folder of the page of a running warehouse."""
    home = environment.get("ROS_HOME") or Path.home() / ".ros"
    return Path(home) / "warehouse" / "whatif"
