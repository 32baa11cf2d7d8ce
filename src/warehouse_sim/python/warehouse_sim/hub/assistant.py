# SPDX-License-Identifier: Apache-2.0
"""The assistant's server, which answers at /mcp: it has a Python environment of its own."""

import asyncio
import hmac
import os
import secrets
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from warehouse_sim.hub.process import free_port

MISSING = (
    "the assistant's packages are not installed: `make serve` installs them where PyPI is reachable"
)


STARTUP = 20.0  # [s, wall]
KEY, ALLOW, CLIENT = b"x-warehouse-key", b"x-warehouse-allow", b"x-warehouse-client"

Headers = list[tuple[bytes, bytes]]


@dataclass(frozen=True)
class Permission:
    """The clients whose assistants may change something: all of the hub, or those with a token."""

    everybody: bool = False
    token: str = ""  # "": no request has permission

    def holds(self, headers: Headers) -> bool:
        """Returns whether a request with these headers has permission."""
        scheme, _, token = dict(headers).get(b"authorization", b"").partition(b" ")
        brings = scheme.lower() == b"bearer" and hmac.compare_digest(token, self.token.encode())
        return self.everybody or bool(self.token and brings)


class Assistant:
    """The assistant's process, which ends with this program; without `python` there is no process.

    hub: the address of its requests, with `token` where the hub needs one.
    """

    def __init__(
        self,
        python: Path | None,
        hub: str,
        token: str = "",
        permission: Permission = Permission(),  # noqa: B008 (frozen)
    ) -> None:
        self.address, self.reason = "", MISSING
        self._permission = permission
        self._popen: subprocess.Popen | None = None
        self._port, self._answers = 0, False
        # Any program of this machine can reach the port; the hub alone knows the key.
        self._key = secrets.token_hex(16)
        if python and python.exists():
            self._port = free_port()
            module = [str(python), "-m", "warehouse_assistant", "--port", str(self._port)]
            self._popen = subprocess.Popen(
                ["setpriv", "--pdeathsig", "TERM", *module, "--hub", hub],
                stdin=subprocess.DEVNULL,
                stdout=sys.stderr,
                env={**os.environ, "WAREHOUSE_TOKEN": token, "WAREHOUSE_ASSISTANT_KEY": self._key},
                start_new_session=True,
            )
            self.address = f"http://127.0.0.1:{self._port}"
        elif python:
            self.reason = f"the assistant's environment has no {python}: `make serve` makes it"

    def headers(self, headers: Headers, client: str) -> Headers:
        """Returns a request's headers for its server, with the permissions of the sender."""
        own = [(KEY, self._key.encode()), (CLIENT, client.encode())]
        if self._permission.holds(headers):
            own.append((ALLOW, b"commands"))
        return [pair for pair in headers if pair[0] not in (KEY, ALLOW, CLIENT)] + own

    async def wait(self) -> None:
        """Waits until its server answers for the first time, STARTUP at most."""
        end = time.monotonic() + STARTUP
        while not (self._answers or self.fault()) and time.monotonic() < end:
            try:
                _, writer = await asyncio.open_connection("127.0.0.1", self._port)
                writer.close()
                self._answers = True
            except OSError:
                await asyncio.sleep(0.1)

    def fault(self) -> str:
        """Returns the reason why it can't answer; "" if it can."""
        if self._popen is None:
            return self.reason
        code = self._popen.poll()
        return "" if code is None else f"the assistant's server ended with exit code {code}"

    async def close(self) -> None:
        """Ends it."""
        if self._popen and self._popen.poll() is None:
            self._popen.terminate()
            await asyncio.to_thread(self._popen.wait)
