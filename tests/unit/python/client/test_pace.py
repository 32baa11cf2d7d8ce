# SPDX-License-Identifier: Apache-2.0
"""What a node says of its pace."""

from unittest import mock

import pytest

from warehouse_client import pace


@pytest.fixture
def ros():
    with mock.patch.object(pace, "rospy") as ros:
        ros.core.is_shutdown_requested.return_value = False
        yield ros


def test_a_thread_that_is_at_work_while_its_node_ends_does_not_keep_time_waiting(ros):
    keeper, publish = pace.PaceKeeper(0.3), ros.Publisher.return_value.publish
    keeper.acted_upon("a stamp")
    ros.core.is_shutdown_requested.return_value = True
    keeper.release()
    keeper.acted_upon("a later stamp")
    assert publish.call_count == 2
    assert publish.call_args.args[0].lookahead == pace.Pace().lookahead
