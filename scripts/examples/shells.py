# SPDX-License-Identifier: Apache-2.0
"""Runs commands as a person would: a page is a session, beside a warehouse that runs.

A block with the note `start: COMMAND` has programs that run until Ctrl-C, a line each. They begin
in the background, and the page goes on once COMMAND succeeds. They end with the page, or before its
next `start` that begins another warehouse.
"""

import contextlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import xmlrpc.client
from collections.abc import Iterator
from pathlib import Path

from examples.blocks import ROOT, Example, check

sys.path.append(str(ROOT / "scripts" / "pages"))

import running  # noqa: E402

LATE = 124  # exit code of `timeout`
PATIENCE = 120.0  # for one block; a note says otherwise [s]
TRIED = 10.0  # how long a command may take that tells whether a program is ready [s]
ENDING = 20.0  # until a program that got Ctrl-C is asked in another way [s]
LAUNCHED = re.compile(r"^(?:make run(?: ARGS=\"(?P<run>[^\"]*)\")?|make operate)(?: +#.*)?$")
WORLDS = re.compile(r"\b(?:warehouse|operations)\.launch\b|empty_world\.launch\b")
COMMON = 'make run ARGS="coordinator:=true"'  # beside pages that start none
DIRECTORY = "rosservice info /warehouse/transport"
# Has each command to a robot end before the next one, as a person who reads the events does.
WAITING = """
rostopic() {{
  command rostopic "$@"
  [ "$1" != pub ] || until command rostopic echo -n 1 /kiva{robot}/status/status | grep -q ^0; do
    sleep 0.1
  done
}}
"""


class Program:
    """A program in the background, with all that it starts."""

    def __init__(self, command: str, environment: dict[str, str], output: Path) -> None:
        self.command, self._output = command, output
        with output.open("w") as out:
            self._process = subprocess.Popen(
                ["setpriv", "--pdeathsig", "INT", "bash", "-c", f"exec {command}"],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def check(self) -> None:
        """Raises ValueError where it has ended."""
        if self._process.poll() is not None:
            output = self._output.read_text()[-2000:]
            raise ValueError(
                f"$ {self.command}\nhas ended with {self._process.returncode}\n{output}"
            )

    def end(self) -> None:
        """Presses Ctrl-C, and waits. What does not end is terminated, then killed."""
        for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, sent)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(ENDING)
                return


class Session:
    """A ROS master's address, a page's address, a home, and what was started there."""

    def __init__(self, folder: Path, slowness: float = 1.0) -> None:
        self._folder, self._programs, self._number, self._kept = folder, [], 0, 0
        self._tried = slowness * TRIED
        self.home = folder / "home"
        self.home.mkdir()
        self._renew()

    def continue_from(self, other: "Session") -> None:
        """Takes over what was exported in another session of the page."""
        self.environment = self._environment(other.environment)

    def keep(self) -> None:
        """Lets what runs by now outlive pages."""
        self._kept = len(self._programs)

    def _renew(self, exported=None):
        self.page, master = running.free_port(), running.free_port()
        self.uri = f"http://localhost:{master}"
        self.environment = self._environment(exported)

    def _environment(self, exported=None):
        return (exported or os.environ) | {
            "ROS_MASTER_URI": self.uri,
            "ROS_HOME": str(self.home / ".ros"),
            "HOME": str(self.home),
        }

    def start(self, text: str, ready: str, patience: float) -> None:
        """Starts the programs of a block, and waits until a command succeeds."""
        for command in _lines(text):
            launched = _launch(command)
            if begins_world(command):
                exported = self.environment
                self.leave()
                self._renew(exported)
                if "empty_world" not in launched:
                    launched += f" viewer_port:={self.page}"
                self._begin_world(launched, patience)
            else:
                self._programs.append(self._begin(launched))
        self._wait(self._programs[-1], lambda: not self._try(ready), patience)

    def _begin_world(self, launched, patience):
        """Begins a master, then a launch: roslaunch gives a master of its own 10 s to come up."""
        port = self.uri.rpartition(":")[2]
        self._programs.append(self._begin(f"rosmaster --core -p {port}"))
        self._wait(self._programs[-1], self._has_master, patience)
        self._programs.append(self._begin(launched))

    def begin(self, command: str, ready: str, patience: float) -> Program:
        """Returns a program that outlives worlds, once the command `ready` succeeds."""
        program = self._begin(command)
        self._wait(program, lambda: not self._try(ready), patience)
        return program

    def _begin(self, command):
        output = self._folder / f"output-{self._number}"
        self._number += 1
        return Program(self._local(command), self.environment, output)

    def run(self, text: str, before: str, patience: float) -> str:
        """Runs the commands of a block in one shell; returns what they print.

        What it exports holds for the next.

        Raises ValueError where a command fails, or a service does.
        """
        kept = self._folder / "environment"
        body = "\n".join(self._local(line) for line in text.splitlines() if not _sourced(line))
        trap = "trap 'echo \"this failed: $BASH_COMMAND\" >&2' ERR"
        script = f"set -e\n{before}\n{trap}\n{body}\nenv -0 >{kept}\n"
        done = subprocess.run(
            ["timeout", "--kill-after=5", f"{patience:g}", "bash", "-c", script],
            env=self.environment,
            stdin=subprocess.DEVNULL,
            text=True,
            capture_output=True,
            check=False,
        )
        if done.returncode == LATE:
            raise ValueError(f"it took longer than {patience:g} s\n{done.stdout[-2000:]}")
        if done.returncode or re.search(r"\bsuccess: False", done.stdout):
            raise ValueError(f"{done.stderr[-3000:]}{done.stdout[-2000:]}")
        entries = kept.read_text().split("\0")
        self.environment = dict(entry.split("=", 1) for entry in entries if "=" in entry)
        for program in self._programs:
            program.check()
        return done.stdout

    def leave(self) -> None:
        """Ends what a page has started, the last first, and forgets what it has exported."""
        while len(self._programs) > self._kept:
            self._programs.pop().end()
        self.environment = self._environment()

    def end(self) -> None:
        """Ends all that was started."""
        self._kept = 0
        self.leave()

    def names(self) -> tuple[dict[str, str], list[str]]:
        """Returns {topic: type} and the services of the ROS graph."""
        master = xmlrpc.client.ServerProxy(self.uri)
        published, _, services = master.getSystemState("/examples")[2]
        types = dict(master.getTopicTypes("/examples")[2])
        return {name: types.get(name, "") for name, _ in published}, [name for name, _ in services]

    def _local(self, command):
        """A command with the port of this session's page."""
        return command.replace("localhost:8080", f"localhost:{self.page}")

    def _has_master(self):
        with contextlib.suppress(OSError):
            return xmlrpc.client.ServerProxy(self.uri).getPid("/examples")[0] == 1
        return False

    def _try(self, command):
        """Returns how a command ends."""
        done = subprocess.run(
            ["timeout", f"{self._tried:g}", "bash", "-c", self._local(command)],
            env=self.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
        )
        return done.returncode

    def _wait(self, program, true, patience):
        end = time.monotonic() + patience
        while not true():
            program.check()
            if time.monotonic() > end:
                raise ValueError(f"$ {program.command}\nis not ready after {patience:g} s")
            time.sleep(0.2)


