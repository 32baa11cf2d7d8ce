# SPDX-License-Identifier: Apache-2.0
"""How a node begins."""

import sys

import rospy


def begin(name, **options):
    """rospy.init_node; ends in one line where ROS shuts down meanwhile."""
    try:
        rospy.init_node(name, **options)
    except rospy.ROSInitException as error:
        sys.exit(f"{name}: {error}")
