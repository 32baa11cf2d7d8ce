# SPDX-License-Identifier: Apache-2.0
"""Services that may be there or not."""

from typing import Any


def is_offered(ros: Any, name: str) -> bool:
    """Returns whether a node offers a service. `ros` is rospy, which logs an error for a call of a
    missing one. Raises OSError if the master does not answer."""
    code, *_ = ros.get_master().lookupService(ros.resolve_name(name))
    return bool(code == 1)
