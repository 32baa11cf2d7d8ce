# SPDX-License-Identifier: Apache-2.0
"""Writes the report of a sizing: report.html, figure.png, points.csv, .xlsx and .txt.

The first page stands alone: the answer, its figure, its limit and the assumptions.
"""

import json
from collections.abc import Iterator
from pathlib import Path

from warehouse_operations.document import page as document
from warehouse_operations.document import sheets
from warehouse_operations.policies import Policies
from warehouse_operations.runs.run_files import REPORT
from warehouse_operations.runs.version import version
from warehouse_operations.sizing import figures, hourly, table
from warehouse_operations.sizing.answer import Answer
from warehouse_operations.sizing.costs import Bill, LayoutCosts
from warehouse_operations.sizing.prices import Pricing
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.verdict import Verdict
from warehouse_operations.sizing.wish import Wish, count

BY_HOUR = "by_hour.csv"

KNEES = (
    "Bands are 95 % confidence intervals of the mean (Student's t over seeds). A triangle is the"
    " knee: the fewest robots with 99 % of the most orders an hour that these stations complete."
    " The upright line is the answer."
)
MISSED = (
    "Late: of the orders that came after the warm-up, the part that was not completed in time; what"
    " is not due yet at the end of a shift is waited for. A point is met if the upper 95 %"
    " confidence limit of that part is at most what may be late, missed if the lower one is above"
    " it or if open orders pile up by more, else undecided, and then not taken. Up to four times as"
    " many shifts as asked for are simulated where it is undecided; each of three looks has a third"
    " of the risk (Bonferroni). The warm-up takes two hours, or until MSER-5 has the open orders"
    " steady. All points have the same seeds: the same orders come at the same moments."
)


