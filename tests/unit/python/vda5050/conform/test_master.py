# SPDX-License-Identifier: Apache-2.0
"""conform on our own master: all cases of all versions, and what becomes of one that is silent."""

import json
import math
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from paper_master import runner_for

from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.master.cases import CASES, cases_of
from warehouse_vda5050.conform.master.command import roles_of
from warehouse_vda5050.conform.master.open_floor import NOWHERE, OpenFloor
from warehouse_vda5050.conform.report import write
from warehouse_vda5050.conform.report.score import Run, exit_code
from warehouse_vda5050.conform.verdict import Verdict
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.grid import GridError
from warehouse_vda5050.model import Node, Position
from warehouse_vda5050.topics import Kind

VERSIONS = ("2.0.0", "2.1.0", "3.0.0")


def run_of(results):
    return Run("the master", "2.1.0", "localhost:1883", "today", 1.0, results)


@pytest.mark.parametrize(
    "version", [pytest.param(v, marks=pytest.mark.long) for v in VERSIONS[:-1]] + [VERSIONS[-1]]
)
def test_our_master_conforms(version):
    runner = runner_for(version, strict=True)
    results = [*runner.run(cases_of(version, strict=True))]
    others = [(r.case.id, r.reason) for r in results if r.verdict is not Verdict.CONFORMS]
    assert not others
    assert len(results) > 100 and exit_code(run_of(results)) == 0


def test_each_case_has_its_own_id_and_a_section():
    ids = [case.id for case in CASES]
    assert len(set(ids)) == len(ids)
    assert all(case.section[0].isdigit() and case.sentence.endswith(".") for case in CASES)


def test_a_master_that_sends_nothing_was_not_tried():
    runner = runner_for(damage=lambda _message: None, patience=2.0, impatience=0.5, trip=2.0)
    results = [*runner.run(cases_of("2.1.0"))]
    assert {r.verdict for r in results} == {Verdict.UNTESTABLE}
    assert exit_code(run_of(results)) == 2
    reasons = " ".join(r.reason for r in results)
    assert "the master sent no order to conform/1 or conform/2 within 2 s" in reasons
    assert max(r.seconds for r in results) < 25.0


def test_report(tmp_path):
    runner = runner_for()
    results = [*runner.run([c for c in cases_of("2.1.0") if c.id == "modes.manual" or c.audit])]
    write(tmp_path, run_of(results), runner.stage.log)
    page = (tmp_path / "report.html").read_text()
    assert all(f'id="{result.case.id}"' in page for result in results)
    suites = ElementTree.parse(tmp_path / "junit.xml").getroot()
    assert len(suites.findall(".//testcase")) == len(results)
    messages = [json.loads(x) for x in (tmp_path / "messages.jsonl").read_text().splitlines()]
    assert {m["direction"] for m in messages} == {"sent", "received"}
    assert {"conform/1/order", "conform/2/state"} <= {m["topic"] for m in messages}


def test_an_interrupted_run_judges_what_there_was():
    runner = runner_for()

    def trial(stage):
        stage.an_order(stage.mark)
        stage.interrupted = True
        stage.wait(1.0)

    cases = [Case("modes.interrupted", "6.10", "It ends.", trial), *cases_of("2.1.0")]
    results = [*runner.run(cases)]
    assert results[0].reason == "interrupted"
    assert all(result.case.audit for result in results[1:])
    assert "order.nodes" in {r.case.id for r in results if r.verdict is Verdict.CONFORMS}


# --- vehicles


def robot_after(robot, seconds, step=0.1):
    for _ in range(round(seconds / step)):
        robot.step(step)
    return robot.report()


def test_a_robot_drives_by_its_formula():
    robot = FormulaRobot(0.0, 0.0, 0.0, speed=1.0)
    robot.follow(1, 0, [(0.0, 0.0), (3.0, 4.0), (3.0, 5.0)], 3)
    there = robot_after(robot, 2.5)
    assert (there.x, there.y) == pytest.approx((1.5, 2.0)) and there.moving and there.reached == 1
    there = robot_after(robot, 4.0)
    assert (there.x, there.y, there.reached) == (3.0, 5.0, 3) and not there.busy
    assert there.yaw == pytest.approx(math.pi / 2)


def test_a_robot_drives_no_faster_than_an_edge_allows_and_takes_its_heading():
    robot = FormulaRobot(0.0, 0.0, 0.0, speed=1.0)
    robot.limits[(0.0, 0.0), (1.0, 0.0)] = 0.5
    robot.headings[1.0, 0.0] = 1.5
    robot.follow(1, 0, [(0.0, 0.0), (1.0, 0.0)], 2)
    assert robot_after(robot, 1.0).x == pytest.approx(0.5)
    there = robot_after(robot, 1.1)
    assert (there.x, there.yaw, there.busy) == (1.0, 1.5, False)


def test_a_robot_that_is_cancelled_ends_at_the_next_point():
    robot = FormulaRobot(0.0, 0.0, 0.0)
    robot.follow(1, 0, [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], 3)
    robot_after(robot, 0.5)
    robot.cancel()
    there = robot_after(robot, 2.0)
    assert (there.x, there.busy, there.reached) == (1.0, False, 2)


def test_a_floor_has_places_anywhere():
    floor = OpenFloor(0.0, 0.0, 1.0, 1, 1)
    node = Node("A", 0, True, Position(1.25, -3.5))
    cell = floor.cell_of(node)
    assert floor.position(cell) == (1.25, -3.5) and floor.node_id(cell) == "A"
    assert floor.cell_of(replace(node, position=None)) == cell
    assert floor.cell_at(1.3, -3.5) == cell and floor.cell_at(2.0, -3.5) == NOWHERE
    with pytest.raises(GridError, match="had none before"):
        floor.cell_of(Node("B", 0, True))


def test_the_vehicle_on_the_stage_is_at_the_places_of_its_own_map():
    runner = runner_for()
    stage = runner.stage
    stage.limit(60.0)
    actor = stage.idle()
    state = stage.log.last(Kind.STATE)
    assert state is None  # that of the other side
    positions = [
        (entry.value or {})["agvPosition"]["mapId"]
        for entry in stage.log.entries
        if entry.sent and entry.kind is Kind.STATE
    ]
    assert {*positions} == {"warehouse"} and actor.vehicle.order is not None


# --- what may be played


def test_roles():
    first, second = roles_of(["kiva/1", "acme/x-2@1.5,-2,90,hall_3"])
    assert (first.x, first.y, first.yaw, first.node) == (0.0, 0.0, 0.0, "conform_start")
    assert (second.x, second.y, second.node) == (1.5, -2.0, "hall_3")
    assert second.yaw == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("kiva", "serial is ''"),
        ("kiva/1@3", "X,Y"),
        ("kiva/1@a,b", "could not convert"),
        ("kiva/1@nan,0", "X,Y"),
        ("ki va/1", "letters, digits"),
    ],
)
def test_a_wrong_role_is_refused(text, reason):
    with pytest.raises(ValueError, match="--play has") as refusal:
        roles_of([text])
    assert reason in str(refusal.value)


def test_no_vehicle_is_played_twice():
    with pytest.raises(ValueError, match="twice"):
        roles_of(["kiva/1", "kiva/1@1,2"])
