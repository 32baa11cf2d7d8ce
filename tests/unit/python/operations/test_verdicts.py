# SPDX-License-Identifier: Apache-2.0
"""How configurations differ: after the warm-up, in several figures, corrected for their number."""

from pathlib import Path

import numpy as np
import pytest
from instance_file import write_instance
from scipy import stats

from warehouse_operations import comparison, report, runs, verdicts
from warehouse_operations.simulation import Description, simulate

FILLS = 30  # minutes until the shifts below are at work


def run(orders, seed, pieces, metres, minutes):
    """An hour of `pieces` a minute, `metres` for each and orders that take so many minutes."""
    rng = np.random.default_rng(seed)
    picked = np.r_[np.linspace(0, pieces, FILLS), np.full(120 - FILLS, pieces)]
    picked = picked + rng.normal(0, 0.1, 120)
    at = np.arange(120) * 60.0
    # Orders are quick, and ways long, for as long as the warehouse is empty.
    takes = 60 * np.where(at < 60 * FILLS, 1.0, minutes) + rng.normal(0, 5, 120)
    data = {
        "config": {"site": "x", "orders": orders},
        "seed": seed,
        "intervals": {"seconds": 60.0, "picked": picked.tolist()},
        "driven_m": (picked * np.where(at < 60 * FILLS, 99.0, metres + 0.01 * seed)).tolist(),
        "completed_s": at.tolist(),
        "turnover_s": takes.tolist(),
    }
    return runs.Run(Path(orders), {"item_throughput_per_hour": 1.0}, data)


def groups(other):
    first = [run("a", seed, 10.0, 12.0, 13.0) for seed in range(5)]
    return comparison.grouped([*first, *(run("b", seed + 10, *other) for seed in range(5))])


def test_the_warm_up_is_left_out():
    found = groups((11.0, 9.0, 20.0))
    cut = verdicts.warm_up(found)
    assert FILLS - 5 <= cut <= 60
    figures = verdicts.figures_of(found[0].runs[0], cut)
    assert figures["pieces_per_hour"] == pytest.approx(600, rel=0.01)
    assert figures["metres_per_piece"] == pytest.approx(12, rel=0.03)
    assert figures["turnover_s"] == pytest.approx(13 * 60, rel=0.01)


def test_each_figure_has_a_verdict_corrected_for_all():
    found = groups((11.0, 12.0, 13.0))
    told = {one.figure: one for one in verdicts.verdicts(found)}
    assert list(told) == ["pieces_per_hour", "metres_per_piece", "turnover_s"]
    cut = verdicts.warm_up(found)
    alone = []
    for name in told:
        a, b = ([verdicts.figures_of(r, cut)[name] for r in group.runs] for group in found)
        alone.append(float(stats.ttest_ind(b, a, equal_var=False).pvalue))
    corrected = comparison.holm(alone)
    assert [one.p_value for one in told.values()] == pytest.approx(corrected)
    assert told["pieces_per_hour"].difference.significant
    assert not told["turnover_s"].difference.significant
    text = str(told["pieces_per_hour"])
    assert text.startswith("orders: b: +10.") and "pieces an hour against orders: a (sign" in text
    assert "p < 1e-6" in text and "95 %: +" in text and "effect +" in text


def test_equal_shifts_do_not_differ(tmp_path):
    instance = write_instance(tmp_path / "small.xinst", bots=3, picking=1, replenishing=1, rows=3)
    made = []
    for name in ("pile-on", {"name": "pile-on"}):
        for seed in (1, 2):
            described = Description(
                instance=str(instance),
                seconds=1200,
                physics=False,
                seed=seed,
                policies={"orders": name},
            )
            made.append(simulate(described, tmp_path / f"{len(made)}")[0])
    first, second = (
        comparison.Group(name, tuple(made[i : i + 2])) for i, name in ((0, "a"), (2, "b"))
    )
    told = verdicts.verdicts([first, second])
    assert len(told) == 3 and all(one.p_value == 1 and not one.difference.effect for one in told)
    assert all("not significant, p = 1" in line for line in report.verdicts([first, second]))
    # What is left after the warm-up adds up to what kpis.json has of the whole shift.
    shift = made[0]
    whole = verdicts.figures_of(shift, 0)
    assert whole["pieces_per_hour"] == pytest.approx(shift.kpis["item_throughput_per_hour"])
    assert whole["metres_per_piece"] == pytest.approx(shift.kpis["distance_per_item_m"], rel=0.02)
    assert whole["turnover_s"] == pytest.approx(shift.kpis["order_turnover_s"]["median"], abs=0.1)
