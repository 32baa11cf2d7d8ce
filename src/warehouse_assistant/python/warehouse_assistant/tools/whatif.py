# SPDX-License-Identifier: Apache-2.0
"""Tools: what-if runs of the hub, which compute beside what runs."""

from typing import Annotated, Any, Literal

from pydantic import Field

from warehouse_assistant.hub_client import Trouble, segment
from warehouse_assistant.toolbox import Toolbox
from warehouse_assistant.words import count, duration, listed, plain, quoted, sentence

Scenario = Annotated[
    str, Field(min_length=1, max_length=60, pattern=r"^[\w .,+=()-]+$", description="its name")
]


def add(box: Toolbox) -> None:
    """Adds the tools to a Toolbox."""

    @box.changes("Run a what-if")
    async def run_what_if(
        name: Scenario,
        layout: Annotated[
            Literal["small", "medium", "large", "huge"], Field(description="a preset")
        ] = "medium",
        robots: Annotated[int, Field(ge=0, le=20_000, description="0: the layout's")] = 0,
        stations: Annotated[int, Field(ge=0, le=1000, description="0: the layout's")] = 0,
        orders: Annotated[
            str, Field(max_length=200, description="fill, fill:N or poisson:PER_HOUR")
        ] = "fill",
        minutes: Annotated[float, Field(ge=1, le=1440, description="simulated")] = 60.0,
        seeds: Annotated[int, Field(ge=1, le=50, description="runs that are averaged")] = 3,
    ) -> str:
        """Simulates a shift with other counts of robots, stations or orders, without pictures."""
        settings = {
            "layout": layout,
            "robots": robots,
            "stations": stations,
            "orders": orders,
            "minutes": minutes,
            "seeds": seeds,
        }
        estimate = await box.hub.send("POST", "/whatif/estimate", {"settings": settings})
        body = {"name": name, "settings": settings}
        made = (await box.hub.send("POST", "/whatif/scenarios", body))["name"]
        await box.hub.send("POST", f"/whatif/scenarios/{segment(made)}/run", {})
        return (
            f"{quoted(made)} runs with {count(estimate['robots'], 'robot')} and"
            f" {count(estimate['stations'], 'station')}, for about"
            f" {duration(estimate['seconds'])}; then ask what_if_results."
        )

    @box.reads("Compare what-if runs")
    async def what_if_results(
        names: Annotated[
            list[Scenario] | None, Field(max_length=6, description="none: all")
        ] = None,
    ) -> str:
        """Lists what-if runs with settings, progress and figures."""
        answer = await box.hub.get("/whatif/scenarios")
        rows = [r for r in answer["scenarios"] if not names or r.get("name") in names]
        if not rows:
            raise Trouble("There is no such what-if run. run_what_if starts one.")
        return "\n".join(map(_row, rows))


def _row(row: dict[str, Any]) -> str:
    settings = row.get("settings") or {}
    chosen = listed(f"{k} {plain(v, 40)}" for k, v in settings.items() if v and k != "policies")
    text = f"{quoted(row['name'])}: {chosen}; {plain(row.get('state', ''), 20)}"
    if row.get("error"):
        return f"{text}: {quoted(row['error'], 300)}"
    if row.get("left"):
        text += f", {duration(row['left'])} left"
    summary = row.get("summary") or {}
    figures = summary.get("figures") or {}
    if figures:
        text += f"; {listed(map(_figure, figures.items()), 20)}"
    limit = (summary.get("limit") or {}).get("what")
    return sentence(text + (f"; limited by {quoted(limit)}" if limit else ""))


def _figure(named: tuple[str, Any]) -> str:
    name, figure = named
    text = f"{plain(name, 40)} {figure['mean']:.4g}"
    return text + (f" ± {figure['half']:.2g}" if figure.get("half") else "")
