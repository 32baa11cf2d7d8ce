# SPDX-License-Identifier: Apache-2.0
"""Where the package's own files lie, in the source tree, installed or in a wheel."""

from pathlib import Path

from warehouse_layout.file import files

SHARE = files.share(__file__)
WEB = SHARE / "web"  # the page
RVIZ_CONFIG = SHARE / "rviz" / "warehouse.rviz"
PACKED = SHARE / "three"  # in a wheel
THREE = PACKED if PACKED.is_dir() else Path("/usr/share/javascript/three")  # of libjs-three
CHART = Path("/usr/share/javascript/chart.js")  # of libjs-chart.js
