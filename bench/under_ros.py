# SPDX-License-Identifier: Apache-2.0
"""The warehouse under ROS: a session of its own, what its clients get, and what its nodes need."""

import collections
import contextlib
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request
import xmlrpc.client
from pathlib import Path

import programs
import rosgraph
import rospy
import rosservice

from gazebo_msgs.srv import GetModelState
from warehouse_layout.file import request
from warehouse_msgs.msg import WarehouseState
from warehouse_msgs.srv import CreateWarehouse
from warehouse_sim.tracker import topics_allowed

PATIENCE = 120  # [s]
TICK = os.sysconf("SC_CLK_TCK")
NODE = "kiva_world_node"
CONNECTED = 60.0  # after its start a client's connections, and all queues, are there [s]
SETTLED = 0.005  # of its memory
SETTLING = 8.0  # for how long memory is as steady as that [s]


class Session:
    """A master and a warehouse of its own.

    `await_ready`: entering waits until it takes calls. `file`: a launch file of warehouse_sim. The
    other arguments are those of that file.
    """

    def __init__(self, await_ready=True, file="warehouse.launch", **arguments):
        self._await_ready, self._file = await_ready, file
        self._words = [f"{name}:={value}" for name, value in arguments.items()]

    def __enter__(self):
        port = random.randrange(21000, 29000)
        self._page = port + 9000
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
        self._home = tempfile.TemporaryDirectory(prefix="bench_ros_")
        os.environ["ROS_HOME"] = self._home.name
        self.home = self._home.name
        self._log = open(f"{self.home}/roslaunch.log", "w+")  # noqa: SIM115, closed with it
        self._launches = []
        words = [self._file, *self._words, f"viewer_port:={self._page}"]
        self.launch("-p", str(port), "warehouse_sim", *words)
        try:
            self.wait(rosgraph.is_master_online, "the master")
            if self._await_ready:
                name = "/warehouse/create_warehouse_models"
                self.wait(lambda: name in rosservice.get_service_list(), "the warehouse")
        except BaseException:  # a Ctrl-C too: nothing may be left running
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        started = self.nodes()
        try:
            for launch in reversed(self._launches):  # the master ends last
                launch.send_signal(signal.SIGINT)
                launch.wait(60)
        except subprocess.TimeoutExpired:
            for pid in started:  # roslaunch gives each a group of its own
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        self._log.close()
        self._home.cleanup()

    def launch(self, *words):
        """Starts one more roslaunch, which ends with the session."""
        command = ["setpriv", "--pdeathsig", "TERM"]  # nothing is left if this is killed
        command += ["roslaunch", "--sigint-timeout=3", "--sigterm-timeout=1", *words]
        print(f"$ {' '.join(command)}", file=sys.stderr, flush=True)
        started = subprocess.Popen(
            command, stdout=self._log, stderr=self._log, start_new_session=True
        )
        self._launches.append(started)

    def wait(self, condition, what, pause=0.05):
        """Until `condition()`; raises FailedError with what was logged after PATIENCE."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if any(launch.poll() is not None for launch in self._launches):
                break
            with contextlib.suppress(OSError, rosservice.ROSServiceException):
                if condition():
                    return
            time.sleep(pause)
        self._log.seek(0)
        tail = " | ".join(self._log.read().strip().splitlines()[-3:])
        raise programs.FailedError(f"{what} did not come up: {tail}")

    def wait_for_state(self, name):
        """Until /warehouse/state tells that a preset stands. Once in the life of a process."""
        arrived = threading.Event()

        def look(state):
            if len(state.kivas) == request.PRESETS[name].robots:
                arrived.set()

        rospy.init_node("bench", anonymous=True, disable_signals=True, disable_rostime=True)
        rospy.Subscriber("/warehouse/state", WarehouseState, look)
        if not arrived.wait(PATIENCE):
            raise programs.FailedError(f"{name} did not stand within {PATIENCE} s")

    def create(self, name):
        """Seconds from call to reply."""
        call = rospy.ServiceProxy("/warehouse/create_warehouse_models", CreateWarehouse)
        begin = time.monotonic()
        reply = call(warehouse_name=name)
        if not reply.success:
            raise programs.FailedError(f"create_warehouse_models {name}: {reply.message}")
        return time.monotonic() - begin

    def item_topics_stand(self, name="huge"):
        """Seconds until all items of a preset have topics, or as many as may open files here have;
        None if they never have."""
        return self._topics_stand("/items/item", topics_allowed(request.PRESETS[name].items))

    def _topics_stand(self, prefix, count):
        master = xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"])
        begin = time.monotonic()
        while time.monotonic() < begin + PATIENCE:
            topics = master.getPublishedTopics("/bench", "/")[2]
            if sum(topic.startswith(prefix) for topic, _ in topics) >= count:
                return time.monotonic() - begin
            time.sleep(1)
        return None

    def simulated(self):
        """The time of the world [s]."""
        state = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)("kiva1", "")
        return state.header.stamp.to_sec()

    def delivered(self):
        """Storage units that the coordinator had brought to stations."""
        with urllib.request.urlopen(f"http://localhost:{self._page}/api/v1/coordinator") as answer:
            return json.load(answer)["transports"]["delivered"]

    def nodes(self):
        """Program names by process id: all that roslaunch started, and itself."""
        out, pids = {}, [launch.pid for launch in self._launches]
        while pids:
            pid = pids.pop()
            out[pid] = _command(pid)
            pids += _children(pid)
        return out

    def memory(self):
        """Returns the memory of each node [MB], by program name; shared pages count once."""
        out = collections.Counter()
        for pid, name in self.nodes().items():
            out[name] += memory_of(pid) / 1e3
        return out

    def recording(self):
        """Returns how much of the viewer's memory is its recording of the last hour [MB]."""
        with urllib.request.urlopen(f"http://localhost:{self._page}/metrics") as answer:
            row = re.search(r"^warehouse_recording_bytes (\S+)", answer.read().decode(), re.M)
        return float(row[1]) / 1e6

    def settled_memory(self, patience=60):
        """Returns memory() once its sum is steady: a world returns free memory some seconds after
        it was built."""
        last, end = self.memory(), time.monotonic() + patience
        steady_since = time.monotonic()
        while time.monotonic() < min(end, steady_since + SETTLING):
            time.sleep(1)
            memory = self.memory()
            if abs(memory.total() - last.total()) > SETTLED * last.total():
                last, steady_since = memory, time.monotonic()
        return self.memory()

    def cpu(self):
        """CPU seconds by program name."""
        used = collections.Counter()
        for pid, name in self.nodes().items():
            used[name] += _cpu(pid)
        return used


