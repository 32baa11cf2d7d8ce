# SPDX-License-Identifier: Apache-2.0
"""Which paces are too fast for what is behind a broker."""

import pytest

from warehouse_vda5050.ros.pace_check import OF_MASTER, OF_VEHICLES, fault


@pytest.mark.parametrize(
    "factor, whom", [(1, OF_MASTER), (0.5, OF_MASTER), (8, OF_MASTER), (1, OF_VEHICLES)]
)
def test_a_pace_that_can_be_followed_is_no_fault(factor, whom):
    assert fault(factor, whom) == ""


@pytest.mark.parametrize("whom", [OF_MASTER, OF_VEHICLES])
def test_time_as_fast_as_possible_waits_for_none_behind_a_broker(whom):
    text = fault(0, whom)
    assert text.startswith("simulated time passes as fast as possible (rtf:=0) and does not wait")
    assert whom in text and text.endswith("start it with rtf:=1")


def test_vehicles_drive_by_the_clock_alone():
    assert "2.5 times as fast as the clock" in fault(2.5, OF_VEHICLES)
