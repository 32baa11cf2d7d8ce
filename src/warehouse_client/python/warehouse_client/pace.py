# SPDX-License-Identifier: Apache-2.0
"""Has simulated time wait for a node where it passes faster than the wall clock."""

from typing import Any

import rospy

from warehouse_msgs.msg import Pace

TICK = 0.5  # between two looks at whether ROS shuts down, by the wall clock [s]


class PaceKeeper:
    """Tells the world, over /warehouse/pace, how far its time may pass before this node has acted
    upon the next news.

    Without it a warehouse that runs at `rtf:=0`, or faster than a node can follow, runs away from
    the node: its robots wait for commands, and what they achieve says nothing. `lookahead`: how far
    the world may be ahead of what the node has acted upon [s]; the longer, the more the two work at
    the same time.
    """

    def __init__(self, lookahead: float) -> None:
        self._lookahead = rospy.Duration.from_sec(lookahead)
        # Latched: what was said before the world has found this node still holds. Who records it
        # hears all of it, however busy the machine: hundreds may come within a second.
        self._publisher = rospy.Publisher("warehouse/pace", Pace, latch=True, queue_size=1000)
        self._is_waited_for = False
        rospy.on_shutdown(self.release)

    def acted_upon(self, stamp: Any) -> None:
        """Tells that this node has acted upon all it heard up to a simulated time, a rospy.Time."""
        # Threads go on while ROS shuts down: time would wait for a node that has ended.
        if rospy.core.is_shutdown_requested():
            return
        self._publisher.publish(Pace(stamp, self._lookahead))
        self._is_waited_for = True

    def release(self) -> None:
        """Tells that time need not wait for this node, until it calls acted_upon() again."""
        if self._is_waited_for:
            self._publisher.publish(Pace())
        self._is_waited_for = False


def wait_beyond(time: float, cycle: float) -> None:
    """Waits until simulated time is `cycle` seconds beyond `time` [s], or goes back before it.

    rospy.sleep waits from the present time on, which a node that is waited for may not see pass;
    and half a second by the wall clock where the time comes just before it waits.
    """
    news = rospy.rostime.get_rostime_cond()
    with news:
        while not rospy.is_shutdown() and time <= rospy.get_time() < time + cycle:
            news.wait(TICK)
