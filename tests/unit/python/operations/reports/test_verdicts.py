# SPDX-License-Identifier: Apache-2.0
"""How configurations differ: after the warm-up, in several figures, corrected for their number."""

from pathlib import Path

import numpy as np
import pytest
from instance_file import write_instance
from scipy import stats

from warehouse_operations.reports import comparison, report, verdicts
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs.simulation import Description, simulate

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
    configurations = groups((11.0, 9.0, 20.0))
    cut = verdicts.warm_up(configurations)
    assert FILLS - 5 <= cut <= 60
    figures = verdicts.figures_of(configurations[0].runs[0], cut)
    assert figures["pieces_per_hour"] == pytest.approx(600, rel=0.01)
    assert figures["metres_per_piece"] == pytest.approx(12, rel=0.03)
    assert figures["turnover_s"] == pytest.approx(13 * 60, rel=0.01)


def test_each_figure_has_a_verdict_corrected_for_all():
    configurations = groups((11.0, 12.0, 13.0))
    by_figure = {verdict.figure: verdict for verdict in verdicts.verdicts(configurations)}
    assert list(by_figure) == ["pieces_per_hour", "metres_per_piece", "turnover_s"]
    cut = verdicts.warm_up(configurations)
    alone = []
    for name in by_figure:
        a, b = ([verdicts.figures_of(r, cut)[name] for r in group.runs] for group in configurations)
        alone.append(float(stats.ttest_ind(b, a, equal_var=False).pvalue))
    corrected = comparison.holm(alone)
    assert [verdict.p_value for verdict in by_figure.values()] == pytest.approx(corrected)
    assert by_figure["pieces_per_hour"].difference.significant
    assert not by_figure["turnover_s"].difference.significant
    text = str(by_figure["pieces_per_hour"])
    assert text.startswith("orders: b: +10.") and "pieces an hour against orders: a (sign" in text
    assert "p < 1e-6" in text and "95 %: +" in text and "effect +" in text


def test_corrected_p_and_interval_say_the_same():
    rng = np.random.default_rng(2)
    checked = set()
    for _ in range(200):
        differences = [
            comparison.difference_of(
                dict(enumerate(rng.normal(10, 1, 5))), dict(enumerate(rng.normal(10 + d, 1, 5)))
            )
            for d in (0.0, 1.5, 3.0)
        ]
        corrected = comparison.holm([difference.p_value for difference in differences])
        for difference, p_value in zip(differences, corrected):
            now = difference.corrected(p_value)
            assert now.significant == (abs(now.estimate.mean) > now.estimate.half)
            checked.add((difference.significant, now.significant))
    # Some are significant alone, and no more among others: their interval reaches 0, too.
    assert {(True, True), (True, False), (False, False)} <= checked
    # Nothing else is corrected with it: Student's own.
    alone = differences[0].corrected(differences[0].p_value)
    assert alone.estimate.half == pytest.approx(differences[0].estimate.half)


def test_two_seeds_have_no_interval_and_no_significance():
    first = [run("a", seed, 10.0, 12.0, 13.0) for seed in (1, 2)]
    other = [run("b", seed, 17.8, 12.0, 13.0) for seed in (1, 2)]
    configurations = comparison.grouped([*first, *other])
    assert verdicts.verdicts(configurations) == []
    assert np.isnan(configurations[0].estimate("item_throughput_per_hour").half)
    sentences = list(report.verdicts(configurations))
    assert sentences == [
        "orders: b: +0.0 % pieces an hour against orders: a"
        " (2 runs: too few to exclude chance; simulate 3 seeds or more)"
    ]


def test_equal_shifts_do_not_differ(tmp_path):
    instance = write_instance(tmp_path / "small.xinst", bots=3, picking=1, replenishing=1, rows=3)
    made = []
    for name in ("pile-on", {"name": "pile-on"}):
        for seed in (1, 2, 3):
            described = Description(
                instance=str(instance),
                seconds=600,
                physics=False,
                seed=seed,
                policies={"orders": name},
            )
            made.append(simulate(described, tmp_path / f"{len(made)}")[0])
    first, second = (
        comparison.Group(name, tuple(made[i : i + 3])) for i, name in ((0, "a"), (3, "b"))
    )
    all_verdicts = verdicts.verdicts([first, second])
    assert len(all_verdicts) == 3 and all(
        verdict.p_value == 1 and not verdict.difference.effect for verdict in all_verdicts
    )
    assert all("not significant, p = 1" in line for line in report.verdicts([first, second]))
    # What is left after the warm-up adds up to what kpis.json has of the whole shift.
    shift = made[0]
    whole = verdicts.figures_of(shift, 0)
    assert whole["pieces_per_hour"] == pytest.approx(shift.kpis["item_throughput_per_hour"])
    assert whole["metres_per_piece"] == pytest.approx(shift.kpis["distance_per_item_m"], rel=0.02)
    assert whole["turnover_s"] == pytest.approx(shift.kpis["order_turnover_s"]["median"], abs=0.1)
