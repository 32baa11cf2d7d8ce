# SPDX-License-Identifier: Apache-2.0
"""conform on our own vehicle: all cases of all versions, its report, and where it drives."""

import json
from xml.etree import ElementTree

import pytest
from paper_vehicle import TICK, PaperWire, runner_for

from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.cases import CASES, cases_of
from warehouse_vda5050.conform.ground import Ground, GroundError, Place, read
from warehouse_vda5050.conform.report import write
from warehouse_vda5050.conform.report.score import Run, lines
from warehouse_vda5050.conform.verdict import Differs, Verdict
from warehouse_vda5050.errors import Error
from warehouse_vda5050.topics import Kind

VERSIONS = ("2.0.0", "2.1.0", "3.0.0")


def run_of(runner):
    about = ("paper/1", "2.1.0", "localhost:1883", "today", 1.0)
    return Run(*about, runner.results, interrupted=runner.probe.interrupted)


@pytest.mark.parametrize("version", VERSIONS)
def test_our_vehicle_conforms(version):
    runner = runner_for(version)
    results = [*runner.run(cases_of(version, strict=True))]
    assert not [(r.case.id, r.reason) for r in results if r.verdict is Verdict.DIFFERS]
    others = [r.case.id for r in results if r.verdict is not Verdict.CONFORMS]
    assert others == ["connection.offline"]


def test_what_a_busy_machine_delivers_together_is_not_taken_for_one_moment():
    wire = PaperWire()
    runner = runner_for(wire=wire)
    poll, take, held = wire.poll, wire.take, []
    wire.take = held.append

    def poll_and_deliver_twice_a_second(seconds):
        poll(seconds)
        if wire.now() % 0.5 < TICK:
            while held:
                take(held.pop(0))

    wire.poll = poll_and_deliver_twice_a_second
    driven = ("order.", "update.", "progress.agreement")
    results = [*runner.run([c for c in cases_of("2.1.0") if c.id.startswith(driven)])]
    assert results[-1].case.id == "progress.agreement"
    assert results[-1].verdict is Verdict.CONFORMS, results[-1].reason


@pytest.mark.parametrize(
    ("elsewhere", "verdict"), [({3}, Verdict.CONFORMS), ({3, 4, 5, 6, 7, 8}, Verdict.DIFFERS)]
)
def test_a_vehicle_held_up_once_between_measuring_and_sending_conforms(elsewhere, verdict):
    wire = PaperWire()
    runner, take, shown = runner_for(wire=wire), wire.take, []

    def take_some_from_elsewhere(message):
        if message.topic.endswith("visualization"):
            shown.append(message)
            if len(shown) in elsewhere:
                value = json.loads(message.payload)
                value["agvPosition"]["x"] += 3.0
                message = message._replace(payload=json.dumps(value).encode())
        take(message)

    wire.take = take_some_from_elsewhere
    driven = ("order.", "progress.agreement")
    results = [*runner.run([c for c in cases_of("2.1.0") if c.id.startswith(driven)])]
    assert results[-1].verdict is verdict, results[-1].reason


def test_each_case_has_its_own_id_and_a_section():
    ids = [case.id for case in CASES]
    assert len(set(ids)) == len(ids) > 200
    assert all(case.section[0].isdigit() and case.sentence.endswith((".", ").")) for case in CASES)


def test_the_vehicle_is_sent_no_farther_than_given():
    wire, far = PaperWire(), set()
    runner = runner_for(wire=wire, edges=2)
    step = wire.robot.step

    def watched():
        step()
        far.add(wire.robot.cell)

    wire.robot.step = watched
    results = {r.case.id: r for r in runner.run(cases_of("2.1.0"))}
    assert far <= {(2, 2), (3, 2), (4, 2)}
    assert results["order.many_nodes"].verdict is Verdict.UNTESTABLE
    assert "3 edges" in results["order.many_nodes"].reason


def test_a_vehicle_that_ended_fails_the_case_in_which_it_did_and_no_other():
    wire = PaperWire()
    runner = runner_for(wire=wire)
    wire.from_vehicle = lambda message: None
    results = [*runner.run([case for case in cases_of("2.1.0") if not case.audit])]
    assert max(result.seconds for result in results) < 240.0
    assert sum(result.verdict is Verdict.DIFFERS for result in results) == 1
    untested = [r for r in results if r.verdict is Verdict.UNTESTABLE]
    assert len(untested) > 150 and "since connection.qos_others" in untested[-1].reason


def test_an_interrupted_run_cancels_its_order_and_keeps_what_it_had():
    wire = PaperWire()
    runner = runner_for(wire=wire)
    poll = wire.poll

    def interrupting(seconds):
        poll(seconds)
        if wire.robot.reached > 1:
            runner.probe.interrupted = True

    wire.poll = interrupting
    results = [*runner.run([c for c in cases_of("2.1.0") if c.chapter in ("order", "update")])]
    assert runner.probe.interrupted and results[-1].reason == "interrupted"
    assert len(results) < 10
    assert not runner.probe.state["nodeStates"] and not runner.probe.state["driving"]


def test_a_run_that_is_interrupted_between_two_cases_says_that_others_were_not_tried():
    runner = runner_for()
    cases = [c for c in cases_of("2.1.0") if c.chapter == "order"]
    for _ in runner.run(cases):
        runner.probe.interrupted = True
    assert len(runner.results) == 1
    assert lines(run_of(runner))[-1].endswith("interrupted, so the others were not tried")


