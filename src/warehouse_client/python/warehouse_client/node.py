# SPDX-License-Identifier: Apache-2.0
"""The start of a node."""

import sys
from typing import Any

import rospy

# rospy's names are absolute; in a namespace, the clock and the frames are those of its world.
OF_THE_WORLD = ("/clock:=clock", "/tf:=tf", "/tf_static:=tf_static")


def begin(name: str, **options: Any) -> None:
    """Calls rospy.init_node; ends in one line if ROS shuts down meanwhile."""
    try:
        rospy.init_node(name, argv=[*OF_THE_WORLD, *sys.argv], **options)
    except rospy.ROSInitException as error:
        sys.exit(f"{name}: {error}")
