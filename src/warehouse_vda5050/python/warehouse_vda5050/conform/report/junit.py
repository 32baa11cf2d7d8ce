# SPDX-License-Identifier: Apache-2.0
"""A run as JUnit XML, as build servers read it."""

from xml.etree import ElementTree

from warehouse_vda5050.conform.report.score import Run
from warehouse_vda5050.conform.runner import Result
from warehouse_vda5050.conform.verdict import Verdict

CONTROL = {code: None for code in range(32) if chr(code) not in "\t\n\r"}  # XML has no such


def suites(run: Run) -> str:
    """Returns the document: a suite a chapter."""
    root = ElementTree.Element("testsuites", name=f"VDA 5050 {run.version}, {run.vehicle}")
    for score in run.chapters:
        results = [r for r in run.results if r.case.chapter == score.name]
        suite = ElementTree.SubElement(
            root,
            "testsuite",
            name=score.name,
            tests=str(len(results)),
            failures=str(score.counts[Verdict.DIFFERS]),
            skipped=str(len(results) - score.tried),
            time=f"{sum(r.seconds for r in results):.3f}",
        )
        for result in results:
            _add(suite, result)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _add(suite: ElementTree.Element, result: Result) -> None:
    case = result.case
    element = ElementTree.SubElement(
        suite,
        "testcase",
        classname=case.chapter,
        name=f"{case.id} ({case.section}) {case.sentence}",
        time=f"{result.seconds:.3f}",
    )
    reason = result.reason.translate(CONTROL)
    if result.verdict is Verdict.DIFFERS:
        ElementTree.SubElement(element, "failure", message=reason)
    elif result.verdict is not Verdict.CONFORMS:
        ElementTree.SubElement(element, "skipped", message=f"{result.verdict.value}: {reason}")
