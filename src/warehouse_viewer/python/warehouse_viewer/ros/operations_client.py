# SPDX-License-Identifier: Apache-2.0
"""The operations of a shift behind ROS: orders, stock, stations and figures."""

import time
from types import ModuleType
from typing import Any

import rospy

from warehouse_msgs import srv
from warehouse_viewer.page.source import AwayError, RefusedError
from warehouse_viewer.ros.shift_feed import ShiftFeed

PATIENCE = 3.0  # for a topic's latest message [s, wall]
NO_SHIFT = "is a shift running (operations.launch)?"
ANY = srv.FindOrdersRequest.ANY


class OperationsClient:
    """Calls the services of a shift's operations and reads its topics; calls block.

    `ros` is rospy. Methods raise AwayError if no shift answers.
    """

    def __init__(self, ros: ModuleType, feed: ShiftFeed) -> None:
        self._ros, self.feed = ros, feed

    def call(self, service: str, kind: type, *fields: Any) -> Any:
        """Returns the response of /warehouse/`service`. Raises RefusedError if it refuses."""
        answer = self.request(service, kind, *fields)
        if not getattr(answer, "success", getattr(answer, "accepted", True)):
            raise RefusedError(answer.message)
        return answer

    def request(self, service: str, kind: type, *fields: Any) -> Any:
        """Returns the response of /warehouse/`service`, also where it refuses."""
        name = f"warehouse/{service}"
        try:
            return self._ros.ServiceProxy(name, kind)(*fields)
        except (self._ros.ServiceException, self._ros.ROSException, OSError) as error:
            raise AwayError(f"{name}: {error}; {NO_SHIFT}") from error

    def latest(self, name: str) -> Any:
        """Waits for the ShiftFeed's newest message of that name and returns it."""
        end = time.monotonic() + PATIENCE
        while (message := self.feed[name]) is None:
            if time.monotonic() > end:
                raise AwayError(f"no message comes on /warehouse/{name}; {NO_SHIFT}")
            time.sleep(0.05)
        return message

    def find_orders(
        self,
        number: int = 0,
        search: str = "",
        state: int = ANY,
        late: bool = False,
        limit: int = 1,
        offset: int = 0,
    ) -> srv.FindOrdersResponse:
        """Returns the order of that number, or (0) those that fit the other conditions."""
        fields = number, search, state, late, limit, offset
        return self.call("find_orders", srv.FindOrders, *fields)

    def time(self, seconds: float) -> rospy.Time:
        """Returns a rospy.Time [s]."""
        return self._ros.Time.from_sec(seconds)
