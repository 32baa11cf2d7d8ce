# SPDX-License-Identifier: Apache-2.0
"""The fleet's workload for other simulators: square.h and chunks.h, in Python."""

import argparse
import json
import math
import statistics
import time

CHUNKS = 5
LATTICE = 3.0  # [m]
STEP = 0.001  # [s]
RAYS, RANGE = 20, 5.0  # [m]
STEPS_PER_SCAN = 100
LASER_AHEAD, LASER_HEIGHT = 0.4, 0.2  # [m]
LENGTH, WIDTH, HEIGHT, BODY_HEIGHT = 0.76, 0.64, 0.33, 0.195  # [m]
WHEEL_RADIUS, WHEEL_WIDTH, TRACK = 0.1, 0.05, 0.52  # [m]
CHASSIS_MASS, WHEEL_MASS, MOTOR_TORQUE = 140.0, 2.5, 90.0  # [kg], [Nm]
CASTER_RADIUS, CASTER_X = 0.05, 0.3  # [m]
SIDE, STAGGER = 1000, 137  # steps

RAY_ANGLES = [-math.pi / 2 + math.pi * k / (RAYS - 1) for k in range(RAYS)]


def arguments(doc):
    """So many robots, and seconds of simulated time a chunk."""
    parser = argparse.ArgumentParser(description=doc)
    parser.add_argument("robots", type=int, nargs="+")
    parser.add_argument("--seconds", type=float, default=2.0, help="of simulated time a chunk")
    return parser.parse_args()


def places(robots):
    """Where they start, (x, y) [m], and how wide the floor between the walls is."""
    columns = math.ceil(math.sqrt(robots))
    corner = round(-columns * LATTICE / 2)
    at = [(corner + i % columns * LATTICE, corner + i // columns * LATTICE) for i in range(robots)]
    return at, columns * LATTICE + 6


def walls(size):
    """Centre and half extents of each [m]."""
    far, half = size / 2 + 0.1, size / 2
    along_y = [((x, 0, 0.5), (0.1, half, 0.5)) for x in (far, -far)]
    along_x = [((0, y, 0.5), (half, 0.1, 0.5)) for y in (far, -far)]
    return along_y + along_x


def wheel_speeds(robot, step):
    """Left and right [rad/s]: straight ahead or turning."""
    straight = (step + robot * STAGGER) // SIDE % 2 == 0
    speed, turn = (1.0, 0.0) if straight else (0.0, math.pi / 2 * TRACK / 2)
    return (speed - turn) / WHEEL_RADIUS, (speed + turn) / WHEEL_RADIUS


def changes(robot, step):
    """Whether the wheels are to turn at another speed from this step on."""
    return step == 0 or (step + robot * STAGGER) % SIDE == 0


def scanning(robots, step):
    """Whose laser is due."""
    return range(-step % STEPS_PER_SCAN, robots, STEPS_PER_SCAN)


def report(engine, robots, lasers, seconds, chunk):
    """Prints the medians over CHUNKS calls of chunk(), each of which simulates so many seconds."""
    wall, cpu = [], []
    for _ in range(CHUNKS):
        begin, cpu_begin = time.perf_counter(), time.thread_time()
        chunk()
        wall.append(seconds / (time.perf_counter() - begin))
        cpu.append(seconds / (time.thread_time() - cpu_begin))
    figures = {"rtf": statistics.median(wall), "rtf_cpu": statistics.median(cpu)}
    print(json.dumps({"engine": engine, "robots": robots, "lasers": lasers, **figures}), flush=True)