class Shells:
    """The sessions of all pages: one that they share, and one for each that starts its own."""

    def __init__(self, stack: contextlib.ExitStack, slowness: float = 1.0) -> None:
        self._stack, self._common, self._own, self._page = stack, None, None, None
        self._slowness = slowness  # of the machine: all may take as many times as long
        self._broken = False  # what the page has started
        self._helpers: list[Program] = []
        stack.callback(self._leave)
        self.names: tuple[dict[str, str], list[str]] | None = None

    def run(self, example: Example) -> None:
        """Runs a block of commands. Raises ValueError where one fails."""
        check(example)
        if example.page != self._page:
            self._leave()
            self._page, self._broken = example.page, False
        if self._broken:
            raise ValueError("what the page started before this does not run")
        text = example.text
        if example.language == "console":
            text = "\n".join(re.findall(r"^\$ (.*)$", text, re.M))
        self._run(text, example.notes)

    def _run(self, text, notes):
        patience = self._slowness * float(notes.get("patience", PATIENCE))
        if self._own is None and any(begins_world(line) for line in _lines(text)):
            self._own = self._session()
            if self._common:
                self._own.continue_from(self._common)
        session = self._own or self._shared()
        if "stop" in notes:
            session.leave()
        before = notes.get("before", "")
        if "beside" in notes:
            session.run("", before, patience)
            helper = session.begin(notes["beside"], notes.get("ready", "true"), patience)
            self._helpers.append(helper)
        if "start" in notes:
            self._broken = True
            session.run("", before, patience)
            session.start(text, notes["start"], patience)
            self._broken = False
            return
        if robot := notes.get("wait"):
            before += WAITING.format(robot=robot)
        result = session.run(text, before, patience)
        if not re.search(notes.get("expect", ""), result):
            expected = notes["expect"]
            raise ValueError(f"{expected} was expected in what it prints:\n{result[-2000:]}")

    def _leave(self):
        while self._helpers:
            self._helpers.pop().end()
        if self._common:
            self._common.leave()
        if self._own:
            self._own.end()
        self._own = None

    def _shared(self):
        if self._common is None:
            self._common = self._session()
            self._common.start(COMMON, DIRECTORY, self._slowness * PATIENCE)
            running.wait(lambda: running.ask(self._address()), "the page of a warehouse")
            self.names = self._common.names()
            self._common.keep()
        return self._common

    def _address(self):
        return f"http://localhost:{self._common.page}/api/v1/warehouse"

    def _session(self):
        folder = self._stack.enter_context(tempfile.TemporaryDirectory(prefix="examples-"))
        session = Session(Path(folder), self._slowness)
        self._stack.callback(session.end)
        return session


def _sourced(line):
    """Whether a line sources what this program's own environment has."""
    return re.match(r"(source|\.) \S*(devel|/opt/kiva)\S*$", line.strip())


def _lines(text) -> Iterator[str]:
    for line in text.replace("\\\n", " ").splitlines():
        if line.strip() and not line.startswith("#") and not _sourced(line):
            yield line


def begins_world(command: str) -> bool:
    """Returns whether a command launches a warehouse."""
    return bool(WORLDS.search(_launch(command)))


def _launch(command):
    """What a target of make launches, without its builds."""
    match = LAUNCHED.match(command)
    if not match:
        return command
    launch = "roslaunch --sigint-timeout=3 --sigterm-timeout=1 warehouse_sim"
    if command.startswith("make operate"):
        return f"{launch} operations.launch"
    return f"{launch} warehouse.launch {match['run'] or ''}"


def linked_folder(stack: contextlib.ExitStack) -> Path:
    """Returns a folder in which the repository's own entries lie as links."""
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="page-")))
    for entry in ROOT.iterdir():
        (folder / entry.name).symlink_to(entry)
    return folder
