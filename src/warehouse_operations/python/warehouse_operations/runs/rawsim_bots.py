# SPDX-License-Identifier: Apache-2.0
"""How robots of RAWSim-O drive and lift."""

from dataclasses import replace

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.xml_fields import InstanceError

# The attributes of a robot, and what holds without them: m/s, m/s2, s a full turn, s a lift.
USUAL = {"MaxVelocity": 1.5, "MaxAcceleration": 1.0, "TurnSpeed": 2.5, "PodTransferTime": 2.2}


def kinematics(
    path: PathName, speed: float, acceleration: float, full_turn: float, lift: float
) -> Kinematics:
    """Returns the Kinematics of robots with these attributes, in the order of USUAL. path: their
    file. Raises InstanceError."""
    if min(speed, acceleration) <= 0 or min(full_turn, lift) < 0:
        raise InstanceError(
            f"{path}: MaxVelocity and MaxAcceleration above 0 were expected, and TurnSpeed and"
            " PodTransferTime of 0 or more"
        )
    return replace(
        Kinematics(),
        speed=speed,
        acceleration=acceleration,
        quarter_turn=full_turn / 4,
        lift=lift,
    )
