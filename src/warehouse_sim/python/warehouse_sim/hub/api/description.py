# SPDX-License-Identifier: Apache-2.0
"""The hub's API in words of OpenAPI. What-if stands in it; what is beneath /s/NAME/ has its own
description there."""

from typing import Any

from warehouse_sim.hub.journal import KEPT, KINDS
from warehouse_sim.hub.simulation import State
from warehouse_viewer.server.openapi import (
    NUMBER,
    TEXT,
    TRUTH,
    WHOLE,
    Json,
    Requests,
    asked,
    in_path,
    in_query,
    list_of,
    object_of,
    reference,
)

OPENAPI = "/api/v1/openapi.json"
ROW, WORLD, RECORDING, ENTRY, ARGUMENT, FAULT, SIZING = (
    "Simulation",
    "World",
    "Recording",
    "JournalEntry",
    "Argument",
    "Fault",
    "Sizing",
)
REFUSED = {
    "404": "There is no such thing",
    "409": "It conflicts with what there is",
    "422": "The request is wrong",
    "503": "It can't be done now",
}


SCHEMAS: Json = {
    FAULT: object_of(
        "Why a request is refused.",
        detail=TEXT,
        field=TEXT | {"description": "with 422: what is wrong"},
        reason=TEXT | {"description": "with 422: what was expected"},
        nearest=TEXT | {"description": "with 422: the nearest right value; may be empty"},
    ),
    ROW: object_of(
        "A warehouse that runs, has run, or shows itself in the hub.",
        name=TEXT,
        state=TEXT | {"enum": [state.value for state in State]},
        arguments=object_of("What it was started with, as texts."),
        world=TEXT,
        robots=WHOLE,
        storage_units=WHOLE,
        items=WHOLE,
        rtf=NUMBER | {"description": "simulated over wall time"},
        orders=object_of(
            "Those of a shift; empty without.", waiting=WHOLE, at_stations=WHOLE, completed=WHOLE
        ),
        uptime_s=NUMBER | {"description": "[s, wall]"},
        url=TEXT | {"description": "of its pages and its API, at this server"},
        reason=TEXT | {"description": "why it ended without a request"},
    ),
    ARGUMENT: object_of(
        "An argument of a launch file.",
        name=TEXT,
        documentation=TEXT,
        default=TEXT,
        choices=list_of(TEXT) | {"description": "empty: any text that fits"},
        files=list_of(TEXT) | {"description": "launch files that take it"},
    ),
    WORLD: object_of(
        "A world file.",
        name=TEXT,
        saved=TRUTH | {"description": "under this name here; others come with the warehouse"},
        bytes=WHOLE,
        time=WHOLE | {"description": "when it was saved [s since 1970]"},
    ),
    RECORDING: object_of(
        "What a warehouse has done, to be played.",
        name=TEXT,
        kind=TEXT | {"enum": ["example", "simulation", "file"]},
        url=TEXT | {"description": "of its page; empty where it can't be played"},
        seconds=NUMBER,
        bytes=WHOLE,
        time=WHOLE | {"description": "when it was written [s since 1970]"},
        reason=TEXT | {"description": "why it is cut or can't be played"},
    ),
    ENTRY: object_of(
        "What was changed by whom.",
        id=WHOLE,
        wall=TEXT | {"description": "local time with its offset, ISO 8601"},
        kind=TEXT | {"enum": [*KINDS]},
        who=TEXT,
        action=TEXT,
        simulation=TEXT,
        arguments=TEXT,
        outcome=TEXT,
        done=TRUTH,
    ),
}

SCHEMAS[SIZING] = object_of(
    "How many robots and stations a warehouse needs for a rate of orders.",
    id=WHOLE,
    state=TEXT
    | {
        "enum": ["RUNNING", "DONE", "IMPOSSIBLE", "FAILED", "STOPPED"],
        "description": "IMPOSSIBLE: no number of robots and stations suffices",
    },
    question=object_of(
        "What was asked.",
        layout=TEXT,
        orders_per_hour=NUMBER,
        late=NUMBER,
        hours=NUMBER,
        realism=TEXT,
    ),
    seconds=NUMBER | {"description": "since it began, while it runs [s, wall]"},
    progress=TEXT | {"description": "the last shift, while it runs"},
    answer=TEXT | {"description": "the answer in sentences, or why the sizing failed"},
    url=TEXT | {"description": "of its report; empty before there is one"},
)

_request = Requests("hub", FAULT, REFUSED).request
NAME, NUMBERED = (in_path("name"),), (in_path("number"),)
SAVED = TEXT | {"description": "its name: small letters, digits and '-'"}
REPLACE = TRUTH | {"description": "a saved world of that name", "default": False}
CREATE = asked(
    ("shift", "empty"),
    name=TEXT | {"description": "small letters, digits and '-'"},
    shift=TRUTH | {"description": "with orders and stock (operations.launch)"},
    empty=TRUTH | {"description": "a world without anything (empty_world.launch)"},
) | {
    "additionalProperties": {"anyOf": [TEXT, NUMBER, TRUTH]},
    "description": "any argument of the launch file, by its name; see simulation-arguments",
}

