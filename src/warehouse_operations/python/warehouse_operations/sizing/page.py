# SPDX-License-Identifier: Apache-2.0
"""Writes the report of a sizing: report.html, figure.png, points.csv and points.txt.

The first page is to be handed on: the answer, its figure, what limits it, what was assumed.
"""

from collections.abc import Iterator
from html import escape
from pathlib import Path

from warehouse_operations.policies import Policies
from warehouse_operations.report import STYLE, section
from warehouse_operations.runs import REPORT
from warehouse_operations.sizing import figures, table
from warehouse_operations.sizing.answer import Answer
from warehouse_operations.sizing.prices import Prices
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.wish import Wish, count

PRINT = (
    ".wide { overflow-x: auto } .first { break-after: page } .answer { font-size: 1.15em }"
    " li { margin: .2em 0 }"
)
KNEES = (
    "Bands are 95 % confidence intervals of the mean (Student's t over seeds). A triangle is the"
    " knee: the fewest robots with 99 % of the most orders an hour that so many stations complete."
    " The dotted upright line is the answer."
)
MISSED = (
    "Missed: of the orders that came after the warm-up, the part that was not completed in time:"
    " late ones, and those by which the open orders pile up. A point is <i>met</i> if the upper"
    " 95 % confidence limit of that part is at most what may be late, <i>missed</i> if the lower"
    " one is above it, else undecided, and then not taken. Up to four times as many shifts as asked"
    " for are simulated where it is undecided; each of three looks has a third of the risk"
    " (Bonferroni). The warm-up ends where MSER-5 has the open orders steady. All points have"
    " the same seeds: the same orders come at the same moments."
)


