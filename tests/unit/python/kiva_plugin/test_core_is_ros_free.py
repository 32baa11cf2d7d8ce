# SPDX-License-Identifier: Apache-2.0
"""The core has no ROS in it: the world must build, run and be tested without it."""

import re

from paths import ROOT

PACKAGE = ROOT / "src" / "kiva_plugin_cpp"
ROS_INCLUDE = re.compile(
    r'^\s*#\s*include\s*[<"](ros|tf2?(_\w+)?|\w+_(msgs|srvs)|dynamic_reconfigure)/', re.M
)


def test_core_includes_no_ros():
    files = [
        file
        for folder in ("include", "src/description", "src/world_file", "src/core", "src/plugins")
        for file in (PACKAGE / folder).rglob("*.*")
    ]
    assert files
    assert [str(f) for f in files if ROS_INCLUDE.search(f.read_text())] == []


def test_pattern_knows_ros():
    for header in ("ros/ros.h", "warehouse_msgs/MoveTo.h", "std_srvs/Empty.h", "tf2_ros/buffer.h"):
        assert ROS_INCLUDE.search(f"#include <{header}>")
    assert not ROS_INCLUDE.search('#include "core/rosette.h"')
