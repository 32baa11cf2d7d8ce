# SPDX-License-Identifier: Apache-2.0
"""Uses the installed warehouse as a stranger does, in the environment of a fresh terminal."""

import importlib
import os
import pkgutil
import re
import signal
import subprocess
import tempfile
import threading
import time
import urllib.request
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from queue import Queue
from string import Template

PATIENCE = 300.0  # [s, wall]
PAGE = "http://127.0.0.1:8080"
PACKAGES = ("kiva_plugin_cpp", "warehouse_layout", "warehouse_client", "warehouse_fleet")
PACKAGES += ("warehouse_vda5050", "warehouse_operations", "warehouse_viewer", "warehouse_sim")
NOT_OF_DEBIAN = {"ray"}


@contextmanager
def launched(*command, **options):
    """A launch whose lines come in a queue, None last; it ends by Ctrl-C, and without an error."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    with subprocess.Popen(command, **pipes, **options) as process:
        lines = Queue()
        output = chain(process.stdout, [None])
        threading.Thread(target=lambda: [*map(lines.put, output)], daemon=True).start()
        try:
            yield lines
        finally:
            process.send_signal(signal.SIGINT)
            status = process.wait(PATIENCE)
    assert status == 0, f"{command} ended with {status}"


def first_command(lines):
    """Returns the first `rostopic pub` that the launch recommends to try."""
    printed = []
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        line = lines.get(timeout=PATIENCE)
        assert line, "the launch ended:\n" + "".join(printed)
        printed.append(line)
        assert "setup.bash" not in printed[-1], "nothing is to be sourced"
        if match := re.match(r"\s*(rostopic pub .*?\S)\s+# ", printed[-1]):
            return match[1]
    raise TimeoutError("no command to try came:\n" + "".join(printed))


def drive(command):
    """Gives the command in a shell, and awaits ACCEPTED and DONE."""
    import rospy

    from warehouse_msgs.msg import Event

    rospy.init_node("stranger")
    events = Queue()
    heard = rospy.Subscriber("/warehouse/events", Event, events.put)
    end = time.monotonic() + PATIENCE
    while not heard.get_num_connections() and time.monotonic() < end:
        time.sleep(0.1)
    subprocess.run(command, shell=True, check=True, stdout=subprocess.DEVNULL)
    kinds = []
    while Event.DONE not in kinds:
        kinds.append(events.get(timeout=PATIENCE).kind)
        assert not {Event.REFUSED, Event.BLOCKED} & {*kinds}, kinds
    assert Event.ACCEPTED in kinds, kinds
    print(command, "-> DONE")


def open_page():
    """Fetches the page, once the viewer serves it, and all that it names."""
    end = time.monotonic() + PATIENCE
    while True:
        try:
            page = urllib.request.urlopen(PAGE, timeout=60).read().decode()
            break
        except OSError:
            if time.monotonic() > end:
                raise
        time.sleep(0.5)
    names = re.findall(r'(?:src|href)="(/?[\w./-]+\.(?:js|css|svg|webmanifest))"', page)
    assert names, page
    for name in names:
        urllib.request.urlopen(f"{PAGE}/{name.lstrip('/')}", timeout=60).read()
    print(f"the page and {len(names)} files of it answer")


def import_all():
    """Imports every module of the packages."""
    names = [*PACKAGES]
    for package in PACKAGES:
        path = importlib.import_module(package).__path__
        names += [m.name for m in pkgutil.walk_packages(path, package + ".")]
    for name in names:
        try:
            importlib.import_module(name)
        except ModuleNotFoundError as error:
            assert error.name in NOT_OF_DEBIAN, f"{name}: {error}"
    print(len(names), "modules imported")


def serve():
    """Runs the command of the systemd unit in its environment, until the page answers."""
    text = Path("/usr/lib/systemd/system/kiva-warehouse.service")
    text = text if text.exists() else Path("/lib/systemd/system/kiva-warehouse.service")
    with tempfile.TemporaryDirectory() as state:
        Path(state, "kiva-warehouse").mkdir()
        lines = text.read_text().replace("%S", state).splitlines()
        words = [w for line in lines if line.startswith("Environment=") for w in line[12:].split()]
        environment = {"PATH": os.environ["PATH"], **dict(word.split("=", 1) for word in words)}
        command = next(line[10:] for line in lines if line.startswith("ExecStart="))
        command = Template(command).substitute(environment).split()
        with launched(*command, env=environment, cwd=environment["HOME"]):
            open_page()
        assert list(Path(environment["ROS_HOME"]).iterdir()), "logs are kept where the unit says"
    print("the service's command runs")


def step_a_world():
    from kiva_plugin_cpp import World

    world = World.preset("small")
    world.step(1000)
    assert len(world.fleet.kiva_id) == 4


if __name__ == "__main__":
    step_a_world()
    import_all()
    with launched("roslaunch", "warehouse_sim", "warehouse.launch") as lines:
        command = first_command(lines)
        drive(command)
        open_page()
    serve()