def write(
    folder: Path, study: Study, answer: Answer | None, why: str, prices: Pricing | None
) -> Path:
    """Writes the report and tables into a folder; returns the report's path.

    answer: None where the wish is impossible; `why` is the reason.
    """
    texts = {
        "points.csv": table.to_csv(study, prices),
        "points.txt": table.to_text(study, prices) + "\n",
        REPORT: page(study, answer, why, prices),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    sheets.write_xlsx(folder / "points.xlsx", _sheets(study, prices))
    figures.write_png(folder / "figure.png", study, _chosen(answer))
    if verdict := _shown(study, answer):
        hours = hourly.hours_of(verdict)
        (folder / BY_HOUR).write_text(hourly.to_csv(hours), encoding="utf-8")
        hourly.write_png(folder / "by_hour.png", hours)
    if bill := bill_of(answer, prices):
        text = json.dumps(bill.to_json(), indent=1)
        (folder / "costs.json").write_text(f"{text}\n", encoding="utf-8")
    return folder / REPORT


def bill_of(answer: Answer | None, prices: Pricing | None) -> Bill | None:
    """Returns the costs of the answer; None without an answer or a file of costs."""
    if not answer or not isinstance(prices, LayoutCosts):
        return None
    figures_of = answer.measured.estimate
    return prices.bill(
        answer.robots,
        answer.stations,
        figures_of("orders_per_hour").mean,
        figures_of("pieces_per_hour").mean,
        figures_of("robots_at_work").mean,
    )


def _shown(study: Study, answer: Answer | None) -> Verdict | None:
    """Returns the point that is shown hour by hour: the answer's, else the largest one."""
    if answer:
        return answer.measured
    return study.verdicts[max(study.verdicts)] if study.verdicts else None


def _chosen(answer: Answer | None) -> tuple[int, int] | None:
    return (answer.robots, answer.stations) if answer else None


def page(study: Study, answer: Answer | None, why: str, prices: Pricing | None) -> str:
    """Returns the HTML of the report."""
    title = f"How many robots? {study.wish.file.title}"
    return document.document(
        title,
        "Sizing report",
        f"{document.today()}, version {version()}",
        _first(study, answer, why, prices),
        _rest(study, answer, prices),
    )


def _first(study: Study, answer: Answer | None, why: str, prices: Pricing | None) -> str:
    """Returns the first sheet."""
    wish = study.wish
    asked = f"How many robots does {wish.file.title} need for {wish.asked}?"
    result = answer.headline() if answer else f"It can't be done: {why}."
    is_bad = not answer or not answer.confirmed
    curve = figures.throughput(study, _chosen(answer)).html()
    parts = [
        document.opening(asked, result, is_bad),
        document.big(_big(study, answer, prices)) if answer else "",
        document.section("How orders grow with robots", curve),
        document.section(f"What limits it: {answer.limit}", document.sentences(answer.reasons()))
        if answer
        else "",
        document.section("What was assumed", document.sentences(assumptions(wish, prices))),
    ]
    return "\n".join(filter(None, parts))


def _rest(study: Study, answer: Answer | None, prices: Pricing | None) -> str:
    chosen = _chosen(answer)
    curves = figures.lateness(study, chosen).html() + f'<p class="note">{KNEES}</p>'
    links = sheets.links(_sheets(study, prices), "points")
    hours = ""
    if verdict := _shown(study, answer):
        each = hourly.hours_of(verdict)
        hours = hourly.chart(each).html() + hourly.use_chart(each).html()
    bill = bill_of(answer, prices)
    parts = [
        document.section("Hour by hour", hours) if hours else "",
        document.section("What it costs", f"<p>{bill.text()}</p>") if bill else "",
        document.section("How many orders are late", curves),
        document.section("Fewest robots for each number of stations", _frontier(study, prices)),
        document.section("How busy they are", figures.use(study, chosen).html()),
        document.section("All points", _table(study, prices) + links, MISSED),
        document.section("What it took", f"<p>{effort(study)}</p>"),
    ]
    return "\n".join(parts)


def _big(study: Study, answer: Answer, prices: Pricing | None) -> Iterator[tuple[str, str, str]]:
    yield f"{answer.robots:,}", "", "robots"
    yield f"{answer.stations:,}", "", f"open picking stations ({answer.names})"
    yield f"{study.wish.orders_per_hour:,.0f}", "", "orders an hour"
    if cost := table.cost_of(study, prices, answer.measured):
        yield cost, "", "cost of a piece"


def assumptions(wish: Wish, prices: Pricing | None) -> Iterator[str]:
    """Yields sentences about the assumptions of the answer."""
    if wish.day:
        yield (
            f"Orders are those of {wish.day}, after an hour in which those of its first hour come;"
            f" {100 * wish.late:g} % may be late. Shifts differ by the stock"
            f"{'' if wish.day.text.kind == 'day' else ' and by the orders that are drawn'}."
        )
    elif wish.orders_file:
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
    if not wish.day:
        yield (
            f"They come by chance (Poisson), {wish.orders_per_hour:,.0f} an hour without peaks;"
            f" {100 * wish.late:g} % may be late. `--demand` sizes for a day with its peak."
        )
    chosen = Policies(wish.file.policies).chosen
    decisions = ", ".join(f"{role}: {_name(policy)}" for role, policy in chosen.items())
    yield f"Decisions: {decisions}."
    yield (
        f"Shifts of {wish.hours:g} h on {wish.file.title}: {count(wish.units, 'storage unit')},"
        f" {_bins(wish)}; all replenishing stations are open, and"
        f" {_upkeep(wish)}."
    )
    if prices:
        yield prices.sentence(wish.replenishing)
    else:
        yield (
            "Without prices the answer has the fewest stations, each of which takes a person, and"
            " the fewest robots that do with them."
        )


def _bins(wish: Wish) -> str:
    stock = wish.file.stock
    return f"the stock of {Path(stock).name}" if stock else count(wish.file.items, "bin")


def _upkeep(wish: Wish) -> str:
    if not wish.realism:
        return "nothing breaks"
    return f"robots charge, fail and are repaired as in {wish.realism}"


def effort(study: Study) -> str:
    """Returns a sentence about the simulations for the answer."""
    points = len(study.verdicts) + len(study.checks)
    shifts = sum(len(v.records) for d in (study.verdicts, study.checks) for v in d.values())
    return (
        f"{count(points, 'point')} of {count(shifts, 'shift')}; in this run"
        f" {count(study.shifts, 'shift')} were simulated, {study.simulated_h:,.0f} h of work in"
        f" {study.wall_s / 60:.1f} minutes of computing."
    )


def _name(policy: object) -> str:
    return str(policy["name"]) if isinstance(policy, dict) else str(policy)


def _frontier(study: Study, prices: Pricing | None) -> str:
    rows = []
    for stations, robots in study.frontier.items():
        verdict = study.verdicts.get((robots or 0, stations))
        cells = [f"{stations:,}", f"{robots:,}" if robots else "no number does"]
        cells += [table.cost_of(study, prices, verdict) if verdict else ""] if prices else []
        rows.append(cells)
    head = ["stations", "fewest robots", *(["cost a piece"] if prices else [])]
    return document.table(head, rows, "Fewest robots for each number of stations")


def _table(study: Study, prices: Pricing | None) -> str:
    """Returns all points in two tables, each narrow enough for a sheet of paper."""
    half = len(table.FIGURES) // 2
    parts = table.FIGURES[:half], table.FIGURES[half:]
    return "".join(_part(study, prices, i, part) for i, part in enumerate(parts))


def _part(study: Study, prices: Pricing | None, number: int, columns: tuple) -> str:
    """Returns a table of some figures of all points."""
    is_last = bool(number)
    kept = table.HEAD[:2] if is_last else table.HEAD
    cost = ["cost a piece"] if prices and is_last else []
    rows = []
    for verdict, kind in table.rows(study):
        cells = table.head_of(verdict, kind)[: len(kept)]
        cells += [table.cell_of(verdict, *column) for column in columns]
        rows.append(cells + ([table.cost_of(study, prices, verdict)] if cost else []))
    head = [*kept, *(column[1] for column in columns), *cost]
    return document.table(head, rows, f"All points, part {number + 1}")


def _sheets(study: Study, prices: Pricing | None) -> dict[str, sheets.Rows]:
    return {"points": table.cells(study, prices)}
