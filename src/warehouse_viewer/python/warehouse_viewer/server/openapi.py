# SPDX-License-Identifier: Apache-2.0
"""Words of OpenAPI for requests that are served without FastAPI, which describes its own."""

from typing import Any

Json = dict[str, Any]

TEXT: Json = {"type": "string"}
NUMBER: Json = {"type": "number"}
WHOLE: Json = {"type": "integer"}
TRUTH: Json = {"type": "boolean"}


def object_of(description: str, **properties: Json) -> Json:
    """Returns the schema of an object."""
    return {"type": "object", "description": description, "properties": properties}


def list_of(item: Json) -> Json:
    """Returns the schema of a list."""
    return {"type": "array", "items": item}


def reference(name: str) -> Json:
    """Returns a reference to a schema by its name."""
    return {"$ref": f"#/components/schemas/{name}"}


def asked(optional: tuple[str, ...] = (), **properties: Json) -> Json:
    """Returns the schema of a request's body, which needs all fields but the optional ones."""
    required = [name for name in properties if name not in optional]
    return {"type": "object", "properties": properties, "required": required}


def in_path(name: str) -> Json:
    """Returns a parameter that is part of the path."""
    return {"name": name, "in": "path", "required": True, "schema": TEXT}


def in_query(name: str, schema: Json, description: str) -> Json:
    """Returns a parameter behind the path, which may be left out."""
    return {"name": name, "in": "query", "schema": schema, "description": description}


class Requests:
    """The requests about one subject.

    refusal: the schema of their refusals; refused: what the codes of these mean. Those in `wrong`
    are of requests with a body alone.
    """

    def __init__(
        self, tag: str, refusal: str, refused: dict[str, str], wrong: tuple[str, ...] = ("422",)
    ) -> None:
        self._tag, self._refused, self._wrong = tag, refused, wrong
        self._refusal = {"application/json": {"schema": reference(refusal)}}

    def request(
        self,
        summary: str,
        answer: Json,
        body: Json | None = None,
        parameters: tuple[Json, ...] = (),
        code: str = "200",
        media_type: str = "application/json",
    ) -> Json:
        """Returns a request, with what it answers by `code`."""
        content = {media_type: {"schema": answer}}
        answers = {code: {"description": "Answer", "content": content}}
        out: Json = {"summary": summary, "tags": [self._tag], "parameters": [*parameters]}
        if body:
            out["requestBody"] = {
                "required": bool(body.get("required")),
                "content": {"application/json": {"schema": body}},
            }
        for refused, meaning in self._refused.items():
            if body or refused not in self._wrong:
                answers[refused] = {"description": meaning, "content": self._refusal}
        return out | {"responses": answers}
