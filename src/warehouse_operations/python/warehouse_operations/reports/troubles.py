# SPDX-License-Identifier: Apache-2.0
"""The troubles of a day in a report, and the cost of each."""

from collections.abc import Iterator

from warehouse_operations.document import page
from warehouse_operations.reports.comparison import Group
from warehouse_operations.reports.figures import number
from warehouse_operations.runs.run_files import Run

# Of kpis.json: name, words, unit, factor, digits.
TROUBLES: tuple[tuple[str, str, str, float, int], ...] = (
    ("availability", "Availability: robot hours at work", "%", 100, 2),
    ("mtbf_h", "Robot hours between failures (MTBF)", "h", 1, 1),
    ("mttr_s", "Time to repair, mean (MTTR)", "min", 1 / 60, 1),
    ("items_lost_to_failures", "Pieces not picked for want of robots", "", 1, 0),
    ("items_fallen", "Items that fell off their storage units", "", 1, 0),
    ("items_on_floor", "Items that lie on the floor at the end", "", 1, 0),
    ("pieces_on_floor", "Pieces out of stock with them", "", 1, 0),
    ("person_hours", "Hours of people on the floor", "h", 1, 2),
    ("slowed_fraction", "Robot hours slowed down for people", "%", 100, 2),
    ("stopped_fraction", "Robot hours standing for people", "%", 100, 2),
    ("items_lost_to_people", "Pieces not picked meanwhile", "", 1, 0),
    ("charging_fraction", "Robot hours at a charging place", "%", 100, 1),
    ("charge_mean", "Charge of batteries at the end, mean", "%", 100, 0),
    ("charge_least", "Charge of the emptiest at the end", "%", 100, 0),
)
COLUMNS = ("Robots", "times", "repaired after, mean", "robot hours", "pieces not picked")
NOTE = (
    "Pieces not picked are estimated from those picked in the robot hours at work: what is lost if"
    " stations wait for robots."
)


def section(group: Group, name: str = "") -> str:
    """Returns the section of a report about troubles: those of the first run, and their costs in
    all runs.

    name: of the group, after a colon. Returns "" for runs without troubles.
    """
    costs = [
        [words, number(group.estimate(kpi), factor, digits, unit)]
        for kpi, words, unit, factor, digits in TROUBLES
        if all(kpi in run.kpis for run in group.runs)
    ]
    each = [[str(cell) for cell in row] for row in _each_trouble(group.runs[0])]
    if not costs and not each:
        return ""
    table = page.table(COLUMNS, each, f"Troubles{name}") if each else ""
    cost = page.table((), costs, f"What troubles cost{name}")
    return page.section(f"Troubles of the day{name}", f"{table}{cost}", NOTE)


def _each_trouble(run: Run) -> Iterator[tuple[str, ...]]:
    """Yields (words, times, mean time to repair, robot hours, pieces not picked) for each kind."""
    all_h = run.data.get("robot_h", 0.0)
    failures = run.data.get("failures") or []
    charging_h = run.kpis.get("charging_fraction", 0.0) * all_h
    at_work_h = all_h - charging_h - sum(failure["down_h"] for failure in failures)
    an_hour = run.kpis["items_picked"] / at_work_h if at_work_h > 0 else 0.0
    for failure in failures:
        repair = f"{failure['mean_repair_s'] / 60:.1f} min" if failure["repairs"] else ""
        pieces = f"{failure['down_h'] * an_hour:.0f}"
        yield failure["kind"], failure["count"], repair, f"{failure['robot_h']:.2f}", pieces
    if charging_h:
        yield "charge", "", "", f"{charging_h:.2f}", f"{charging_h * an_hour:.0f}"
    for words, count in (run.data.get("mishaps") or {}).items():
        yield words, count, "", "", ""
