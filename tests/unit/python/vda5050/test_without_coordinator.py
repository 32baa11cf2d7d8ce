# SPDX-License-Identifier: Apache-2.0
"""No coordinator is called where none runs: rospy would log each call as an error."""

from types import SimpleNamespace

import pytest
import rospy
from fake_ros import FakeRos

from warehouse_client.services import is_offered
from warehouse_msgs.srv import SetRobotModeResponse
from warehouse_vda5050 import world_link


class Ros(FakeRos):
    """A master that knows these services; calls are kept."""

    ServiceException, ROSException = rospy.ServiceException, rospy.ROSException

    def __init__(self, *offered):
        super().__init__()
        self.offered, self.calls = offered, []

    def get_master(self):
        return SimpleNamespace(lookupService=self._look_up)

    def _look_up(self, name):
        return (1, "", "rosrpc://there") if name in self.offered else (-1, "unknown", "")

    def ServiceProxy(self, name, _):  # noqa: N802 (rospy's name)
        return lambda *fields: self.calls.append((name, *fields)) or SetRobotModeResponse(True, "")


@pytest.mark.parametrize("offered", [(), ("/warehouse/set_robot_mode",)])
def test_a_mode_is_set_only_where_a_coordinator_runs(monkeypatch, offered):
    ros = Ros(*offered)
    monkeypatch.setattr(world_link, "rospy", ros)
    link = world_link.WorldLink()
    assert is_offered(ros, "warehouse/set_robot_mode") == bool(offered)
    assert link.set_mode(1, 1) == ""
    assert ros.calls == [("warehouse/set_robot_mode", 1, 1)] * len(offered)
