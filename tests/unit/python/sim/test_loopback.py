# SPDX-License-Identifier: Apache-2.0
"""ROS listens to this machine alone, unless the environment says otherwise."""

import subprocess

import pytest
from paths import ROOT

HOOK = ROOT / "src/warehouse_sim/env-hooks/50.loopback.sh"


@pytest.mark.parametrize(
    ("environment", "hostname"),
    [
        ({}, "localhost"),
        ({"ROS_MASTER_URI": "http://localhost:11311"}, "localhost"),
        ({"ROS_MASTER_URI": "http://127.0.0.1:11311"}, "localhost"),
        ({"ROS_MASTER_URI": "http://localhost.example:11311"}, ""),
        ({"ROS_MASTER_URI": "http://robots:11311"}, ""),
        ({"ROS_HOSTNAME": "robots.example"}, "robots.example"),
        ({"ROS_IP": "192.168.0.2"}, ""),
    ],
)
def test_after_sourcing_the_workspace(environment, hostname):
    script = f'. {HOOK}; printf %s "${{ROS_HOSTNAME:-}}"'
    said = subprocess.check_output(["/bin/sh", "-euc", script], env=environment, text=True)
    assert said == hostname
