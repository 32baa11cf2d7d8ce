# SPDX-License-Identifier: Apache-2.0
"""The report's first page: what a shift came to, what limits it, and on which assumptions."""

from collections.abc import Iterator
from html import escape
from typing import Any

from warehouse_operations.comparison import Group

SATURATED = 0.95  # of the stations' upper bound: they are what limits
IDLE = 0.15  # of the robots' time: they lack work
HELD_UP = 1.15  # driven over planned time: traffic holds robots up


def opening(group: Group, figures: str) -> str:
    """Returns the HTML of the answer and what limits it, with the `figures` between them."""
    return (
        f'<p class="answer">{escape(answer(group))}</p>{figures}'
        f"<p><b>What limits it: {limit(group)}.</b> {escape(reason(group))}</p>"
    )


def assumptions(group: Group) -> str:
    """Returns the HTML of what was simulated, as a list."""
    return f"<ul>{''.join(f'<li>{escape(text)}</li>' for text in _assumptions(group))}</ul>"


def answer(group: Group) -> str:
    """Returns what the shift came to as a sentence."""
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


def limit(group: Group) -> str:
    """Returns what limits the throughput: picking stations, orders, streets or robots."""
    if _mean(group, "item_score") >= SATURATED:
        return "the picking stations"
    if _shares(group).get("idle", 0.0) > IDLE:
        return "the orders and the stock"
    if _mean(group, "executed_over_planned") > HELD_UP:
        return "the streets"
    return "the robots"


def reason(group: Group) -> str:
    """Returns the figures from which the limit follows, as a sentence."""
    shares = _shares(group)
    waits, idle = (f"{100 * shares.get(name, 0.0):.0f} %" for name in ("queue", "idle"))
    of_bound = f"{100 * _mean(group, 'item_score'):.0f} % of what they can at most"
    late = 100 * (_mean(group, "executed_over_planned") - 1)
    return {
        "the picking stations": (
            f"They pick {of_bound}. Robots wait for them {waits} of their time: more robots would"
            " bring next to nothing, more stations or quicker pickers would."
        ),
        "the orders and the stock": (
            f"Stations pick {of_bound}, and robots have nothing to do for {idle} of their time:"
            " there are too few orders, or too little stock of what is ordered."
        ),
        "the streets": (
            f"Stations pick {of_bound}, and robots take {late:.0f} % longer than their ways would"
            " without others on them: wider aisles or fewer robots would tell."
        ),
        "the robots": (
            f"Stations pick {of_bound} and wait for units meanwhile; robots are idle for {idle} and"
            f" wait for stations {waits} of their time: more robots would bring more."
        ),
    }[limit(group)]


def _assumptions(group: Group) -> Iterator[str]:
    config, kpis = group.runs[0].config, group.runs[0].kpis
    seeds = ", ".join(str(run.seed) for run in group.runs)
    yield f"Warehouse: {config.get('site', '')}. Simulated: {kpis['simulated_s'] / 3600:.3g} h."
    yield f"Orders: {config.get('orders', '')}. Seeds: {seeds}."
    if config.get("physics"):
        day = config.get("realism", "ideal")
        yield f"Robots with bodies, motors and sensors, on a day that is {day}."
    else:
        yield "Ideal robots, which meet no traffic: simulate with physics to see what that costs."
    yield "Nothing of the beginning is left out: stations begin without units."
    policies = config.get("policies", {})
    if policies:
        yield "Decisions: " + ", ".join(f"{k}: {_word(v)}" for k, v in policies.items()) + "."


def _word(policy: Any) -> str:
    return str(policy.get("name", policy) if isinstance(policy, dict) else policy)


def _mean(group: Group, kpi: str) -> float:
    return group.estimate(kpi).mean


def _count(group: Group, kpi: str, noun: str) -> str:
    count = f"{_mean(group, kpi):,.0f}"
    return f"{count} {noun}{'' if count == '1' else 's'}"


def _shares(group: Group) -> dict[str, float]:
    """Returns the share of the robots' time that each activity takes."""
    total: dict[str, float] = {}
    for run in group.runs:
        for activity, seconds in run.data["robots"].items():
            total[activity] = total.get(activity, 0.0) + seconds
    whole = sum(total.values()) or 1.0
    return {activity: seconds / whole for activity, seconds in total.items()}