def test_report(tmp_path):
    runner = runner_for()
    results = [*runner.run([c for c in cases_of("2.1.0") if c.chapter == "order"])]
    write(tmp_path, run_of(runner), runner.probe.log)
    page = (tmp_path / "report.html").read_text()
    assert all(f'id="{result.case.id}"' in page for result in results)
    assert "<script" not in page and "src=" not in page  # nothing from elsewhere
    suites = ElementTree.parse(tmp_path / "junit.xml").getroot()
    assert len(suites.findall(".//testcase")) == len(results)
    messages = [json.loads(x) for x in (tmp_path / "messages.jsonl").read_text().splitlines()]
    assert {m["direction"] for m in messages} == {"sent", "received"}
    assert lines(run_of(runner))[-1].startswith(f"{len(results)} of {len(results)} cases conform")


def test_the_report_shows_hostile_text_as_text(tmp_path):
    hostile = "<script>alert(1)</script>\x01"

    def trial(probe):
        probe.send_bytes(Kind.ORDER, hostile.encode())
        raise Differs(hostile)

    runner = runner_for()
    assert [*runner.run([Case("order.hostile", "6.6", "No script.", trial)])]
    write(tmp_path, run_of(runner), runner.probe.log)
    assert "<script" not in (tmp_path / "report.html").read_text()
    ElementTree.parse(tmp_path / "junit.xml")


# --- where it drives


def test_a_way_leads_to_the_farther_end():
    ground = Ground([Place(str(k), float(k), 0.0) for k in range(4)])
    assert [p.id for p in ground.way(1, 2)] == ["1", "2", "3"]
    assert [p.id for p in ground.way(2, 2)] == ["2", "1", "0"]
    assert ground.at(1.2, 0.0) == 1 and ground.at(1.5, 0.0) is None
    assert ground.room(1) == 2


def test_nodes_of_a_list(tmp_path):
    file = tmp_path / "nodes.json"
    rows = [{"nodeId": f"n{k}", "x": k, "y": 1, "mapId": "m"} for k in range(3)]
    file.write_text(json.dumps(rows))
    ground = read(file, "n0", 0.0, 1.0, 3)
    assert [p.id for p in ground.places] == ["n0", "n1", "n2"]
    assert ground.places[2] == Place("n2", 2.0, 1.0, "m")


def test_nodes_of_a_layout_are_a_way_that_is_driven_in_both_directions(tmp_path):
    names = ("a", "b", "c", "d", "e")
    nodes = [
        {"nodeId": name, "mapId": "m", "nodePosition": {"x": float(k), "y": 0.0}}
        for k, name in enumerate(names)
    ]
    both = [("a", "b"), ("b", "c"), ("c", "e")]
    pairs = [*both, *((b, a) for a, b in both), ("b", "d")]
    edges = [{"edgeId": f"{a}{b}", "startNodeId": a, "endNodeId": b} for a, b in pairs]
    file = tmp_path / "floor.lif.json"
    file.write_text(json.dumps({"layouts": [{"nodes": nodes, "edges": edges}]}))
    assert [p.id for p in read(file, "a", 0.0, 0.0, 3).places] == ["a", "b", "c", "e"]
    assert [p.id for p in read(file, "nowhere", 1.1, 0.0, 1).places] == ["b", "a"]


@pytest.mark.parametrize(
    "text",
    ["", "[]", '[{"nodeId": "a", "x": 0, "y": 0}]', '{"layouts": [{}]}', "[1, 2]", '{"a": 1}'],
)
def test_a_wrong_list_of_nodes_is_refused(tmp_path, text):
    file = tmp_path / "nodes.json"
    file.write_text(text)
    with pytest.raises(GroundError):
        read(file, "a", 0.0, 0.0, 3)


def test_cases_after_one_that_left_the_vehicle_stuck_are_not_held_against_it():
    wire = PaperWire()
    runner = runner_for(wire=wire)
    cases = {case.id: case for case in cases_of("2.1.0")}
    first = runner.try_case(cases["order.one_edge"])
    wire.link.vehicle.on_order = lambda *args: wire.link.vehicle.request_state()
    wire.link.vehicle.note(Error("validationError"))
    stuck = runner.try_case(cases["state.on_request"])
    after = runner.try_case(cases["order.one_edge"])
    assert first.verdict is Verdict.CONFORMS
    assert stuck.verdict is Verdict.DIFFERS and "afterwards" in stuck.reason
    assert after.verdict is Verdict.UNTESTABLE and "since state.on_request" in after.reason


def test_a_vehicle_may_report_an_order_before_it_counts_the_first_node():
    """The state then has the last node of the order before, and all nodes of the new one."""
    known = {}

    def late(message):
        if not message.topic.endswith("/state"):
            return message
        value = json.loads(message.payload)
        here = value["lastNodeId"], value["lastNodeSequenceId"]
        if value["orderId"] != known.get("order") and value["nodeStates"] and "here" in known:
            first = {"nodeId": here[0], "sequenceId": 0, "released": True}
            value["nodeStates"].insert(0, first)
            value["lastNodeId"], value["lastNodeSequenceId"] = known["here"]
        known.update(order=value["orderId"], here=here)
        return message._replace(payload=json.dumps(value).encode())

    runner = runner_for(wire=PaperWire(damage=late))
    results = [*runner.run(cases_of("2.1.0"))]
    assert not [(r.case.id, r.reason) for r in results if r.verdict is Verdict.DIFFERS]
