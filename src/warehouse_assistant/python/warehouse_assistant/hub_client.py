# SPDX-License-Identifier: Apache-2.0
"""The hub's HTTP API, and the API of each simulation beneath it.

Errors are Troubles, whose texts say what to do next.
"""

import asyncio
import re
from typing import Any
from urllib.parse import quote

import httpx2
from mcp.server.mcpserver.exceptions import ToolError

from warehouse_assistant.words import listed, plain, quoted, sentence

SIMULATIONS = "/api/v1/simulations"
JOURNAL = "/api/v1/journal"
OWN = {"x-warehouse-assistant": "1"}  # the hub leaves it to us to write down what these requests do
NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,39}")
PATIENCE = 40.0  # until an answer [s, wall]: commands to robots end within 30
ATTEMPTS, PAUSE = 4, 1.0  # where the hub limits requests; [s, wall]
MOST_ANSWER = 32 << 20  # [bytes]
ANSWERING = ("RUNNING", "PAUSED", "STARTING")

NEXT = {
    401: "Give the hub's token: start the assistant with WAREHOUSE_TOKEN set.",
    403: "Use the hub under the name that it listens at.",
    413: "Send less at once.",
    429: "Wait a few seconds, then ask again.",
    502: "Ask list_simulations whether it still runs.",
    503: "Ask list_simulations whether it runs; one that starts needs some seconds.",
}


class Trouble(ToolError):  # noqa: N818 (an answer)
    """Raised where a tool could not do its task; says why, and what to do next."""


class Refused(Trouble):
    """Raised for an error of the hub or of a simulation; `status` is HTTP's."""

    def __init__(self, status: int, text: str) -> None:
        super().__init__(text)
        self.status = status


class HubClient:
    """Requests to a hub at an address such as http://localhost:8080."""

    def __init__(self, address: str, token: str = "") -> None:
        self.address = address.rstrip("/")
        headers = OWN | ({"authorization": f"Bearer {token}"} if token else {})
        limits = httpx2.Limits(max_connections=40, max_keepalive_connections=10)
        self._client = httpx2.AsyncClient(
            base_url=self.address,
            headers=headers,
            timeout=PATIENCE,
            limits=limits,
            trust_env=False,
        )

    async def close(self) -> None:
        """Closes its connections."""
        await self._client.aclose()

    async def get(self, path: str, **query: Any) -> Any:
        """Returns the JSON at a path. Raises Trouble."""
        return (await self._asked("GET", path, params=query)).json()

    async def text(self, path: str) -> str:
        """Returns the text at a path. Raises Trouble."""
        return (await self._asked("GET", path)).text

    async def send(self, method: str, path: str, body: Any = None, **query: Any) -> Any:
        """Sends a body as JSON; returns the answer's JSON. Raises Trouble."""
        return (await self._asked(method, path, json=body, params=query)).json()

    async def _asked(self, method: str, path: str, **options: Any) -> httpx2.Response:
        for attempt in range(ATTEMPTS):
            try:
                answer = await self._client.request(method, path, **options)
            except httpx2.TimeoutException as error:
                raise Trouble(
                    f"There was no answer within {PATIENCE:g} s. Ask list_simulations what runs."
                ) from error
            except httpx2.HTTPError as error:
                raise Trouble(
                    f"No hub answers at {plain(self.address)}. Start one (make serve, or rosrun"
                    " warehouse_sim hub), or give its address with --hub."
                ) from error
            if answer.status_code != 429 or attempt == ATTEMPTS - 1:
                break
            await asyncio.sleep(PAUSE)
        if answer.status_code >= 400:
            raise Refused(answer.status_code, _reason(answer))
        if len(answer.content) > MOST_ANSWER:
            raise Trouble("The answer is too long. Ask for less of it.")
        return answer

    async def simulation(self, name: str = "") -> "Simulation":
        """Returns the simulation of a name; "": the only one that runs. Raises Trouble."""
        if name:
            if not NAME.fullmatch(name):
                raise Trouble(f"{quoted(name)} is no simulation's name. Ask list_simulations.")
            return Simulation(self, name)
        rows = (await self.get(SIMULATIONS))["simulations"]
        names = [row["name"] for row in rows if row["state"] in ANSWERING]
        if len(names) == 1:
            return Simulation(self, names[0])
        if not names:
            raise Trouble("No simulation runs. Start one with start_simulation.")
        which = listed(map(quoted, names))
        raise Trouble(f"Several simulations run: {which}. Say which by `simulation`.")


class Simulation:
    """Requests to the API of one simulation: paths beneath /s/NAME/api/v1/."""

    def __init__(self, hub: HubClient, name: str) -> None:
        self._hub, self.name = hub, name
        self._prefix = f"/s/{name}/api/v1"

    async def get(self, path: str, **query: Any) -> Any:
        """Returns the JSON at a path. Raises Trouble."""
        return await self._hub.get(f"{self._prefix}/{path}", **query)

    async def get_or_none(self, path: str, **query: Any) -> Any:
        """Returns the JSON at a path; None if the warehouse lacks it, as without a shift."""
        try:
            return await self.get(path, **query)
        except Refused as refusal:
            if refusal.status in (404, 409, 503):
                return None
            raise

    async def send(self, method: str, path: str, body: Any = None, **query: Any) -> Any:
        """Sends a body as JSON; returns the answer's JSON. Raises Trouble."""
        return await self._hub.send(method, f"{self._prefix}/{path}", body, **query)


def segment(text: str) -> str:
    """Returns a text as a part of a path."""
    return quote(text, safe="")


def _reason(answer: httpx2.Response) -> str:
    """Returns the reason of an error, and what to do next."""
    try:
        detail = answer.json()["detail"]
    except (ValueError, KeyError, TypeError):
        detail = f"HTTP status {answer.status_code}"
    if isinstance(detail, list):
        detail = "; ".join(f"{_field(fault)}: {fault.get('msg')}" for fault in detail[:5])
    text = sentence(f"Refused: {quoted(detail, 600)}")
    if answer.status_code == 404:
        return f"{text} Ask list_simulations for simulations, find for what stands in one."
    if answer.status_code in (400, 409, 422):
        return f"{text} Correct what it names, then call again."
    return f"{text} {NEXT.get(answer.status_code, 'Ask simulation_log for the cause.')}"


def _field(fault: dict[str, Any]) -> str:
    return ".".join(str(part) for part in fault.get("loc", ()) if part not in ("body", "query"))
