# SPDX-License-Identifier: Apache-2.0
"""The result of a run: lines for a terminal, a page, JUnit XML, and the messages."""

from pathlib import Path

from warehouse_vda5050.conform.log import Log
from warehouse_vda5050.conform.report.html import page
from warehouse_vda5050.conform.report.junit import suites
from warehouse_vda5050.conform.report.score import Run


def write(folder: Path, run: Run, log: Log) -> None:
    """Writes report.html, junit.xml and messages.jsonl. Raises OSError."""
    (folder / "report.html").write_text(page(run), encoding="utf-8")
    (folder / "junit.xml").write_text(suites(run), encoding="utf-8")
    log.write(folder / "messages.jsonl")
