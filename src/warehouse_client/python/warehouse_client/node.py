# SPDX-License-Identifier: Apache-2.0
"""The start of a node, and its end by a signal."""

import atexit
import queue
import signal
import sys
import threading
from typing import Any

import rospy

# rospy's names are absolute; in a namespace, the clock and the frames are those of its world.
OF_THE_WORLD = ("/clock:=clock", "/tf:=tf", "/tf_static:=tf_static")
GRACE = 1.0  # for which a signal keeps the main thread from what it does [s]


def begin(name: str, **options: Any) -> None:
    """Calls rospy.init_node; ends in one line if ROS shuts down meanwhile.

    SIGINT and SIGTERM shut ROS down unless `disable_signals` is among the options.
    """
    try:
        rospy.init_node(name, argv=[*OF_THE_WORLD, *sys.argv], **options)
    except rospy.ROSInitException as error:
        sys.exit(f"{name}: {error}")
    if not options.get("disable_signals"):
        _shut_down_on_signals()


def _shut_down_on_signals() -> None:
    """Has SIGINT and SIGTERM shut ROS down on a thread of its own.

    rospy's own handler does so on the main thread, wherever that is. If it is publishing, it holds
    the lock that the handler needs to close the connection, and waits for itself for ever. Here the
    main thread waits as well, lest it publish to what is being closed, but goes on in the end.
    """
    signals: queue.SimpleQueue[int] = queue.SimpleQueue()  # a handler may put into it at any time

    def shut_down() -> None:
        if number := signals.get():
            rospy.signal_shutdown(f"signal-{number}")

    thread = threading.Thread(target=shut_down, name="signals", daemon=True)
    thread.start()

    def on_signal(number: int, _frame: Any) -> None:
        signals.put(number)
        thread.join(GRACE)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, on_signal)

    @atexit.register
    def let_it_finish() -> None:
        signals.put(0)
        thread.join()
