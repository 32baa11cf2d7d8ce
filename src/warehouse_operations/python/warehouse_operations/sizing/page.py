# SPDX-License-Identifier: Apache-2.0
"""Writes the report of a sizing: report.html, figure.png, points.csv, .xlsx and .txt.

The first page is to be handed on: the answer, its figure, what limits it, what was assumed.
"""

from collections.abc import Iterator
from pathlib import Path

from warehouse_operations.document import page as document
from warehouse_operations.document import sheets
from warehouse_operations.policies import Policies
from warehouse_operations.runs.run_files import REPORT
from warehouse_operations.runs.version import version
from warehouse_operations.sizing import figures, table
from warehouse_operations.sizing.answer import Answer
from warehouse_operations.sizing.prices import Prices
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.wish import Wish, count

KNEES = (
    "Bands are 95 % confidence intervals of the mean (Student's t over seeds). A triangle is the"
    " knee: the fewest robots with 99 % of the most orders an hour that so many stations complete."
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
    sheets.write_xlsx(folder / "points.xlsx", _sheets(study, prices))
    figures.write_png(folder / "figure.png", study, _chosen(answer))
    return folder / REPORT


def _chosen(answer: Answer | None) -> tuple[int, int] | None:
    return (answer.robots, answer.stations) if answer else None


def page(study: Study, answer: Answer | None, why: str, prices: Prices | None) -> str:
    """Returns the HTML of the report."""
    title = f"How many robots? {study.wish.file.title}"
    return document.document(
        title,
        "Sizing report",
        f"{document.today()}, version {version()}",
        _first(study, answer, why, prices),
        _rest(study, answer, prices),
    )


def _first(study: Study, answer: Answer | None, why: str, prices: Prices | None) -> str:
    """Returns the sheet that is handed on."""
    wish = study.wish
    orders = f"{wish.orders_per_hour:,.0f} orders an hour"
    asked = f"How many robots does {wish.file.title} need for {orders}?"
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


def _rest(study: Study, answer: Answer | None, prices: Prices | None) -> str:
    chosen = _chosen(answer)
    curves = figures.lateness(study, chosen).html() + f'<p class="note">{KNEES}</p>'
    links = sheets.links(_sheets(study, prices), "points")
    parts = [
        document.section("How many orders are late", curves),
        document.section("Fewest robots for each number of stations", _frontier(study, prices)),
        document.section("How busy they are", figures.use(study, chosen).html()),
        document.section("All points", _table(study, prices) + links, MISSED),
        document.section("What it took", f"<p>{effort(study)}</p>"),
    ]
    return "\n".join(parts)


def _big(study: Study, answer: Answer, prices: Prices | None) -> Iterator[tuple[str, str, str]]:
    yield f"{answer.robots:,}", "", "robots"
    yield f"{answer.stations:,}", "", f"open picking stations ({answer.names})"
    yield f"{study.wish.orders_per_hour:,.0f}", "", "orders an hour"
    if cost := table.cost_of(study, prices, answer.measured):
        yield cost, "", "cost of a piece"


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
    decisions = ", ".join(f"{role}: {_name(policy)}" for role, policy in chosen.items())
    yield f"Decisions: {decisions}."
    yield (
        f"Shifts of {wish.hours:g} h on {wish.file.title}: {count(wish.units, 'storage unit')},"
        f" {_bins(wish)}; all replenishing stations are open, and nothing breaks."
    )
    if prices:
        yield (
            f"Prices: robot {prices.robot:,g}, station {prices.station:,g}, storage unit"
            f" {prices.unit:,g}, used up in {prices.hours:,g} hours; {prices.hour:,g} an hour for"
            f" the person at each open picking station and at {_all(wish.replenishing)}."
            " The answer is the cheapest point that does."
        )
    else:
        yield (
            "Without prices the answer has the fewest stations, each of which takes a person, and"
            " the fewest robots that do with them."
        )


def _bins(wish: Wish) -> str:
    stock = wish.file.stock
    return f"the stock of {Path(stock).name}" if stock else count(wish.file.items, "bin")


def _all(replenishing: int) -> str:
    return f"each of {count(replenishing, 'replenishing station')}"


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


def _frontier(study: Study, prices: Prices | None) -> str:
    rows = []
    for stations, robots in study.frontier.items():
        verdict = study.verdicts.get((robots or 0, stations))
        cells = [f"{stations:,}", f"{robots:,}" if robots else "no number does"]
        cells += [table.cost_of(study, prices, verdict) if verdict else ""] if prices else []
        rows.append(cells)
    head = ["stations", "fewest robots", *(["cost a piece"] if prices else [])]
    return document.table(head, rows, "Fewest robots for each number of stations")


def _table(study: Study, prices: Prices | None) -> str:
    """Returns all points in two tables, each narrow enough for a sheet of paper."""
    half = len(table.FIGURES) // 2
    parts = table.FIGURES[:half], table.FIGURES[half:]
    return "".join(_part(study, prices, i, part) for i, part in enumerate(parts))


def _part(study: Study, prices: Prices | None, number: int, columns: tuple) -> str:
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


def _sheets(study: Study, prices: Prices | None) -> dict[str, sheets.Rows]:
    return {"points": table.cells(study, prices)}