def write(
    folder: Path, study: Study, answer: Answer | None, why: str, prices: Prices | None
) -> Path:
    """Writes the report and tables into a folder; returns the report's path.

    answer: None where the wish is impossible; `why` says so then.
    """
    texts = {
        "points.csv": table.to_csv(study, prices),
        "points.txt": table.to_text(study, prices) + "\n",
        REPORT: page(study, answer, why, prices),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    figures.write_png(folder / "figure.png", study, _chosen(answer))
    return folder / REPORT


def _chosen(answer: Answer | None) -> tuple[int, int] | None:
    return (answer.robots, answer.stations) if answer else None


def page(study: Study, answer: Answer | None, why: str, prices: Prices | None) -> str:
    """Returns the HTML of the report."""
    title = f"How many robots? {study.wish.file.title}"
    chosen = _chosen(answer)
    pictures = figures.throughput(study, chosen), figures.lateness(study, chosen)
    parts = [
        f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f"<style>{STYLE}{PRINT}</style></head><body><div class='first'><h1>{escape(title)}</h1>",
        _answer(study, answer, why, prices),
        f'<div class="row">{"".join(f"<div>{one}</div>" for one in pictures)}</div>',
        f'<p class="note">{KNEES}</p>',
        section("What limits it", _list(answer.reasons())) if answer else "",
        section("What was assumed", _list(assumptions(study.wish, prices))),
        "</div>",
        section("Fewest robots for each number of stations", _frontier(study, prices)),
        section("How busy robots and stations are", figures.use(study, chosen)),
        section("All points", _table(study, prices), MISSED),
        section("What it took", f"<p>{escape(effort(study))}</p>"),
    ]
    return "\n".join(filter(None, parts)) + "</body></html>\n"


def _answer(study: Study, answer: Answer | None, why: str, prices: Prices | None) -> str:
    if not answer:
        return f'<p class="answer bad">It can\'t be done: {escape(why)}.</p>'
    cells = [
        (f"{answer.robots:,}", "robots"),
        (f"{answer.stations:,}", f"open picking stations ({answer.names})"),
        (f"{study.wish.orders_per_hour:,.0f}", "orders an hour"),
        (answer.limit, "limit it"),
    ]
    if cost := table.cost_of(study, prices, answer.measured):
        cells.append((cost, "cost of a piece"))
    big = "".join(f"<div><b>{escape(a)}</b>{escape(b)}</div>" for a, b in cells)
    bad = "" if answer.confirmed else " bad"
    return f'<div class="big">{big}</div><p class="answer{bad}">{escape(answer.headline())}</p>'


def assumptions(wish: Wish, prices: Prices | None) -> Iterator[str]:
    """Yields sentences about what the answer takes for granted."""
    if wish.orders_file:
        yield (
            f"Orders are drawn from those of {Path(wish.orders_file).name}, on the average"
            f" {wish.pieces_per_order:.2f} pieces each, with the time that each had until it was"
            " due."
        )
    else:
        yield (
            f"Orders have {wish.lines:g} lines of {wish.pieces:g} pieces on the average, of SKUs"
            " in stock; one in five is due within half an hour, the others within two hours."
        )
    yield (
        f"They come by chance (Poisson), {wish.orders_per_hour:,.0f} an hour without peaks;"
        f" {100 * wish.late:g} % may be late. A peak hour is sized by its own orders an hour."
    )
    chosen = Policies(wish.file.policies).chosen
    told = ", ".join(f"{role}: {_name(policy)}" for role, policy in chosen.items())
    yield f"Decisions: {told}."
    yield (
        f"Shifts of {wish.hours:g} h on {wish.file.title}: {count(wish.units, 'storage unit')},"
        f" {count(wish.file.items, 'bin')}; all replenishing stations are open, and nothing breaks."
    )
    if prices:
        yield (
            f"Prices: robot {prices.robot:,g}, station {prices.station:,g}, storage unit"
            f" {prices.unit:,g}, used up in {prices.hours:,g} hours; {prices.hour:,g} an hour for"
            " the person at each open picking station. The answer is the cheapest point that does."
        )
    else:
        yield (
            "Without prices the answer has the fewest stations, each of which takes a person, and"
            " the fewest robots that do with them."
        )


def effort(study: Study) -> str:
    """Returns what was simulated for the answer, as a sentence."""
    points = len(study.verdicts) + len(study.checks)
    shifts = sum(len(v.records) for d in (study.verdicts, study.checks) for v in d.values())
    return (
        f"{count(points, 'point')} of {count(shifts, 'shift')}; in this run"
        f" {count(study.shifts, 'shift')} were simulated, {study.simulated_h:,.0f} h of work in"
        f" {study.wall_s / 60:.1f} minutes of computing."
    )


def _name(policy: object) -> str:
    return str(policy["name"]) if isinstance(policy, dict) else str(policy)


def _list(sentences: Iterator[str]) -> str:
    return f"<ul>{''.join(f'<li>{escape(one)}</li>' for one in sentences)}</ul>"


def _frontier(study: Study, prices: Prices | None) -> str:
    cost = "<th>cost a piece</th>" if prices else ""
    lines = [f"<tr><th>stations</th><th>fewest robots</th>{cost}</tr>"]
    for stations, robots in study.frontier.items():
        verdict = study.verdicts.get((robots or 0, stations))
        shown = f"{robots:,}" if robots else "no number does"
        cells = [f"{stations:,}", shown]
        cells += [table.cost_of(study, prices, verdict) if verdict else ""] if prices else []
        lines.append(f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    return f"<table>{''.join(lines)}</table>"


def _table(study: Study, prices: Prices | None) -> str:
    heads = [*table.HEAD, *(one[1] for one in table.FIGURES), *(["cost a piece"] if prices else [])]
    lines = [f"<tr>{''.join(f'<th>{head}</th>' for head in heads)}</tr>"]
    for verdict, kind in table.rows(study):
        cells = table.head_of(verdict, kind)
        cells += [table.cell_of(verdict, *one) for one in table.FIGURES]
        cells += [table.cost_of(study, prices, verdict)] if prices else []
        lines.append(f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    return f'<div class="wide"><table class="note">{"".join(lines)}</table></div>'
