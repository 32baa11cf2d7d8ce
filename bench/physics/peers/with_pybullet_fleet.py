# SPDX-License-Identifier: Apache-2.0
"""The fleet's workload in pybullet-fleet: kinematic robots, its step of 0.1 s, collision checks."""

import tempfile

import with_pybullet
import workload as w
from pybullet_fleet.core_simulation import MultiRobotSimulationCore
from pybullet_fleet.geometry import Pose

STEP = 0.1  # [s]
ROUNDS = 200


def config(robots, urdf):
    columns = round(w.places(robots)[1] - 6) // round(w.LATTICE)
    return {
        "simulation": {
            "target_rtf": 0,
            "timestep": STEP,
            "gui": False,
            "monitor": False,
            "physics": False,
            "log_level": "error",
            "collision_detection_method": "closest_points",
        },
        "managers": [
            {
                "name": "fleet",
                "fleet_controller": {
                    "type": "batch_differential",
                    "max_linear_vel": 1.0,
                    "max_linear_accel": 100.0,
                    "max_angular_vel": 1.5708,
                    "max_angular_accel": 100.0,
                },
            }
        ],
        "entities": [
            {
                "urdf_path": urdf,
                "mass": 0.0,
                "use_fixed_base": False,
                "manager": "fleet",
                "grid": {
                    "count": robots,
                    "columns": columns,
                    "spacing": [w.LATTICE, w.LATTICE, 0.0],
                    "offset": [0, 0, w.BODY_HEIGHT],
                },
            }
        ],
    }


def squares(robot):
    x, y, z = robot.get_pose().position
    corners = [(1, 0), (1, 1), (0, 1), (0, 0)]
    return [Pose.from_euler(x + dx, y + dy, z, 0, 0, 0) for dx, dy in corners] * ROUNDS


def main():
    args = w.arguments(__doc__)
    for robots in args.robots:
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
            file.write(with_pybullet.urdf())
            file.flush()
            sim = MultiRobotSimulationCore.from_dict(config(robots, file.name))
        fleet = sim.get_manager("fleet").objects
        for robot in fleet:
            robot.set_path(squares(robot), final_orientation_align=False)
        sim.initialize_simulation()

        def chunk(sim=sim):
            for _ in range(round(args.seconds / STEP)):
                sim.step_once()

        w.report("pybullet-fleet", robots, False, args.seconds, chunk)


if __name__ == "__main__":
    main()
