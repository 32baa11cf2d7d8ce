# SPDX-License-Identifier: Apache-2.0
"""Writes what a search found: front.csv, the layouts of the front, drawings and report.html."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from warehouse_layout.drawing import draw
from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import SUFFIX
from warehouse_operations.design.candidate import Candidate
from warehouse_operations.design.plans import OUTLINE, policies_of
from warehouse_operations.design.search import Search
from warehouse_operations.document import page, sheets
from warehouse_operations.runs.version import version
from warehouse_operations.sizing.wish import count

FRONT, REPORT, BEST = "front.csv", "report.html", f"best{SUFFIX}"
HEAD = (
    "layout", "to buy", "cost a piece", "late %", "robots", "stations", "replenishing", "units",
    "plan", "block", "one-way", "sides", "policies", "contacts", "pieces of ideal %",
    "unseen cost a piece", "± cost", "unseen late %", "± late %",
)  # fmt: skip
DRAWN = 4  # layouts that the report shows


def write(folder: Path, search: Search, front: Sequence[Candidate], why: str) -> Path:
    """Writes all files; returns the report's path. why: why there is no answer, or ""."""
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
    is_outline = chosen["plan"] == OUTLINE
    cost, late = candidate.unseen_cost, candidate.unseen_late
    return [
        f"front-{number}{SUFFIX}",
        round(bill.to_buy, 2),
        round(bill.a_piece, 6),
        round(100 * candidate.late, 4),
        candidate.robots,
        candidate.stations,
        chosen["replenish"],
        chosen["units"],
        chosen["plan"],
        "2x8" if is_outline else f"{chosen['depth']}x{chosen['length']}",
        not is_outline and chosen["one_way"],
        "" if is_outline else chosen["sides"],
        ", ".join(f"{role}: {name}" for role, name in policies_of(chosen).items()),
        "" if candidate.contacts is None else candidate.contacts,
        "" if candidate.traffic is None else round(100 * candidate.traffic, 1),
        round(cost.mean, 6),
        round(cost.half, 6),
        round(100 * late.mean, 4),
        round(100 * late.half, 4),
    ]


def answer(search: Search, front: Sequence[Candidate]) -> str:
    """Returns the answer in sentences: the layout, its cost and the confidence in both."""
    best = front[0]
    puts = (
        f"{count(best.chosen['replenish'], 'replenishing station')}"
        if best.chosen["replenish"]
        else "bundles put in at these"
    )
    return (
        f"{count(best.robots, 'robot')}, {count(best.stations, 'picking station')}, {puts},"
        f" {count(best.chosen['units'], 'storage unit')}. {best.bill.text()} {_sure(search, best)}"
        f"{_physics(best)}"
    )


def _sure(search: Search, best: Candidate) -> str:
    """Returns a sentence about the days that had no part in the choice."""
    cost, late, limit = best.unseen_cost, best.unseen_late, search.late
    if late.mean > limit:
        word = "the limit is missed"
    else:
        word = "in time" if late.mean + late.half <= limit else "in time on the average, not surely"
    return (
        f"On {late.count} days that the search did not see, {100 * late.mean:.2f} ±"
        f" {100 * late.half:.2f} % of the orders are late, {100 * limit:g} % may be ({word}); a"
        f" piece costs {cost.mean:.4f} ± {cost.half:.4f}."
    )


def _physics(best: Candidate) -> str:
    if best.contacts is None:
        return ""
    share = f", and pick {100 * best.traffic:.0f} % of the pieces" if best.traffic else ""
    return f" Simulated robots have {count(best.contacts, 'contact')}{share}."


def effort(search: Search) -> str:
    """Returns a sentence about the effort of the search."""
    return (
        f"{search.trials} trials by short shifts, {search.by_hand} without a shift;"
        f" {search.shifts} shifts, {search.simulated} of them simulated in this run;"
        f" {search.cpu_s / 3600:.3f} CPU hours in all."
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
