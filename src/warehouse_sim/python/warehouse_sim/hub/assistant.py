# SPDX-License-Identifier: Apache-2.0
"""The assistant's server, which answers at /mcp: it has a Python environment of its own."""

import asyncio
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from warehouse_sim.hub.process import free_port

MISSING = (
    "the assistant's packages are not installed: `make serve` installs them where PyPI is reachable"
)


class Assistant:
    """A process that ends with this program. Without `python` there is none."""

    def __init__(self, python: Path | None, hub: str, options: Sequence[str] = ()) -> None:
        self.address, self.reason = "", MISSING
        self._popen: subprocess.Popen | None = None
        if python and python.exists():
            port = free_port()
            module = [str(python), "-m", "warehouse_assistant", "--port", str(port), "--hub", hub]
            self._popen = subprocess.Popen(
                ["setpriv", "--pdeathsig", "TERM", *module, *options],
                stdin=subprocess.DEVNULL,
                stdout=sys.stderr,
                start_new_session=True,
            )
            self.address = f"http://127.0.0.1:{port}"

    def fault(self) -> str:
        """Returns why it can't answer; "" if it can."""
        if self._popen is None:
            return self.reason
        code = self._popen.poll()
        return "" if code is None else f"the assistant's server ended with exit code {code}"

    async def close(self) -> None:
        """Ends it."""
        if self._popen and self._popen.poll() is None:
            self._popen.terminate()
            await asyncio.to_thread(self._popen.wait)
