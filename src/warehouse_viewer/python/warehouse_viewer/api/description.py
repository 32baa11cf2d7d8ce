# SPDX-License-Identifier: Apache-2.0
"""The API's description: with its WebSockets as `x-websockets`, for which OpenAPI has no words, and
with the requests of what-if."""

from inspect import getdoc
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from warehouse_viewer.api import changes, stream
from warehouse_viewer.api.schemas.pydantic_versions import schemas_of
from warehouse_viewer.whatif import description as whatif

REFERENCE = "#/components/schemas/"
RATE = {"name": "rate", "default": 2, "description": "messages of a kind a second, 0.1 to 10"}


def described(app: FastAPI) -> dict[str, Any]:
    """Returns the OpenAPI description of an application, which is made once."""
    if app.openapi_schema is None:
        about = {name: getattr(app, name) for name in ("title", "version", "description", "routes")}
        out = get_openapi(**about)
        messages = schemas_of(changes.MESSAGES, REFERENCE)
        kinds = out.setdefault("components", {}).setdefault("schemas", {})
        kinds.update((name, kind) for name, kind in messages.items() if name not in kinds)
        kinds.update(whatif.SCHEMAS)
        out["paths"].update(whatif.PATHS)
        out["x-websockets"] = {
            "/api/v1/changes": {
                "description": getdoc(changes),
                "parameters": [
                    {"name": "of", "enum": changes.TOPICS, "description": "with commas between"},
                    RATE,
                ],
                "messages": [{"$ref": REFERENCE + kind.__name__} for kind in changes.MESSAGES],
            },
            "/api/v1/stream": {"description": getdoc(stream), "parameters": [RATE]},
        }
        app.openapi_schema = out
    return app.openapi_schema
