# SPDX-License-Identifier: Apache-2.0
"""The HTTP API, from its OpenAPI description."""

from functools import cache
from typing import Any

from reference.markdown import code, page, prose, table


@cache
def described() -> dict[str, Any]:
    """Returns the OpenAPI description that a viewer serves."""
    from fastapi import FastAPI

    from warehouse_viewer.api import description, routes

    app = FastAPI(title="Kiva warehouse", version="1", docs_url=None, redoc_url=None)
    app.include_router(routes.router)
    return description.described(app)


def written() -> str:
    """Returns the page of a warehouse's requests, WebSockets and what they carry."""
    return page_of(
        described(),
        "HTTP",
        "A running viewer has the same at `/api/docs`, where each request can be tried, and at "
        "`/api/v1/openapi.json` for programs. `GET /metrics` is for Prometheus. Units"
        " are SI, angles "
        "radians, the frame is `world`. Beyond this machine each request brings the "
        "viewer's token: "
        "`Authorization: Bearer …`.",
    )


def written_of_hub() -> str:
    """Returns the page of the hub's requests."""
    from warehouse_sim.hub.api import description

    return page_of(
        description.described(),
        "HTTP of the hub",
        "[The hub](../how-to/hub.md) has the same at `/api/docs` and `/api/v1/openapi.json`. Each"
        " warehouse has [an API of its own](http.md) beneath `/s/NAME/`. Units are SI, angles"
        " radians.",
    )


def page_of(api: dict[str, Any], title: str, about: str) -> str:
    """Returns the page of an OpenAPI description."""
    requests = [
        section(path, method, operation)
        for path, methods in api["paths"].items()
        for method, operation in methods.items()
    ]
    sockets = [socket(path, about) for path, about in api.get("x-websockets", {}).items()]
    schemas = [schema(name, about) for name, about in sorted(api["components"]["schemas"].items())]
    return page(
        title,
        about,
        "## Requests",
        *requests,
        *(["## WebSockets", *sockets] if sockets else []),
        "## Objects",
        *schemas,
    )


def section(path: str, method: str, operation: dict[str, Any]) -> str:
    """Returns a request: what it does, what it takes, what it answers."""
    parts = [
        f"### {method.upper()} {path}",
        prose(operation.get("description") or operation.get("summary", "")),
    ]
    rows = [
        (
            code(parameter["name"]),
            parameter["in"],
            kind(parameter.get("schema", {})),
            prose(parameter.get("description", "")),
        )
        for parameter in operation.get("parameters", [])
    ]
    if rows:
        parts.append(table(["parameter", "in", "type", ""], rows))
    for media, body in operation.get("requestBody", {}).get("content", {}).items():
        parts.append(f"Body ({code(media)}): {kind(body.get('schema', {}))}")
    answers = [
        (
            status,
            prose(response.get("description", "")),
            ", ".join(kind(c.get("schema", {})) for c in response.get("content", {}).values()),
        )
        for status, response in operation.get("responses", {}).items()
    ]
    return "\n\n".join([*parts, table(["status", "", "answer"], answers)])


def socket(path: str, about: dict[str, Any]) -> str:
    """Returns a WebSocket."""
    rows = [
        (
            code(parameter["name"]),
            prose(parameter.get("description", "")),
            ", ".join(map(str, parameter.get("enum", []))),
        )
        for parameter in about["parameters"]
    ]
    sent = ", ".join(kind(parameter) for parameter in about.get("messages", []))
    parts = [
        f"### {path}",
        prose(" ".join(about["description"].split())),
        table(["parameter", "", "values"], rows),
    ]
    return "\n\n".join([*parts, f"Messages: {sent}" if sent else ""])


def schema(name: str, about: dict[str, Any]) -> str:
    """Returns an object's fields."""
    needed = about.get("required", [])
    rows = [
        (
            code(field),
            kind(description),
            "yes" if field in needed else "",
            limits(description),
            prose(description.get("description", "")),
        )
        for field, description in about.get("properties", {}).items()
    ]
    text = table(["field", "type", "required", "limits", ""], rows) if rows else kind(about)
    return "\n\n".join([f"### {name}", prose(about.get("description", "")), text])


def kind(about: dict[str, Any]) -> str:
    """Returns a schema's type in words."""
    if "$ref" in about:
        name = about["$ref"].rsplit("/", 1)[-1]
        return f"[{name}](#{name.lower()})"
    for key in ("anyOf", "allOf", "oneOf"):
        if key in about:
            return " or ".join(kind(value) for value in about[key])
    if "enum" in about or "const" in about:
        return ", ".join(code(value) for value in about.get("enum", [about.get("const")]))
    if about.get("type") == "array":
        return f"list of {kind(about.get('items', {}))}"
    return str(about.get("type", "any"))


def limits(about: dict[str, Any]) -> str:
    """Returns what a value has to fulfil, and its default."""
    words = {
        "minimum": "≥",
        "maximum": "≤",
        "exclusiveMinimum": ">",
        "exclusiveMaximum": "<",
        "minLength": "length ≥",
        "maxLength": "length ≤",
        "maxItems": "items ≤",
        "default": "default",
    }
    return ", ".join(f"{word} {about[key]}" for key, word in words.items() if key in about)
