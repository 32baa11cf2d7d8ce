# SPDX-License-Identifier: Apache-2.0
"""Writes what a search found: front.csv, the layouts of the front, drawings and report.html."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from warehouse_layout.drawing import draw
from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import SUFFIX
from warehouse_operations.design.search import Candidate, Search
from warehouse_operations.document import page, sheets
from warehouse_operations.runs.version import version

FRONT, REPORT, BEST = "front.csv", "report.html", f"best{SUFFIX}"
HEAD = (
    "layout", "to buy", "cost a piece", "late %", "robots", "stations", "replenishing", "units",
    "block", "one-way", "sides", "policies", "contacts",
)  # fmt: skip
DRAWN = 4  # layouts that the report shows


def write(folder: Path, search: Search, front: Sequence[Candidate], why: str) -> Path:
    """Writes all files; returns the report's path. why: there is no answer, or ""."""
    for number, candidate in enumerate(front, start=1):
        layout_file.write(candidate.file, folder / f"front-{number}{SUFFIX}")
    if front:
        layout_file.write(front[0].file, folder / BEST)
    rows = [_row(number, candidate) for number, candidate in enumerate(front, start=1)]
    (folder / FRONT).write_text(sheets.to_csv([list(HEAD), *rows]), encoding="utf-8")
    (folder / REPORT).write_text(_page(search, front, why), encoding="utf-8")
    return folder / REPORT


def _row(number: int, candidate: Candidate) -> list[object]:
    chosen, bill = candidate.chosen, candidate.bill
    return [
        f"front-{number}{SUFFIX}",
        round(bill.to_buy, 2),
        round(bill.a_piece, 6),
        round(100 * candidate.late, 4),
        candidate.robots,
        candidate.stations,
        chosen["replenish"],
        chosen["units"],
        f"{chosen['depth']}x{chosen['length']}",
        chosen["one_way"],
        chosen["sides"],
        ", ".join(f"{role}: {name}" for role, name in chosen["policies"].items()),
        "" if candidate.contacts is None else candidate.contacts,
    ]


def answer(search: Search, front: Sequence[Candidate]) -> str:
    """Returns the answer as a sentence."""
    best = front[0]
    contacts = "" if best.contacts is None else f" Simulated robots had {best.contacts} contacts."
    return (
        f"{best.robots} robots, {best.stations} picking stations and {best.chosen['units']} storage"
        f" units: {100 * best.late:.2f} % of the orders are late, {100 * search.late:g} % may be."
        f" {best.bill.text()}{contacts}"
    )


def effort(search: Search) -> str:
    """Returns what the search took."""
    return (
        f"{search.trials} trials, {search.by_hand} of them without a shift; {search.shifts} shifts,"
        f" {search.simulated} of them simulated in this run in {search.wall_s / 3600:.2f} h of"
        f" computing."
    )


def _page(search: Search, front: Sequence[Candidate], why: str) -> str:
    building = search.space.building.file.title
    question = f"Which layout of {building} serves {search.space.day}?"
    first = page.opening(question, why or answer(search, front), bool(why))
    table = page.table(
        list(HEAD),
        [list(map(str, _row(n, each))) for n, each in enumerate(front, 1)],
        "Front",
    )
    drawings = page.row(_drawing(each, n) for n, each in enumerate(front[:DRAWN], start=1))
    learnt = page.table(
        ["parameter", "share %"],
        [[name, f"{100 * share:.1f}"] for name, share in search.importance.items()],
        "Importance of parameters",
    )
    rest = [
        page.section("The front", table, "Nothing else was both cheaper to buy and a piece."),
        page.section("Side by side", drawings),
        page.section(
            "What the search learnt",
            learnt,
            "How much each parameter decides of what a piece costs, by PED-ANOVA over all trials.",
        ),
        page.section("What it took", f"<p>{effort(search)}</p>"),
    ]
    about = f"{page.today()}, version {version()}"
    return page.document(f"Design: {building}", "Design", about, first, "\n".join(rest))


def _drawing(candidate: Candidate, number: int) -> str:
    """Returns the plan of a layout as SVG with its name."""
    with tempfile.TemporaryDirectory() as made:
        path = Path(made) / "plan.svg"
        draw.draw(candidate.file, path)
        text = path.read_text(encoding="utf-8")
    svg = text[text.index("<svg") :].replace('id="', f'id="d{number}-')
    svg = svg.replace('href="#', f'href="#d{number}-').replace("url(#", f"url(#d{number}-")
    svg = svg.replace("<svg", '<svg style="max-width:100%;height:auto"', 1)
    return f"<figure><figcaption><h3>front-{number}{SUFFIX}</h3></figcaption>{svg}</figure>"