PATHS: Json = {
    "/api/v1/simulations": {
        "get": _request(
            "All warehouses, running ones first.",
            object_of("All.", simulations=list_of(reference(ROW))),
        ),
        "post": _request("Starts a warehouse.", reference(ROW), CREATE, code="202"),
    },
    "/api/v1/simulation-arguments": {
        "get": _request(
            "What can be asked for when a warehouse is started.",
            object_of("All.", worlds=list_of(TEXT), arguments=list_of(reference(ARGUMENT))),
        )
    },
    "/api/v1/simulations/{name}": {
        "get": _request("A warehouse.", reference(ROW), None, NAME),
        "put": _request(
            "Lists a warehouse that was launched elsewhere on this machine.",
            reference(ROW),
            asked(address=TEXT | {"description": "of its pages, http://localhost:PORT"}),
            NAME,
            code="201",
        ),
        "delete": _request(
            "Ends a warehouse; its log and recording stay.",
            reference(ROW),
            None,
            (*NAME, in_query("forget", TRUTH, "deletes its files, too")),
        ),
    },
    "/api/v1/simulations/{name}/start": {
        "post": _request("Starts one that has ended.", reference(ROW), None, NAME, code="202")
    },
    "/api/v1/simulations/{name}/restart": {
        "post": _request("Ends it and starts it again.", reference(ROW), None, NAME, code="202")
    },
    "/api/v1/simulations/{name}/worlds": {
        "post": _request(
            "Adds the models of a world, all or none; 409 names what stands in the way.",
            object_of("What was added.", message=TEXT),
            asked(
                ("x", "y", "yaw"),
                world=TEXT | {"description": "the name, the path or the text of an SDF world"},
                x=NUMBER | {"default": 0},
                y=NUMBER | {"default": 0},
                yaw=NUMBER | {"default": 0, "description": "[rad]"},
            ),
            NAME,
            code="201",
        )
    },
    "/api/v1/simulations/{name}/save": {
        "post": _request(
            "Saves the world that runs under a name.",
            object_of("What was saved.", world=TEXT, path=TEXT, message=TEXT),
            asked(("replace",), world=SAVED, replace=REPLACE),
            NAME,
            code="201",
        )
    },
    "/api/v1/simulations/{name}/recording": {
        "post": _request(
            "Keeps the last hour as a recording.",
            object_of("The recording.", url=TEXT, bytes=WHOLE),
            None,
            NAME,
            code="201",
        )
    },
    "/api/v1/simulations/{name}/log": {
        "get": _request(
            "The log.",
            TEXT,
            None,
            (*NAME, in_query("follow", TRUTH, "goes on until the warehouse ends")),
            media_type="text/plain",
        )
    },
    "/api/v1/worlds": {
        "get": _request(
            "All worlds, saved ones first.", object_of("All.", worlds=list_of(reference(WORLD)))
        )
    },
    "/api/v1/worlds/{name}": {
        "get": _request("The SDF of a world.", TEXT, None, NAME, media_type="application/xml"),
        "put": _request(
            "Saves an SDF text under a name.",
            object_of("The world.", world=TEXT),
            asked(("replace",), text=TEXT, replace=REPLACE),
            NAME,
            code="201",
        ),
        "delete": _request(
            "Deletes a saved world.", object_of("The world.", world=TEXT), None, NAME
        ),
    },
    "/api/v1/recordings": {
        "get": _request(
            "All recordings.", object_of("All.", recordings=list_of(reference(RECORDING)))
        )
    },
    "/api/v1/sizings": {
        "get": _request(
            "All sizings, the newest first.", object_of("All.", sizings=list_of(reference(SIZING)))
        ),
        "post": _request(
            "Finds the fewest robots and picking stations for a rate of orders, by simulating"
            " shifts of ideal robots; `size` or `layout` is needed. One runs at a time.",
            reference(SIZING),
            asked(
                ("size", "layout", "late", "hours", "realism"),
                size=TEXT | {"description": "a preset"},
                layout=TEXT | {"description": "a layout file, or its text"},
                orders_per_hour=NUMBER,
                late=NUMBER | {"default": 0.01, "description": "share of orders that may be"},
                hours=NUMBER | {"default": 8, "maximum": 24, "description": "of a shift"},
                realism=TEXT | {"description": "batteries and failures: typical, bad_day"},
            ),
            code="202",
        ),
    },
    "/api/v1/sizings/{number}": {
        "get": _request("A sizing.", reference(SIZING), None, NUMBERED),
        "delete": _request("Ends a sizing, and deletes it.", reference(SIZING), None, NUMBERED),
    },
    "/api/v1/sizings/{number}/report.html": {
        "get": _request("Its report.", TEXT, None, NUMBERED, media_type="text/html")
    },
    "/api/v1/journal": {
        "get": _request(
            "The newest entries, oldest first.",
            object_of("Entries.", entries=list_of(reference(ENTRY))),
            None,
            (
                in_query("since", WHOLE, "an id; only later ones"),
                in_query("simulation", TEXT, "only its entries"),
                in_query("limit", WHOLE | {"maximum": KEPT, "default": 200}, "of their number"),
            ),
        ),
        "post": _request(
            "Notes what an assistant did.",
            reference(ENTRY),
            asked(
                ("simulation", "arguments", "outcome", "done"),
                who=TEXT,
                action=TEXT,
                simulation=TEXT,
                arguments={"description": "any JSON; its beginning is kept"},
                outcome=TEXT,
                done=TRUTH | {"default": True},
            ),
            code="201",
        ),
    },
}


def described() -> dict[str, Any]:
    """Returns the OpenAPI description of a hub, with what-if, whose modules it loads."""
    from warehouse_viewer.whatif import description as whatif

    return {
        "openapi": "3.0.3",
        "info": {
            "title": "Kiva warehouses",
            "version": "1",
            "description": "Starts, lists and ends warehouses. Each has pages and an API of its"
            " own beneath /s/NAME/, described at /s/NAME/api/v1/openapi.json; a digital assistant"
            " connects at /mcp. Beyond this machine each request brings the token:"
            " Authorization: Bearer …",
        },
        "paths": PATHS | whatif.PATHS,
        "components": {"schemas": SCHEMAS | whatif.SCHEMAS},
    }
