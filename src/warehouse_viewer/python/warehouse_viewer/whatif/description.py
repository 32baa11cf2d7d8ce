# SPDX-License-Identifier: Apache-2.0
"""The requests of what-if in words of OpenAPI: they are also served without the API of a running
warehouse."""

from warehouse_operations.policies import ROLES
from warehouse_viewer.server.openapi import (
    NUMBER,
    TEXT,
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
from warehouse_viewer.whatif.design_settings import EXPECTED as OF_DESIGNS
from warehouse_viewer.whatif.design_settings import DesignSettings
from warehouse_viewer.whatif.scenario import EXPECTED as OF_SCENARIOS
from warehouse_viewer.whatif.scenario import Scenario

SETTINGS, DESIGN, REFUSAL = "DesignSettings", "Design", "WhatIfRefusal"
CHOICES, SCENARIO = "ScenarioSettings", "Scenario"
REFUSED = {"409": "Refused", "422": "The request is wrong"}
STATES = ["none", "waits", "runs", "done", "cancelled", "cut", "failed", "wrong"]


def _fields(defaults: Json, expected: Json) -> Json:
    """Returns the schemas of settings, with their defaults and what is expected."""
    kinds = {
        str: "string",
        bool: "boolean",
        float: "number",
        int: "integer",
        dict: "object",
        list: "array",
    }
    return {
        name: {
            "type": kinds[type(value)],
            "default": value,
            "description": expected[name][1].rstrip(","),
        }
        for name, value in defaults.items()
    }


SCHEMAS: Json = {
    REFUSAL: object_of(
        "Why a request is refused.",
        detail=TEXT,
        field=TEXT | {"description": "the setting that is wrong, `name` or `costs`; may be absent"},
    ),
    CHOICES: object_of(
        f"A shift to simulate, and how often. Policies are of {', '.join(ROLES)}.",
        **_fields(Scenario().to_json(), OF_SCENARIOS),
    ),
    SCENARIO: object_of(
        "A scenario with its runs, one for each seed, and what they showed.",
        name=TEXT,
        settings=reference(CHOICES),
        site=object_of("The warehouse.", name=TEXT, robots=WHOLE, stations=WHOLE),
        state=TEXT | {"enum": [*STATES, "part"]},
        left=NUMBER | {"description": "until all runs are over, about [s of a process]"},
        runs=list_of(
            object_of("A run.", seed=WHOLE, state=TEXT, share=NUMBER, took=NUMBER, text=TEXT)
        ),
        summary={
            "type": "object",
            "nullable": True,
            "properties": {"warm_up": NUMBER, "limit": {"type": "object"}},
            "description": "`figures` by name, each with `mean`, `half` (of the 95 % interval, none"
            " with fewer than three runs) and `count`; `limit`, what holds the warehouse back;"
            " `warm_up`, the minutes that are left out",
        },
        error=TEXT,
    ),
    SETTINGS: object_of(
        "A search for the layout of a building that serves a day.",
        **_fields(DesignSettings().to_json(), OF_DESIGNS),
    ),
    DESIGN: object_of(
        "A search: its progress while it runs, its front once it is over.",
        name=TEXT,
        settings=reference(SETTINGS),
        state=TEXT | {"enum": STATES},
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

NAME, LAYOUT = in_path("name"), in_path("layout")
NAMES = in_query("name", list_of(TEXT), "of a scenario; once for each of 2 to 6")
NAMED = object_of("What was made, changed or ended.", name=TEXT)
RUNS = object_of("Runs that were put into the queue; 0 where all are over.", runs=WHOLE)
FILE = asked(name=TEXT, text=TEXT)

about = Requests("what-if", REFUSAL, REFUSED).request
designs = Requests("designs", REFUSAL, REFUSED).request

PATHS: Json = {
    "/whatif/about": {
        "get": about(
            "What scenarios and searches can choose: presets, files, policies, limits, defaults.",
            object_of("Choices, each a list or an object."),
        )
    },
    "/whatif/scenarios": {
        "get": about(
            "All scenarios and searches, with their progress and results.",
            object_of(
                "All.",
                scenarios=list_of(reference(SCENARIO)),
                designs=list_of(reference(DESIGN)),
                running=WHOLE,
                waiting=WHOLE,
                left=NUMBER | {"description": "until the queue is empty, about [s, wall]"},
            ),
        ),
        "post": about(
            "Makes a scenario; /run simulates it.",
            NAMED,
            asked(name=TEXT, settings=reference(CHOICES)),
        ),
    },
    "/whatif/estimate": {
        "post": about(
            "How long a scenario takes on this machine, about [s, wall], and its warehouse.",
            object_of("Estimate.", seconds=NUMBER, robots=WHOLE, stations=WHOLE),
            asked(settings=reference(CHOICES)),
        )
    },
    "/whatif/layouts": {"post": about("Keeps a layout file for scenarios.", NAMED, FILE)},
    "/whatif/stock": {"post": about("Keeps the stock file of a layout.", NAMED, FILE)},
    "/whatif/orders": {
        "post": about("Keeps orders (.csv) or a description of demand.", NAMED, FILE)
    },
    "/whatif/costs": {
        "post": about("Keeps the costs of all scenarios and searches.", NAMED, FILE),
        "delete": about("Leaves costs out of comparisons again.", object_of("Nothing.")),
    },
    "/whatif/scenarios/{name}": {
        "put": about(
            "Changes a scenario; runs that are of another one then are removed.",
            NAMED,
            asked(settings=reference(CHOICES)),
            (NAME,),
        ),
        "delete": about("Deletes a scenario with its runs.", NAMED, None, (NAME,)),
    },
    "/whatif/scenarios/{name}/duplicate": {
        "post": about("Copies a scenario without its runs.", NAMED, None, (NAME,))
    },
    "/whatif/scenarios/{name}/rename": {
        "post": about("Gives a scenario another name.", NAMED, asked(to=TEXT), (NAME,))
    },
    "/whatif/scenarios/{name}/run": {
        "post": about("Simulates what a scenario lacks.", RUNS, None, (NAME,)),
        "delete": about("Ends its runs; complete ones stay.", NAMED, None, (NAME,)),
    },
    "/whatif/scenarios/{name}/seeds/{seed}/report.html": {
        "get": about(
            "The report of a run.", TEXT, None, (NAME, in_path("seed")), media_type="text/html"
        )
    },
    "/whatif/compare": {
        "get": about(
            "Scenarios side by side: figures, differences with their intervals, costs.",
            object_of("Columns and rows."),
            None,
            (NAMES,),
        )
    },
    "/whatif/report.html": {
        "get": about(
            "The report of all runs of scenarios.", TEXT, None, (NAMES,), media_type="text/html"
        )
    },
    "/whatif/designs": {
        "get": designs(
            "All searches, with their progress and their fronts.",
            object_of("All.", designs=list_of(reference(DESIGN))),
        ),
        "post": designs(
            "Makes a search with the costs that the folder has now; /run begins it.",
            NAMED,
            asked(name=TEXT, settings=reference(SETTINGS)),
        ),
    },
    "/whatif/designs/estimate": {
        "post": designs(
            "How long a search takes of a core, about [s], and on how many it runs.",
            object_of("Estimate.", seconds=NUMBER, processes=WHOLE),
            asked(settings=reference(SETTINGS)),
        )
    },
    "/whatif/designs/{name}": {
        "delete": designs("Deletes a search with all that it found.", NAMED, None, (NAME,))
    },
    "/whatif/designs/{name}/run": {
        "post": designs(
            "Begins a search, or goes on where it ended; refused without Optuna.",
            object_of("Searches that were put into the queue: 0 where it is over.", runs=WHOLE),
            None,
            (NAME,),
        ),
        "delete": designs("Ends a search; it can go on.", NAMED, None, (NAME,)),
    },
    "/whatif/designs/{name}/report.html": {
        "get": designs(
            "The report of a search that is over.", TEXT, None, (NAME,), media_type="text/html"
        )
    },
    "/whatif/designs/{name}/layouts/{layout}": {
        "get": designs("A layout of the front.", TEXT, None, (NAME, LAYOUT), media_type="text/yaml")
    },
    "/whatif/designs/{name}/layouts/{layout}/plan.svg": {
        "get": designs("Its plan.", TEXT, None, (NAME, LAYOUT), media_type="image/svg+xml")
    },
}
