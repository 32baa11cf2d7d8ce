# SPDX-License-Identifier: Apache-2.0
"""The report's first sheet: the results of a shift, its limit and its assumptions."""

from collections.abc import Iterator, Sequence
from datetime import date
from typing import Any

from warehouse_operations.document import page
from warehouse_operations.reports import charts, limits
from warehouse_operations.reports import exports as report_exports
from warehouse_operations.reports.comparison import Group
from warehouse_operations.reports.figures import number
from warehouse_operations.reports.limits import Limit, Window
from warehouse_operations.runs.run_files import Run

DAY = 24  # most hours of a table that is shown unfolded
# Of kpis.json: name, words, unit, factor, digits.
BIG: tuple[tuple[str, str, str, float, int], ...] = (
    ("item_throughput_per_hour", "pieces an hour", "", 1, 0),
    ("item_score", "of what the stations can at most", "%", 100, 0),
    ("late_orders_fraction", "of the orders late", "%", 100, 1),
    ("distance_per_item_m", "driven for a piece", "m", 1, 1),
)


def sheet(group: Group) -> str:
    """Returns the HTML of the first sheet about one configuration."""
    return "\n".join(
        [
            page.opening(question(group), answer(group)),
            page.big(_big(group)),
            _warning(group),
            page.section(f"What limits it: {limit(group)}", page.sentences(reasons(group))),
            charts.throughput([group]).html(),
            page.section("Assumptions", page.facts(assumptions(group.runs))),
        ]
    )


def question(group: Group) -> str:
    """Returns the question that the report answers."""
    run = group.runs[0]
    return f"What does {run.config.get('site') or 'the warehouse'} do in {_hours(run)}?"


def answer(group: Group) -> str:
    """Returns the result of the shift as a sentence."""
    robots = _count(group, "robots", "robot")
    stations = _count(group, "pick_stations", "picking station")
    pieces, orders = (
        f"{_mean(group, f'{name}_throughput_per_hour'):,.0f}" for name in ("item", "order")
    )
    return (
        f"With {robots} and {stations} the warehouse picks {pieces} pieces and completes {orders}"
        f" orders an hour; {100 * _mean(group, 'late_orders_fraction'):.1f} % of the orders are"
        " late."
    )


def limit(group: Group) -> Limit:
    """Returns what limits the throughput, or where orders become late."""
    return limits.limit(limits.windows(group.runs))


def reasons(group: Group) -> Iterator[str]:
    """Yields sentences with the evidence for the limit, and the times in which it holds."""
    parts = limits.windows(group.runs)
    chosen = limits.limiting(parts)
    if when := limits.when(parts):
        late = limits.share_of_late(parts, chosen)
        then = f": {100 * late:.0f} % of the late orders became late then" if late else ""
        yield f"From {when}{then}."
    yield _reason(limits.limit(parts), limits.merged(chosen))


def _reason(limit: Limit, then: Window) -> str:
    """Returns the figures that show a limit, in the time in which it holds."""
    waits, idle = f"{100 * then.queue:.0f} %", f"{100 * then.idle:.0f} %"
    of_bound = f"{100 * then.of_bound:.0f} % of what they can at most"
    late = 100 * (then.delay - 1)
    return {
        Limit.STATIONS: (
            f"They pick {of_bound}. Robots wait for them {waits} of their time: more robots would"
            " bring little, more stations or quicker pickers would bring more."
        ),
        Limit.REPLENISHING: (
            f"They work {100 * then.replenishing:.0f} % of their time, while robots have nothing to"
            f" do for {idle} of theirs: stock comes too late for what is ordered."
        ),
        Limit.ORDERS: (
            f"Stations pick {of_bound}, and robots have nothing to do for {idle} of their time:"
            " there are too few orders, or too little stock of what is ordered."
        ),
        Limit.STREETS: (
            f"Stations pick {of_bound}, and robots take {late:.0f} % longer than their ways would"
            " without others on them: wider aisles or fewer robots would help."
        ),
        Limit.ROBOTS: (
            f"Stations pick {of_bound} and wait for units meanwhile; robots are idle for {idle} and"
            f" wait for stations {waits} of their time: more robots would bring more."
        ),
    }[limit]


