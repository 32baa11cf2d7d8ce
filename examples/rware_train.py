#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trains robots in RWARE's task, seed after seed: IPPO or MAPPO, numpy alone. One core will do:
OPENBLAS_NUM_THREADS=1 leaves the others to other programs.

examples/rware_train.py tiny-4ag                                # MAPPO, 20 million steps, seed 0
examples/rware_train.py small-4ag --algorithm ippo --seeds 5 --out results
examples/rware_train.py tiny-2ag --minutes 10                   # a part; the same command goes on
examples/rware_train.py tiny-4ag --imitate 20000                # from the planner's example
examples/rware_train.py tiny-4ag --physics bodies --from results/tiny-4ag-mappo-0.npz
examples/rware_train.py tiny-4ag --set discount=0.98 --out discount  # what a setting is worth

Each seed writes OUT/TASK-ALGORITHM-SEED.npz, a policy that warehouse_learning.watch shows, a
.checkpoint.npz, from which the same command goes on, and .json, its learning curve.
examples/rware_results.py draws the curves and measures the policies.
"""

import argparse
import json
import signal
from dataclasses import fields, replace
from pathlib import Path

import gymnasium
from gymnasium.vector import AutoresetMode

import warehouse_learning.rware  # noqa: F401  registers the tasks
from warehouse_learning.marl import policy
from warehouse_learning.marl.encoding import Encoder
from warehouse_learning.marl.imitation import imitate
from warehouse_learning.marl.training import ALGORITHMS, Training, TrainingSettings
from warehouse_learning.rware.motion import PHYSICS

OWN_OPTIONS = {"algorithm", "steps", "imitation"}
SETTINGS = {f.name: f.type for f in fields(TrainingSettings) if f.name not in OWN_OPTIONS}


def main():
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # a batch system's Ctrl-C
    options = arguments()
    out = Path(options.out)
    settings = TrainingSettings(
        algorithm=options.algorithm, steps=options.steps, imitation=options.imitate
    )
    settings = replace(settings, **dict(options.settings))
    try:
        begin = policy.load(options.policy) if options.policy else None
    except policy.PolicyError as error:
        raise SystemExit(f"rware_train: {error}") from error
    if options.imitate or begin:
        # Gently: what was learnt is soon unlearnt.
        settings = replace(settings, warm_up=15, rate=7e-4, entropy=0.003)
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        train(options, settings, seed, out, begin)


def arguments():
    parser = argparse.ArgumentParser(
        "rware_train", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("task", help="as RWARE registers it, without rware- and -v2: tiny-4ag")
    parser.add_argument("--algorithm", choices=ALGORITHMS, default="mappo")
    parser.add_argument(
        "--steps",
        type=int,
        default=TrainingSettings.steps,
        help="of all environments (%(default)s)",
    )
    parser.add_argument(
        "--imitate",
        type=int,
        default=0,
        metavar="STEPS",
        help="begin by imitating the fleet's planner (DAgger) in so many steps; 20000 will do",
    )
    parser.add_argument("--physics", choices=PHYSICS, default="grid", help="trained on (grid)")
    parser.add_argument(
        "--from", dest="policy", metavar="POLICY", help="begin with a trained one, a file or a name"
    )
    parser.add_argument(
        "--set",
        dest="settings",
        action="append",
        default=[],
        type=setting,
        metavar="NAME=VALUE",
        help="another value of a setting: " + ", ".join(SETTINGS),
    )
    parser.add_argument("--seeds", type=int, default=1, help="how many (1)")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument(
        "--minutes", type=float, default=float("inf"), help="after which a seed stops for now"
    )
    parser.add_argument("--out", default="results", help="folder (results)")
    return parser.parse_args()


def setting(text):
    """Returns the name and the value of NAME=VALUE."""
    name, _, value = text.partition("=")
    if name not in SETTINGS:
        raise argparse.ArgumentTypeError(f"there is no setting {name!r}; known: {', '.join(SETTINGS)}")
    try:
        return name, (int if SETTINGS[name] in (int, "int") else float)(value)
    except ValueError:
        kind = "an integer" if SETTINGS[name] in (int, "int") else "a number"
        raise argparse.ArgumentTypeError(f"{name} is {value!r}; {kind} was expected") from None


def train(options, settings, seed, out, begin):
    """One seed, from its checkpoint if there is one."""
    task, physics = options.task, options.physics
    if f"kiva-rware-{task}-v2" not in gymnasium.registry:
        raise SystemExit(f"rware_train: there is no task {task!r}; tiny-4ag or small-2ag-hard are")
    envs = gymnasium.make_vec(
        f"kiva-rware-{task}-v2",
        num_envs=settings.environments,
        threads=1,
        autoreset_mode=AutoresetMode.SAME_STEP,
        physics=physics,
    )
    about = {"task": task, "physics": physics, "from": options.policy}
    encoder = Encoder.of_task(envs.task)
    training = Training(envs, encoder, settings, seed)
    on = "" if physics == "grid" else f"-{physics}"
    name = f"{task}-{settings.algorithm}{on}-{seed}"
    checkpoint = out / f"{name}.checkpoint.npz"
    try:
        if begin:
            training.take(begin)
        if checkpoint.is_file():
            training.restore(checkpoint)
    except ValueError as error:
        raise SystemExit(f"rware_train: {error}; --out names another folder") from error
    out.mkdir(parents=True, exist_ok=True)
    saved = [0.0]

    def keep():
        training.save(checkpoint)
        record = about | training.record
        policy.GridPolicy(training.actor, encoder, record).save(out / f"{name}.npz")
        (out / f"{name}.json").write_text(json.dumps(record | {"curve": training.curve}))

    def report(now):
        last = now.curve[-1][1] if now.curve else 0
        rate = now.done / now.seconds
        print(f"{name}: {now.done:,} steps, return {last:.1f}; {rate:,.0f} a second", flush=True)
        if now.seconds > saved[0] + 60:
            saved[0] = now.seconds
            keep()

    try:
        if settings.imitation and not training.done:
            steps = settings.imitation
            training.seconds += imitate(training.actor, encoder, envs.task, steps, seed)
        training.run(options.minutes, report)
    except KeyboardInterrupt:
        print(f"{name}: stopped; the same command goes on from {checkpoint}")
        raise SystemExit(130) from None
    finally:
        keep()


if __name__ == "__main__":
    main()
