# SPDX-License-Identifier: Apache-2.0
"""Warnings where simulated time runs away from what is behind a broker.

The world waits for nodes that say how far they have decided (/warehouse/pace). A node that stands
between it and a broker can't say so: when a master has decided, or a vehicle has driven, the broker
does not tell.
"""

import rospy

from gazebo_msgs.srv import GetPhysicsProperties
from warehouse_client.services import is_offered

PHYSICS = "gazebo/get_physics_properties"
OF_MASTER = "a master behind the broker"
OF_VEHICLES = "vehicles behind the broker, which drive by the wall clock"


def pace() -> float:
    """Returns how many simulated seconds are to pass a second; 0: as many as possible."""
    try:
        if is_offered(rospy, PHYSICS):
            now = rospy.ServiceProxy(PHYSICS, GetPhysicsProperties)()
            return float(now.max_update_rate * now.time_step)
    except (rospy.ServiceException, rospy.ROSException, OSError):
        pass  # the world comes or goes
    return float(rospy.get_param("gazebo/rtf", 1.0))


def fault(factor: float, whom: str) -> str:
    """Returns what is wrong with a pace for those that it does not wait for; empty: nothing.

    A master may follow a time that passes faster than the clock, vehicles can't."""
    if factor > 0 and (whom == OF_MASTER or factor <= 1 + 1e-6):
        return ""
    speed = f"{factor:g} times as fast as the clock" if factor else "as fast as possible (rtf:=0)"
    return (
        f"simulated time passes {speed} and does not wait for {whom}: what the robots achieve says"
        " nothing about a warehouse; start it with rtf:=1"
    )


def warn(whom: str) -> None:
    """Logs a warning if the pace of the world is too fast for those behind the broker."""
    if text := fault(pace(), whom):
        rospy.logwarn(text)
