# SPDX-License-Identifier: Apache-2.0
"""What each part of the benchmarks measured, as figures: names, units, limits, and ratios to the
bare arrays' loop of the same run, which takes a slow or crowded machine out of the comparison."""

from dataclasses import dataclass
from statistics import median

LISTENING, UNHEARD = "one client hears all robots", "no subscriber"

# The bare arrays that do the same work as a robot, with as many rays.
ARRAYS = {"default": "arrays, 121 rays", "at_once": "arrays", "jointed": "arrays"}

# The least real-time factor.
LIMITS = {
    "default, N = 1,000, no scan read": ">= 48",
    "default, N = 10,000, no scan read": ">= 4",
    "at_once, N = 1,000": ">= 12",
    "at_once, N = 10,000": ">= 1.2",
    "at_once, N = 1,000, no lasers": ">= 60",
    "jointed, N = 100": ">= 2.5",
    "jointed, N = 1,000": ">= 0.2",
}
NODE_LIMIT = "<= 0.3"  # cores, of those that follow the warehouse
FOLLOWING_NODES = ("track_", "create_warehouse_topics")


@dataclass(frozen=True)
class Figure:
    """`name`: what was measured. `ratio`: over the arrays' real-time factor where more is faster,
    times it where less is: seconds that the arrays' loop simulates meanwhile. None: a machine's
    speed changes nothing of it."""

    name: str
    value: float
    unit: str = ""
    limit: str = ""  # such as ">= 12"
    wall: float | None = None  # the same by the wall clock, where `value` is by CPU time
    ratio: float | None = None
    more_is_faster: bool = True


def of(part, measured, arrays):
    """The figures of one part. `arrays`: real-time factor by CPU of a thousand of them, then."""
    return OF_PART[part](measured, Scale(arrays))


class Scale:
    """Makes figures that a machine's speed changes."""

    def __init__(self, arrays):
        self._arrays = arrays

    def speed(self, name, value, unit="RTF", limit="", wall=None):
        ratio = value / self._arrays if value is not None else None
        return Figure(name, value, unit, limit, wall, ratio)

    def time(self, name, value, unit, limit=""):
        ratio = value * self._arrays * SECONDS[unit] if value is not None else None
        return Figure(name, value, unit, limit, None, ratio, more_is_faster=False)


SECONDS = {"s": 1, "ms": 1e-3, "us": 1e-6, "CPU s": 1, "CPU us": 1e-6, "cores": 1}

# --- in one process


def name(figure):
    """Returns the name of an in-process figure, such as "default, N = 1,000, no scan read"."""
    read = "" if figure.get("read", True) else ", no scan read"
    lasers = read if figure["lasers"] else ", no lasers"
    return f"{figure['engine']}, N = {figure['robots']:,}{lasers}"


def _fleet(measured, _):
    arrays = {(f["engine"], f["robots"]): f["rtf_cpu"] for f in measured if f["lasers"]}
    out = []
    for figure in measured:
        beside = arrays.get((ARRAYS.get(figure["engine"]), figure["robots"]))
        ratio = figure["rtf_cpu"] / beside if beside and figure["lasers"] else None
        what = name(figure)
        limit = LIMITS.get(what, "")
        out.append(Figure(what, figure["rtf_cpu"], "RTF", limit, figure["rtf"], ratio))
        if what == "default, N = 1,000" and ratio:
            out.append(Figure(f"{what}, over the arrays", ratio, "", ">= 0.75"))
    return out + _scaling(measured)


def _scaling(measured):
    """Returns how much more a robot's step costs in a larger fleet."""
    out = []
    for engine, few, limit in (("default", 1000, "<= 1.3"), ("at_once", 100, "<= 1.5")):
        ours = [f for f in measured if f["engine"] == engine and f["lasers"]]
        ours = [f for f in ours if f["read"] == (engine == "at_once")]
        cost = {f["robots"]: 1 / f["rtf_cpu"] / f["robots"] for f in ours}
        if few in cost and 10000 in cost:
            what = f"{engine}: cost of a robot at N = 10,000 over {few:,}"
            out.append(Figure(what, cost[10000] / cost[few], "", limit))
    return out


def _threads(measured, _):
    """Returns figures by the wall clock, since CPU time is that of the calling thread alone."""
    speed = {n: median(f["rtf"] for f in measured if f["threads"] == n) for n in (1, 2)}
    what = "default, N = 10,000: "
    return [
        Figure(f"{what}one thread, by the wall clock", speed[1], "RTF"),
        Figure(f"{what}two threads, by the wall clock", speed[2], "RTF"),
        Figure(f"{what}two threads over one", speed[2] / speed[1], "", ">= 1.6"),
    ]


