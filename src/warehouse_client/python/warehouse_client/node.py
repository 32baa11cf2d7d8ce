# SPDX-License-Identifier: Apache-2.0
"""How a node begins."""

import sys
from typing import Any

import rospy


def begin(name: str, **options: Any) -> None:
    """Calls rospy.init_node; ends in one line if ROS shuts down meanwhile."""
    try:
        rospy.init_node(name, **options)
    except rospy.ROSInitException as error:
        sys.exit(f"{name}: {error}")