def _command(pid):
    with contextlib.suppress(OSError):
        words = Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")
        named = [word for word in words if not word.endswith(("python3", "python"))]
        return next((Path(word).name for word in named if word not in ("", "-m")), "?")
    return "?"


def _children(pid):
    with contextlib.suppress(OSError):
        return list(map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split())) + [
            int(child)
            for task in Path(f"/proc/{pid}/task").iterdir()
            if task.name != str(pid)
            for child in (task / "children").read_text().split()
        ]
    return []


def memory_of(pid):
    """Returns the memory of a process [kB]; shared pages count in parts."""
    with contextlib.suppress(OSError):
        for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1])
    return 0


def _cpu(pid):
    with contextlib.suppress(OSError):
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / TICK
    return 0.0


class Look:
    """The memory of each node now, or once it is steady, and of the viewer's recording [MB]."""

    def __init__(self, session, settled=False):
        self.memory = session.settled_memory() if settled else session.memory()
        self.recording = session.recording()


def client(session, seconds, *options):
    """What one client of the whole fleet gets, and each program's share of a core meanwhile."""
    before, begin = session.cpu(), time.monotonic()
    world = next(pid for pid, name in session.nodes().items() if name == NODE)
    command = [programs.BUILT / "fleet_client", "--seconds", seconds, "--watch", world, *options]
    out = programs.figures(command, seconds + 300)[0]
    took, after = time.monotonic() - begin, session.cpu()
    out["cores"] = {name: (used - before.get(name, 0)) / took for name, used in after.items()}
    out["memory_mb"] = session.memory().total()
    return out | {"seconds": seconds}


def listening(seconds):
    """Creates `huge`, and lets one client follow and command it in real time."""
    with Session(size="empty", rtf=1) as session:
        out = {"create_s": session.create("huge")}
        out["topics_s"] = session.item_topics_stand()
        looks = [Look(session, settled=True)]
        connected = threading.Timer(CONNECTED, lambda: looks.append(Look(session)))
        connected.start()
        out |= client(session, seconds)
        connected.cancel()
        connected.join()
        looks.append(Look(session))
        for name in sorted(looks[-1].memory):
            each = ", ".join(f"{look.memory[name]:.0f}" for look in looks)
            programs.say(f"  {name}: {each} MB")
        return out | {
            "memory_at_mb": [look.memory.total() for look in looks],
            "recording_mb": [look.recording for look in looks],
        }


def unheard(seconds):
    """The same as fast as it goes, while no client subscribes to single robots."""
    with Session(size="huge", rtf=0) as session:
        session.item_topics_stand()
        return client(session, seconds, "--no-listen")


def working(minutes):
    """`huge` with its robots at work as a fleet for that long, from standstill and as fast as its
    coordinator can follow."""
    with Session(size="huge", rtf=0, coordinator="true", transports="random") as session:
        session.wait(lambda: session.delivered() >= 0, "the coordinator", pause=0.02)
        before, delivered = session.cpu(), session.delivered()
        simulated, begin = session.simulated(), time.monotonic()
        while session.simulated() < simulated + 60 * minutes:
            time.sleep(0.02)
        took, simulated = time.monotonic() - begin, session.simulated() - simulated
        cores = {name: (used - before.get(name, 0)) / took for name, used in session.cpu().items()}
        return {
            "minutes": minutes,
            "rtf": simulated / took,
            "delivered": session.delivered() - delivered,
            "cores": cores,
            "memory_mb": session.memory().total(),
        }