def _unread(measured, _):
    """Not asking may not be dearer, but for what chance does to medians of five."""
    out = []
    for robots in (1, 10):
        ours = [f for f in measured if f["robots"] == robots]
        speed = {r: median(f["rtf_cpu"] for f in ours if f["read"] == r) for r in (True, False)}
        what = f"default, N = {robots}: no scan read over all, in turns"
        out.append(Figure(what, speed[False] / speed[True], "", ">= 0.95"))
    return out


FAULTS = ("collisions", "blocked", "watchdog")


def _shifts(measured, scale):
    out = []
    for f in measured:
        what = f"shift of {f['size']}, {f['simulated_s'] / 60:.0f} min from standstill"
        limit = {"large": ">= 60", "huge": ">= 15"}.get(f["size"], ">= 2")
        out += [
            scale.speed(what, f["rtf_cpu"], limit=limit),  # asked by CPU time, of all threads
            Figure(f"{what}: by the wall clock", f["rtf"], "RTF"),
            Figure(f"{what}: CPU time of orders and stock, of all", f["shift_share"]),
            Figure(
                f"{what}: of the stations' bound, last minute", f["share_of_bound"], "", ">= 0.85"
            ),
            *(Figure(f"{what}: {kind}", f[kind], "", "<= 0") for kind in FAULTS),
            Figure(f"{what}: memory", f["memory_gb"], "GB", "<= 3"),
        ]
    return out


def _plans(measured, scale):
    out = []
    for f in measured:
        limit = {1000: "<= 10", 10000: "<= 300"}[f["robots"]]
        what = f"planning {f['robots']:,} robots on {f['threads']} threads"
        out += [
            scale.time(f"{what}: a step, p99, by the clock", f["ms_p99"], "ms", limit),
            scale.time(f"{what}: a step, median, by the clock", f["ms_p50"], "ms"),
            Figure(f"{what}: memory", f["memory_mb"] / 1000, "GB", "<= 2"),
        ]
    return out


def _rware(measured, _):
    """Returns ratios of CPU time to the package, measured in turns: no machine's speed counts."""
    limits = {"alone": ">= 30", "64 on one thread": ">= 150", "64 on all": ">= 150"}
    return [
        Figure(
            f"RWARE {f['task']}, {f['case']}: agent steps of CPU over the package's",
            f["times"],
            "",
            limits.get(f["case"], ""),
        )
        for f in measured
        if f["case"] != "the package"
    ]


def _resets(measured, scale):
    return [
        scale.time(
            f"a reset of {f['size']}", f["ms_cpu"], "ms", "<= 1" if f["size"] == "large" else ""
        )
        for f in measured
    ]


def _others(measured, scale):
    return [scale.speed(name(f), f["rtf_cpu"], wall=f["rtf"]) for f in measured if "engine" in f]


def _following(measured, _):
    return [
        Figure(
            f"{figure['robots']:,} followers, {way}: step over that of one long command",
            figure[way]["ratio"],
            limit="<= 1.05",
        )
        for figure in measured
        for way in ("path", "releases")
    ]


def _warehouse(measured, scale):
    out = []
    for f in measured:
        scans = "all scans read" if f["lasers"] else "no scans read"
        what = f"huge in-process, random commands, {scans}"
        limit = ">= 4"
        if minutes := f.get("after_min"):
            what, limit = f"{what}, after {minutes} min", ">= 5"
        out.append(scale.speed(what, f["rtf_cpu"], limit=limit, wall=f["rtf"]))
    return out


# --- under ROS


