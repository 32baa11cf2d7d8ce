# SPDX-License-Identifier: Apache-2.0
"""A hub with a real warehouse, and assistants that reach it over both transports."""

import asyncio
import sys

import pytest

try:
    import mcp  # noqa: F401
except ImportError:
    collect_ignore_glob = ["*"]
    MISSING = "the assistant's packages are missing: scripts/assistant tests"
else:
    MISSING = ""

NAME = "first"  # of the warehouse that all tests share


def pytest_terminal_summary(terminalreporter):
    """Says why nothing was tested."""
    if MISSING:
        terminalreporter.write_line(f"SKIPPED: {MISSING}")


@pytest.fixture(scope="session")
def hub(tmp_path_factory):
    """A hub whose clients read, and change with a token; a shift of 4 robots at work runs there."""
    from served_hub import ServedHub, until

    folder = tmp_path_factory.mktemp("hub")
    token = folder / "commands"
    token.write_text("commands-token")
    token.chmod(0o600)
    out = ServedHub(folder, "--assistant", sys.executable, "--commands-token-file", str(token))
    try:
        asked = {"name": NAME, "size": "small", "shift": True}
        assert out.ask("POST", "/api/v1/simulations", asked)[0] == 202
        row = out.wait_for(NAME, "RUNNING")
        assert row["state"] == "RUNNING", row
        for part in ("coordinator", "stations", "kpis", "figures"):
            path = f"/s/{NAME}/api/v1/{part}"
            until(lambda path=path: out.ask("GET", path)[0] == 200, f"there is no {path}")
        yield out
    finally:
        out.end()


@pytest.fixture
def talk(hub):
    """Returns what a conversation, a function of an Assistant, returns; over a transport."""
    from assistants import connected

    def run(conversation, transport="http", commands=True):
        async def main():
            async with connected(hub.url, transport, commands) as assistant:
                return await conversation(assistant)

        return asyncio.run(asyncio.wait_for(main(), 120))

    return run
