# SPDX-License-Identifier: Apache-2.0
"""The requests about searches for layouts, in words of OpenAPI: they are also served without the
API of a running warehouse."""

from typing import Any

from warehouse_viewer.whatif.design_settings import EXPECTED, DesignSettings

Json = dict[str, Any]

TEXT: Json = {"type": "string"}
NUMBER: Json = {"type": "number"}
SETTINGS, DESIGN, REFUSAL = "DesignSettings", "Design", "DesignRefusal"


def _object(description: str, **properties: Json) -> Json:
    return {"type": "object", "description": description, "properties": properties}


def _reference(name: str) -> Json:
    return {"$ref": f"#/components/schemas/{name}"}


def _settings() -> Json:
    """Returns the schema of a search's settings, with defaults and what is expected."""
    kinds = {str: "string", float: "number", int: "integer"}
    fields = {
        name: {
            "type": kinds[type(value)],
            "default": value,
            "description": EXPECTED[name][1].rstrip(","),
        }
        for name, value in DesignSettings().to_json().items()
    }
    return _object("A search for the layout of a building that serves a day.", **fields)


SCHEMAS: Json = {
    SETTINGS: _settings(),
    REFUSAL: _object(
        "Why a request is refused.",
        detail=TEXT,
        field=TEXT | {"description": "the setting that is wrong, `name` or `costs`; may be empty"},
    ),
    DESIGN: _object(
        "A search: its progress while it runs, its front once it is over.",
        name=TEXT,
        settings=_reference(SETTINGS),
        state=TEXT
        | {"enum": ["none", "waits", "runs", "done", "cancelled", "cut", "failed", "wrong"]},
        share=NUMBER | {"description": "of the search that is over, while it runs"},
        stage=TEXT | {"description": "of the search, with its trials and shifts, while it runs"},
        left=NUMBER | {"description": "until it is over, about [s]"},
        error=TEXT,
        answer={
            "type": "object",
            "nullable": True,
            "properties": {"text": TEXT, "why": TEXT, "effort": TEXT},
            "description": "what was found, in sentences; why nothing was; what it took",
        },
        front={
            "type": "array",
            "items": {"type": "object", "properties": {"layout": TEXT, "to_buy": NUMBER}},
            "description": "layouts that no other beats in price and in cost a piece: `layout`,"
            " `to_buy`, `a_piece`, `late` [%], `robots`, `stations`, `replenishing`, `units`,"
            " `contacts`, and on days that the search did not see `unseen_a_piece` and"
            " `unseen_late` with the halves of their intervals",
        },
    ),
}

NAME: Json = {"name": "name", "in": "path", "required": True, "schema": TEXT}
LAYOUT: Json = {"name": "layout", "in": "path", "required": True, "schema": TEXT}
NAMED = _object("The search.", name=TEXT)


def _request(
    summary: str,
    answer: Json,
    body: Json | None = None,
    parameters: tuple[Json, ...] = (),
    media_type: str = "application/json",
) -> Json:
    refusal = {"application/json": {"schema": _reference(REFUSAL)}}
    answers = {
        "200": {"description": "Answer", "content": {media_type: {"schema": answer}}},
        "409": {"description": "Refused", "content": refusal},
    }
    out: Json = {"summary": summary, "tags": ["designs"], "parameters": [*parameters]}
    if body:
        answers["422"] = {"description": "The request is wrong", "content": refusal}
        out["requestBody"] = {"required": True, "content": {"application/json": {"schema": body}}}
    return out | {"responses": answers}


def _asked(**properties: Json) -> Json:
    return {"type": "object", "properties": properties, "required": [*properties]}


PATHS: Json = {
    "/whatif/designs": {
        "get": _request(
            "All searches, with their progress and their fronts.",
            _object("All.", designs={"type": "array", "items": _reference(DESIGN)}),
        ),
        "post": _request(
            "Makes a search with the costs that the folder has now; /run begins it.",
            NAMED,
            _asked(name=TEXT, settings=_reference(SETTINGS)),
        ),
    },
    "/whatif/designs/estimate": {
        "post": _request(
            "How long a search takes of a core, about [s], and on how many it runs.",
            _object("Estimate.", seconds=NUMBER, processes={"type": "integer"}),
            _asked(settings=_reference(SETTINGS)),
        )
    },
    "/whatif/designs/{name}": {
        "delete": _request("Deletes a search with all that it found.", NAMED, None, (NAME,))
    },
    "/whatif/designs/{name}/run": {
        "post": _request(
            "Begins a search, or goes on where it ended; refused without Optuna.",
            _object("Searches that were put into the queue: 0 where it is over.", runs=NUMBER),
            None,
            (NAME,),
        ),
        "delete": _request("Ends a search; it can go on.", NAMED, None, (NAME,)),
    },
    "/whatif/designs/{name}/report.html": {
        "get": _request("The report of a search that is over.", TEXT, None, (NAME,), "text/html")
    },
    "/whatif/designs/{name}/layouts/{layout}": {
        "get": _request("A layout of the front.", TEXT, None, (NAME, LAYOUT), "text/yaml")
    },
    "/whatif/designs/{name}/layouts/{layout}/plan.svg": {
        "get": _request("Its plan.", TEXT, None, (NAME, LAYOUT), "image/svg+xml")
    },
}
