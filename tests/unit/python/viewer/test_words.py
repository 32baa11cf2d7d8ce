# SPDX-License-Identifier: Apache-2.0
"""Page, API and events have one word for one thing."""

import json
import subprocess
from typing import get_args

import numpy as np
from paths import ROOT

from warehouse_client import message_names
from warehouse_msgs.msg import CoordinatorState, FleetState, KivaStatus
from warehouse_viewer.api import catalogue
from warehouse_viewer.api.schemas.fleet import RobotsByWork
from warehouse_viewer.api.schemas.models import Robot
from warehouse_viewer.api.schemas.operations import STATES
from warehouse_viewer.api.schemas.pydantic_versions import names_of
from warehouse_viewer.message_enums import EventKind, Status
from warehouse_viewer.page import statuses

WEB = ROOT / "src/warehouse_viewer/web/js/words.js"
IDLE, BUSY = KivaStatus.STATUS_IDLE, KivaStatus.STATUS_BUSY


def page():
    """What words.js has."""
    script = (
        f"import * as words from {json.dumps(WEB.as_uri())}; console.log(JSON.stringify(words))"
    )
    command = ["node", "--input-type=module", "--eval", script]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def test_the_page_has_the_words_of_the_api():
    told = page()
    assert [one.upper() for one in told["ACTIVITY"]] == list(catalogue.ACTIVITY.values())
    assert list(catalogue.ACTIVITY) == list(range(len(catalogue.ACTIVITY)))
    assert len(told["STATE"]) == len(message_names.STATE)
    assert told["FAILURE"] == list(message_names.FAILURES.values())
    assert told["WORK"] == list(message_names.WORK)
    assert list(told["MODE"]) == list(message_names.MODE.values())
    assert [mode.replace(" ", "_").upper() for mode in told["MODE"].values()] == list(told["MODE"])
    assert set(told["TROUBLE"]) < set(message_names.EVENT.values())
    assert tuple(told["ORDER_STATES"]) == STATES


def test_the_api_has_the_words_of_the_messages():
    assert set(names_of(RobotsByWork)) == set(message_names.WORK)
    assert set(message_names.WORK) <= set(CoordinatorState.__slots__)
    allowed = get_args(Robot.__annotations__["activity"])
    assert set(allowed) == set(catalogue.ACTIVITY.values())


def test_a_robot_that_carries_is_not_idle():
    fleet = FleetState(
        kiva_id=[1, 2, 3], status=[IDLE, IDLE, BUSY], shelf_id=[0, 6, 7], last_end=[0, 2, 2]
    )
    assert statuses.shown_status(fleet).tolist() == [IDLE, IDLE, BUSY]
    assert statuses.activity(fleet).tolist() == [IDLE, statuses.HOLDING, BUSY]
    blocked = FleetState(kiva_id=[1], status=[IDLE], shelf_id=[6], last_end=[EventKind.BLOCKED])
    assert np.array_equal(statuses.activity(blocked), [Status.BLOCKED])