def by_hour(group: Group, label: str) -> str:
    """Returns a table of the shift hour by hour: a mean of its runs. label: its accessible name."""
    head, *rows = report_exports.hours(group)
    shown = [[str(name), *(_cell(cell) for cell in cells)] for name, *cells in rows]
    write = page.table if len(shown) <= DAY else page.behind
    return write([str(heading) for heading in head], shown, label)


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:,.0f}"


def assumptions(runs: Sequence[Run], warm_up: str = "") -> Iterator[tuple[str, str]]:
    """Yields what the runs have in common, as (term, fact).

    warm_up: words for the minutes left out at the beginning, or "".
    """
    facts = [dict(_facts(run)) for run in runs]
    for term, fact in facts[0].items():
        if all(others.get(term) == fact for others in facts):
            yield term, fact
    seeds = sorted({run.seed for run in runs})
    yield "Seeds", f"{_listed(seeds)} ({len(runs)} {'shift' if len(runs) == 1 else 'shifts'})"
    yield from _origin(runs)
    yield "Warm-up", warm_up or "nothing is left out: stations begin without units"


def common(runs: Sequence[Run]) -> Iterator[str]:
    """Yields words for the conditions that all runs share, for the top of the page."""
    conditions = [list(_conditions(run)) for run in runs]
    yield from (words for words in conditions[0] if all(words in others for others in conditions))


def _conditions(run: Run) -> Iterator[str]:
    yield run.config.get("site", "")
    yield _hours(run)
    yield "simulated robots" if run.config.get("physics") else "ideal robots"


def _facts(run: Run) -> Iterator[tuple[str, str]]:
    config, kpis = run.config, run.kpis
    yield "Warehouse", config.get("site", "")
    yield "Simulated", _hours(run)
    yield "Robots", f"{kpis['robots']:,.0f}"
    picking, other = (f"{kpis[f'{kind}_stations']:,.0f}" for kind in ("pick", "replenish"))
    yield "Stations", f"{picking} picking, {other} replenishing"
    yield "Orders", config.get("orders", "")
    if config.get("physics"):
        day = config.get("realism", "ideal")
        yield "Traffic", f"robots with bodies, motors and sensors, on a day that is {day}"
    else:
        yield "Traffic", "none: ideal robots do not meet; simulate with physics to see its cost"
    if policies := config.get("policies", {}):
        yield "Decisions", ", ".join(f"{k}: {_word(v)}" for k, v in policies.items())


def _origin(runs: Sequence[Run]) -> Iterator[tuple[str, str]]:
    """Yields the date and the version of the simulation; runs of older versions have neither."""
    dates = sorted({run.data["date"][:10] for run in runs if "date" in run.data})
    if dates:
        days = [date.fromisoformat(date_).strftime("%-d %B %Y") for date_ in dates]
        yield "Date", days[0] if len(days) == 1 else f"{days[0]} to {days[-1]}"
    versions = sorted({run.data["version"] for run in runs if run.data.get("version")})
    if versions:
        yield "Version", ", ".join(versions)


def _big(group: Group) -> Iterator[tuple[str, str, str]]:
    for kpi, words, unit, factor, digits in BIG:
        figure, _, half = number(group.estimate(kpi), factor, digits).partition(" ± ")
        yield f"{figure} {unit}".strip(), f"± {half}" if half else "", words


def _warning(group: Group) -> str:
    collisions = group.estimate("collisions").mean
    return f'<p class="warning">{collisions:g} collisions.</p>' if collisions else ""


def _hours(run: Run) -> str:
    seconds = run.kpis["simulated_s"]
    return f"{seconds / 3600:.3g} h" if seconds >= 3600 else f"{seconds / 60:.3g} min"


def _listed(seeds: Sequence[int]) -> str:
    """Returns numbers as text; those in a row by the first and the last."""
    if len(seeds) > 2 and seeds[-1] - seeds[0] == len(seeds) - 1:
        return f"{seeds[0]} to {seeds[-1]}"
    return ", ".join(map(str, seeds))


def _word(policy: Any) -> str:
    return str(policy.get("name", policy) if isinstance(policy, dict) else policy)


def _mean(group: Group, kpi: str) -> float:
    return group.estimate(kpi).mean


def _count(group: Group, kpi: str, noun: str) -> str:
    count = f"{_mean(group, kpi):,.0f}"
    return f"{count} {noun}{'' if count == '1' else 's'}"