def _ros(nodes, scale):
    what = f"huge, {LISTENING}, {nodes['seconds']:g} s: "
    memory = nodes["memory_at_mb"]  # before, in a long run after a minute, and afterwards
    rest = [a - b for a, b in zip(memory, nodes["recording_mb"])]
    us = nodes["messages_per_second"] * nodes["seconds"] / 1e6  # of messages, in millions
    out = [
        scale.time("create_warehouse_models huge", nodes["create_s"], "s", "<= 10"),
        Figure(what + "RTF", nodes["rtf"], "", ">= 0.99"),
        Figure(what + "messages", nodes["messages_per_second"], "/s", ">= 19000"),
        Figure(what + "fewest of one topic", nodes["least_rate"], "Hz"),
        scale.time(what + "how late, p99", nodes["late_p99_ms"], "ms", "<= 20"),
        scale.time(what + "command to ACCEPTED, p99", nodes["accepted_p99_ms"], "ms", "<= 30"),
        scale.time(what + "the world's node, a message", nodes["watched_cpu_s"] / us, "CPU us"),
        scale.time(what + "the client, a message", nodes["cpu_s"] / us, "CPU us"),
        Figure(what + "memory, after over before", memory[-1] / memory[0], "", "<= 1.02"),
        Figure(
            what + "memory but the recording, after over before", rest[-1] / rest[0], "", "<= 1.02"
        ),
    ]
    if len(rest) > 2:
        since = what + "memory but the recording, after over the first minute"
        out.append(Figure(since, rest[-1] / rest[1], "", "<= 1.02"))
    if nodes["topics_s"] is not None:
        stand = scale.time("then until all items' topics stand", nodes["topics_s"], "s", "<= 60")
        out.insert(1, stand)
    return out + _nodes(nodes, what, scale)


def _unheard(nodes, scale):
    what = f"huge, {UNHEARD}, rtf:=0, {nodes['seconds']:g} s: "
    accepted = scale.time(what + "command to ACCEPTED, p99", nodes["accepted_p99_ms"], "ms")
    return [
        scale.speed(what + "RTF", nodes["rtf"], "", ">= 4"),
        accepted,
        *_nodes(nodes, what, scale),
    ]


def _work(measured, scale):
    alone, measurements = measured["in_process"], measured["under_ros"]
    within = f"huge at work in-process, {alone['simulated_s'] / 60:.0f} min from standstill"
    what = f"huge at work under ROS, rtf:=0, {measurements['minutes']:g} min from standstill: "
    return [
        scale.speed(within, alone["rtf_cpu"], limit=">= 8", wall=alone["rtf"]),
        Figure(f"{within}: units delivered", alone["delivered"]),
        scale.speed(what + "RTF", measurements["rtf"], "", ">= 4"),
        Figure(
            what + "units, over those in-process",
            measurements["delivered"] / alone["delivered"],
            "",
            ">= 0.9",
        ),
        *_nodes(measurements, what, scale),
    ]


def _nodes(nodes, what, scale):
    out = [Figure(what + "memory of all nodes", nodes["memory_mb"], "MB", "<= 1500")]
    for node, cores in sorted(nodes["cores"].items()):
        if cores > 0.02:
            limit = NODE_LIMIT if node.startswith(FOLLOWING_NODES) else ""
            out.append(scale.time(what + node, cores, "cores", limit))
    return out


def _recreations(measured, _):
    def growth(of_what, memory):
        what = f"{measured['size']}, memory of {of_what}, creation {len(memory)} over 2"
        return Figure(what, memory[-1] / memory[1], "", "<= 1.02")

    memory = measured["memory_mb"]
    rest = [a - b for a, b in zip(memory, measured["recording_mb"])]
    return [
        growth("all nodes", memory),
        growth("all nodes but the viewer's recording", rest),
        growth("the world's node", measured["node_mb"]),
    ]


def _start(report, scale):
    return [
        scale.time("small stands after roslaunch", report["stands_s"], "s", "<= 4"),
        scale.time(
            "small stands: CPU time of all nodes until then", report["stands_cpu_s"], "CPU s"
        ),
        scale.time("import kiva_plugin_cpp", report["import_s"], "s", "<= 0.15"),
        scale.time("import kiva_plugin_cpp: CPU time", report["import_cpu_s"], "CPU s"),
        scale.time("World.create, 10,000 robots", report["create_s"], "s", "<= 5"),
        scale.time("World.create, 10,000 robots: CPU time", report["create_cpu_s"], "CPU s"),
        Figure("World.create, 10,000 robots: memory", report["create_gb"], "GB", "<= 1.5"),
    ]


def _build(report, scale):
    return [
        scale.time("make build, from nothing", report["build_s"], "s", "<= 120"),
        scale.time("make build: CPU time", report["build_cpu_s"], "CPU s"),
    ]


OF_PART = {
    "fleet": _fleet,
    "threads": _threads,
    "unread": _unread,
    "references": _others,
    "peers": _others,
    "following": _following,
    "warehouse": _warehouse,
    "ros": _ros,
    "unheard": _unheard,
    "work": _work,
    "shifts": _shifts,
    "ten_thousand": _shifts,
    "plans": _plans,
    "rware": _rware,
    "resets": _resets,
    "recreations": _recreations,
    "start": _start,
    "build": _build,
}
