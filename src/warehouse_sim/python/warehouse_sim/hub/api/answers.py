# SPDX-License-Identifier: Apache-2.0
"""What the routes of the hub's API have in common: bodies, errors, and the journal."""

import asyncio
import json
from collections.abc import Awaitable, Callable, Mapping
from typing import Any, TypeVar

from starlette.requests import Request
from starlette.responses import Response

from warehouse_sim.hub.insertion import InTheWay
from warehouse_sim.hub.journal import Journal
from warehouse_sim.hub.simulations import Conflict, Missing
from warehouse_sim.hub.wish import WishError
from warehouse_sim.hub.worlds import Taken, UnknownWorld
from warehouse_viewer.json_text import JSONResponse

T = TypeVar("T")
Endpoint = Callable[[Request], Awaitable[Response]]
BY_ASSISTANT = "x-warehouse-assistant"  # header of requests that an assistant writes down itself


def answered(action: Endpoint) -> Endpoint:
    """Returns an endpoint that answers errors with 404, 409, 422, 400 or 503."""

    async def endpoint(request: Request) -> Response:
        try:
            return await action(request)
        except (Missing, UnknownWorld) as error:
            return JSONResponse({"detail": error.args[0]}, 404)
        except (Conflict, InTheWay, Taken) as error:
            return JSONResponse({"detail": str(error)}, 409)
        except WishError as error:
            fault = {"field": error.field, "reason": error.reason, "nearest": error.nearest}
            return JSONResponse({"detail": str(error), **fault}, 422)
        except OSError as error:
            return JSONResponse({"detail": f"it can't be done: {error}"}, 503)

    return endpoint


class Book:
    """The journal, for requests that change something."""

    def __init__(self, journal: Journal) -> None:
        self._journal = journal

    async def written(
        self, request: Request, action: str, about: object, done: Awaitable[T], simulation: str = ""
    ) -> T:
        """Does what a person's request asks, and writes it down once it is done; an assistant's
        requests are written down by the assistant."""
        out = await done
        if BY_ASSISTANT not in request.headers:
            name = simulation or request.path_params.get("name", "")
            texts = {"who": person_of(request), "action": action, "arguments": about}
            texts |= {"simulation": name, "outcome": "done"}
            await asyncio.to_thread(self._journal.add, "person", texts, True)
        return out


def person_of(request: Request) -> str:
    """Returns who sends a request: a browser or the name of a program, and its address."""
    agent = request.headers.get("user-agent", "")
    program = "browser" if agent.startswith("Mozilla/") else agent.partition(" ")[0] or "a program"
    return f"{program} at {request.client.host if request.client else 'this machine'}"


async def body_of(request: Request) -> dict[str, Any]:
    """Returns a request's body, a JSON object. Raises WishError."""
    try:
        body = json.loads(await request.body() or b"{}")
    except (ValueError, RecursionError) as error:
        raise WishError("body", f"JSON was expected: {error}") from error
    if not isinstance(body, dict):
        raise WishError("body", "an object with a field for each argument was expected")
    return body


def shown(body: Mapping[str, Any]) -> dict[str, Any]:
    """Returns a request's body with the first line alone of texts, such as layouts."""
    return {
        k: v.strip().partition("\n")[0][:200] if isinstance(v, str) else v for k, v in body.items()
    }


def whole(name: str, text: str, most: int) -> int:
    """Returns the number of a query's text, 0 to `most`. Raises WishError."""
    if not text.isascii() or not text.isdigit() or len(text) > 16 or int(text) > most:
        raise WishError(name, f"a whole number from 0 to {most} was expected")
    return int(text)
