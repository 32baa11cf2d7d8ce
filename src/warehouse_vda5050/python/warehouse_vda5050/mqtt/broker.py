# SPDX-License-Identifier: Apache-2.0
"""A mosquitto of one's own, on the loopback alone."""

import contextlib
import os
import pathlib
import pwd
import shutil
import socket
import subprocess
import tempfile
import time

WAIT = 10.0  # timeout of its start [s]


class BrokerStartError(RuntimeError):
    """The broker did not come up; the message says why."""


class OwnBroker:
    """Runs mosquitto on 127.0.0.1 until close(), or until this process ends.

    port: 0 takes 1883 if that is free, else any. lines: further lines of its configuration; without
    them all on this machine are let in, and none from elsewhere. Raises BrokerStartError.
    """

    def __init__(self, port: int = 0, lines: str = "allow_anonymous true") -> None:
        program = shutil.which("mosquitto", path=os.environ.get("PATH", "") + ":/usr/sbin")
        if program is None:
            raise BrokerStartError("mosquitto is not installed")
        self.port = port or _free_port()
        self._folder = tempfile.TemporaryDirectory(prefix="vda5050_broker")
        self._log = pathlib.Path(self._folder.name, "log")
        config = pathlib.Path(self._folder.name, "mosquitto.conf")
        config.write_text(_configuration(self.port, lines))
        self._command = ["setpriv", "--pdeathsig", "TERM", program, "-c", str(config)]
        self._process: subprocess.Popen | None = None
        self.start()

    def start(self) -> None:
        """Starts it, as it was, after stop(). Raises BrokerStartError."""
        with self._log.open("w") as log:
            self._process = subprocess.Popen(self._command, stdout=log, stderr=log)
        end = time.monotonic() + WAIT
        while not _listens(self.port):
            if self._process.poll() is not None or time.monotonic() > end:
                text = self._log.read_text()[-500:].strip()
                self.close()
                raise BrokerStartError(f"mosquitto did not come up: {text}")
            time.sleep(0.02)

    def stop(self, kill: bool = False) -> None:
        """Ends it; `kill`: without giving it time to say goodbye."""
        if self._process:
            (self._process.kill if kill else self._process.terminate)()
            self._process.wait()
            self._process = None

    @property
    def pid(self) -> int:
        """The number of its process, 0 while it is stopped."""
        return self._process.pid if self._process else 0

    def close(self) -> None:
        """Ends it and removes its files."""
        self.stop()
        self._folder.cleanup()

    def __enter__(self) -> "OwnBroker":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _configuration(port: int, lines: str) -> str:
    user = pwd.getpwuid(os.getuid()).pw_name
    return f"listener {port} 127.0.0.1\nuser {user}\npersistence false\n{lines}\n"


def _free_port() -> int:
    for port in (1883, 0):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return probe.getsockname()[1]
    raise BrokerStartError("no free port on the loopback")


def _listens(port: int) -> bool:
    with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
        return True
    return False
