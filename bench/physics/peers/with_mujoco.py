# SPDX-License-Identifier: Apache-2.0
"""The fleet's workload in MuJoCo: bodies with two wheel joints and velocity motors."""

import math

import mujoco
import numpy as np
import workload as w

WORLD = """<mujoco>
  <option timestep="{step}"/>
  <default>
    <default class="wheel"><geom type="cylinder" friction="0.8" mass="{wheel_mass}"/></default>
    <default class="caster"><geom type="sphere" condim="1" mass="0"/></default>
    <default class="motor"><velocity kv="500" ctrlrange="-50 50" forcerange="-{torque} {torque}"/>
    </default>
  </default>
  <worldbody>
    <geom type="plane" size="0 0 1" friction="1"/>
    {walls}
    {robots}
  </worldbody>
  <actuator>{motors}</actuator>
</mujoco>"""

ROBOT = """<body pos="{x} {y} {z}"><freejoint/>
  <geom type="box" size="{half_length} {half_width} {half_height}" mass="{mass}" condim="1"/>
  <geom class="caster" size="{caster}" pos="{caster_x} 0 {caster_z}"/>
  <geom class="caster" size="{caster}" pos="-{caster_x} 0 {caster_z}"/>
  {wheels}
</body>"""

WHEEL = """<body pos="0 {y} {z}"><joint name="{name}" axis="0 1 0"/>
  <geom class="wheel" size="{radius} {half_width}" euler="90 0 0"/></body>"""


def wheel(i, side):
    return WHEEL.format(
        name=f"{i}_{side}",
        y=side * w.TRACK / 2,
        z=w.WHEEL_RADIUS - w.BODY_HEIGHT,
        radius=w.WHEEL_RADIUS,
        half_width=w.WHEEL_WIDTH / 2,
    )


def robot(i, x, y):
    return ROBOT.format(
        x=x,
        y=y,
        z=w.BODY_HEIGHT,
        half_length=w.LENGTH / 2,
        half_width=w.WIDTH / 2,
        half_height=w.HEIGHT / 2,
        mass=w.CHASSIS_MASS,
        caster=w.CASTER_RADIUS,
        caster_x=w.CASTER_X,
        caster_z=w.CASTER_RADIUS + 0.001 - w.BODY_HEIGHT,
        wheels=wheel(i, 1) + wheel(i, -1),
    )


def numbers(values):
    return " ".join(map(str, values))


def build(robots):
    """The model; body 3 i + 1 is the chassis of robot i, 2 i and 2 i + 1 are its motors."""
    at, size = w.places(robots)
    walls = [
        f'<geom type="box" pos="{numbers(centre)}" size="{numbers(half)}"/>'
        for centre, half in w.walls(size)
    ]
    motors = [
        f'<velocity class="motor" joint="{i}_{side}"/>' for i in range(robots) for side in (1, -1)
    ]
    return mujoco.MjModel.from_xml_string(
        WORLD.format(
            step=w.STEP,
            wheel_mass=w.WHEEL_MASS,
            torque=w.MOTOR_TORQUE,
            walls="".join(walls),
            robots="".join(robot(i, x, y) for i, (x, y) in enumerate(at)),
            motors="".join(motors),
        )
    )


class Lasers:
    def __init__(self, model, data):
        self._model, self._data = model, data
        self._hit, self._range = np.zeros(w.RAYS, np.int32), np.zeros(w.RAYS)
        self._normal = np.zeros((w.RAYS, 3))

    def scan(self, robot):
        body = 3 * robot + 1
        forward, left = self._data.xmat[body].reshape(3, 3)[:, :2].T
        origin = self._data.xpos[body] + w.LASER_AHEAD * forward
        origin[2] = w.LASER_HEIGHT
        rays = [math.cos(a) * forward + math.sin(a) * left for a in w.RAY_ANGLES]
        mujoco.mj_multiRay(
            self._model,
            self._data,
            pnt=origin,
            vec=np.concatenate(rays),
            geomgroup=None,
            flg_static=1,
            bodyexclude=body,
            geomid=self._hit,
            dist=self._range,
            normal=self._normal.ravel(),
            nray=w.RAYS,
            cutoff=w.RANGE,
        )


def main():
    args = w.arguments(__doc__)
    for robots in args.robots:
        model = build(robots)
        data, steps = mujoco.MjData(model), iter(range(10**9))
        lasers = Lasers(model, data)

        def chunk(model=model, data=data, lasers=lasers, steps=steps, robots=robots):
            for step, _ in zip(steps, range(round(args.seconds / w.STEP))):
                for i in range(robots):
                    if w.changes(i, step):
                        data.ctrl[2 * i : 2 * i + 2] = w.wheel_speeds(i, step)
                mujoco.mj_step(model, data)
                for i in w.scanning(robots, step):
                    lasers.scan(i)

        w.report("MuJoCo", robots, True, args.seconds, chunk)


if __name__ == "__main__":
    main()
