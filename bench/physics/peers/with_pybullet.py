# SPDX-License-Identifier: Apache-2.0
"""The fleet's workload in pybullet: bodies with two wheel joints and velocity motors."""

import math
import tempfile

import pybullet
import workload as w

URDF = f"""<robot name="kiva">
  <link name="chassis">
    <inertial><mass value="{w.CHASSIS_MASS}"/>
      <inertia ixx="5.6" iyy="7.4" izz="11" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="{w.LENGTH} {w.WIDTH} {w.HEIGHT}"/></geometry></collision>
    {{casters}}
  </link>
  {{wheels}}
</robot>"""

CASTER = """<collision><origin xyz="{x} 0 {z}"/><geometry><sphere radius="{radius}"/></geometry>
    </collision>"""

WHEEL = """<link name="wheel_{name}">
    <inertial><mass value="{mass}"/>
      <inertia ixx="0.0068" iyy="0.0125" izz="0.0068" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin rpy="1.5707963 0 0"/>
      <geometry><cylinder radius="{radius}" length="{width}"/></geometry></collision>
  </link>
  <joint name="joint_{name}" type="continuous">
    <parent link="chassis"/><child link="wheel_{name}"/>
    <origin xyz="0 {y} {z}"/><axis xyz="0 1 0"/>
  </joint>"""


def urdf():
    z = w.CASTER_RADIUS + 0.001 - w.BODY_HEIGHT
    casters = "".join(
        CASTER.format(x=x, z=z, radius=w.CASTER_RADIUS) for x in (w.CASTER_X, -w.CASTER_X)
    )
    wheels = "".join(
        WHEEL.format(
            name=name,
            mass=w.WHEEL_MASS,
            radius=w.WHEEL_RADIUS,
            width=w.WHEEL_WIDTH,
            y=y,
            z=w.WHEEL_RADIUS - w.BODY_HEIGHT,
        )
        for name, y in (("left", w.TRACK / 2), ("right", -w.TRACK / 2))
    )
    return URDF.format(casters=casters, wheels=wheels)


def build(robots):
    """The ids of the robots' bodies."""
    at, size = w.places(robots)
    pybullet.connect(pybullet.DIRECT)
    pybullet.setGravity(0, 0, -9.81)
    pybullet.setTimeStep(w.STEP)
    plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE)
    pybullet.changeDynamics(pybullet.createMultiBody(0, plane), -1, lateralFriction=1)
    for centre, half in w.walls(size):
        box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
        pybullet.createMultiBody(0, box, basePosition=centre)
    with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
        file.write(urdf())
        file.flush()
        bodies = [pybullet.loadURDF(file.name, [x, y, w.BODY_HEIGHT]) for x, y in at]
    for body in bodies:
        pybullet.changeDynamics(body, -1, lateralFriction=0)
        for wheel in (0, 1):
            pybullet.changeDynamics(body, wheel, lateralFriction=0.8)
    return bodies


def drive(bodies, step):
    for i, body in enumerate(bodies):
        if w.changes(i, step):
            pybullet.setJointMotorControlArray(
                body,
                [0, 1],
                pybullet.VELOCITY_CONTROL,
                targetVelocities=w.wheel_speeds(i, step),
                forces=[w.MOTOR_TORQUE] * 2,
            )


def scan(bodies, step):
    """All rays that are due at this step at once."""
    begin, end = [], []
    for i in w.scanning(len(bodies), step):
        (x, y, _), turn = pybullet.getBasePositionAndOrientation(bodies[i])
        yaw = pybullet.getEulerFromQuaternion(turn)[2]
        x, y = x + w.LASER_AHEAD * math.cos(yaw), y + w.LASER_AHEAD * math.sin(yaw)
        for angle in w.RAY_ANGLES:
            c, s = math.cos(yaw + angle), math.sin(yaw + angle)
            begin.append((x, y, w.LASER_HEIGHT))
            end.append((x + w.RANGE * c, y + w.RANGE * s, w.LASER_HEIGHT))
    if begin:
        pybullet.rayTestBatch(begin, end, numThreads=1)


def main():
    args = w.arguments(__doc__)
    for robots in args.robots:
        bodies, steps = build(robots), iter(range(10**9))

        def chunk(bodies=bodies, steps=steps):
            for step, _ in zip(steps, range(round(args.seconds / w.STEP))):
                drive(bodies, step)
                pybullet.stepSimulation()
                scan(bodies, step)

        w.report("pybullet", robots, True, args.seconds, chunk)
        pybullet.disconnect()


if __name__ == "__main__":
    main()
