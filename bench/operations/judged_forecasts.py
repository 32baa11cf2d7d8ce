# SPDX-License-Identifier: Apache-2.0
"""What forecasts were worth: the tables and the figure of judged forecasts, from their rows.

A row is a forecast, as forecast_bench keeps it. Intervals are of 95 %, by a bootstrap over groups:
forecasts of one shift, and of shifts with the same orders, share their chance.
"""

import numpy as np
from judged_shift import HORIZONS, NEAR_BOUND

LEVELS = (0.1, 0.5, 0.9)
HELD = 0.8  # of the outcomes are to be in the band
DRAWS, FEWEST = 2000, 5  # of a bootstrap; groups for one
BINS = np.linspace(0, 1, 6)  # of odds
HEAD = (
    "| | orders | realism | forecasts, shifts | in the band: 10 min | 30 min | 60 min"
    " | bias, 30 min | median error: 10 min | 30 min | 60 min | of the rate, 30 min"
    " | Brier | of the base rate |"
)
WIDTHS = "| | half of a band: 10 min | 30 min | 60 min | factor: 10 min | 30 min | 60 min |"
BIASES = "| | orders | forecasts | bias, 10 min | 30 min | 60 min |"


class Judged:
    """Some rows at a horizon [min], as arrays with an element a forecast: the truth, the band
    (p10, p50, p90) and what the rate of the last half hour says, all in orders done; and by how
    many more orders came in the runs than in the shift."""

    def __init__(self, rows, horizon):
        at = [row["horizons"][str(horizon)] for row in rows]
        self.truth = np.array([each["truth"]["done"] for each in at], float)
        done = [np.quantile(each["done"], LEVELS, method="weibull") for each in at]
        self.low, self.middle, self.high = np.array(done).T
        self.rate = np.array([each["rate"] for each in at])
        came = [np.median(each["done"]) + np.median(each["open"]) for each in at]
        self.came = np.array(came) - self.truth - [each["truth"]["open"] for each in at]
        self.groups = [(*row["key"][:2], row["key"][4]) for row in rows]

    def inside(self):
        return (self.low <= self.truth) & (self.truth <= self.high)

    def errors(self, forecast):
        return np.abs(forecast / self.truth - 1)

    def bias(self):
        return np.mean(self.middle / self.truth - 1)

    def bias_by_orders(self):
        """The part of the bias that is by chance of the orders drawn. The other is by robots."""
        return np.mean(self.came / self.truth)

    def half(self):
        """Half of a band, as a part of its median."""
        return np.mean((self.high - self.low) / 2 / self.middle)

    def stretches(self):
        """The factor that the half of a band towards the outcome needs to hold it."""
        above = self.truth > self.middle
        half = np.where(above, self.high - self.middle, self.middle - self.low)
        return np.abs(self.truth - self.middle) / np.maximum(half, 0.5)


def tables(rows):
    """Returns the tables of the documentation, as Markdown."""
    return "\n\n".join((judged(rows), widths(rows), biases(rows)))


def judged(rows):
    """Returns a table with a line a case, a size and all."""
    lines = [HEAD, rule(HEAD)]
    sizes = dict.fromkeys(row["key"][0] for row in rows)
    for size in sizes:
        of_size = [row for row in rows if row["key"][0] == size]
        for case in dict.fromkeys(tuple(row["key"][1:4]) for row in of_size):
            these = [row for row in of_size if tuple(row["key"][1:4]) == case]
            demand, realism, closes = case
            orders = orders_of(size, demand) + (f", {closes} closes" if closes else "")
            lines.append(line((f"`{size}`", orders, realism), these))
        lines.append(line((f"`{size}`", "all", ""), of_size))
    if len(sizes) > 1:
        lines.append(line(("all", "", ""), rows))
    return "\n".join(lines)


def line(names, rows):
    at = [Judged(rows, horizon) for horizon in HORIZONS]
    half_hour = at[HORIZONS.index(30)]
    shifts = {tuple(row["key"]) for row in rows}
    held = (percent(each.inside().mean()) + sure(each.inside(), each.groups) for each in at)
    errors = (f"{100 * np.median(each.errors(each.middle)):.1f} %" for each in at)
    rate = f"{100 * np.median(half_hour.errors(half_hour.rate)):.1f} %"
    bias = f"{100 * half_hour.bias():+.1f} %"
    cells = (*names, f"{len(rows)} of {len(shifts)}", *held, bias, *errors, rate, *briers(rows))
    return f"| {' | '.join(cells)} |"


def orders_of(size, demand):
    names = {"fill": "`fill`", "poisson": f"{NEAR_BOUND[size]:,} an hour"}
    return names.get(demand, "a day with a peak")


def widths(rows):
    """Returns a table of how wide bands are, and how wide they should be, a line a size."""
    lines = [WIDTHS, rule(WIDTHS)]
    for size in dict.fromkeys(row["key"][0] for row in rows):
        at = [Judged([row for row in rows if row["key"][0] == size], each) for each in HORIZONS]
        halves = (f"{100 * each.half():.1f} %" for each in at)
        factors = (factor(each.stretches(), each.groups) for each in at)
        lines.append(f"| `{size}` | {' | '.join((*halves, *factors))} |")
    return "\n".join(lines)


def factor(stretches, groups):
    """The factor that bands need to hold HELD of the outcomes, in words."""
    middle = np.quantile(stretches, HELD)
    low, high = np.quantile(resampled(stretches, groups, HELD), (0.025, 0.975))
    return f"{middle:.1f} ({low:.1f} to {high:.1f})"


def biases(rows):
    """Returns a table of the bias where orders come by themselves; in brackets the part of the
    orders that came."""
    lines = [BIASES, rule(BIASES)]
    for size, demand in dict.fromkeys(tuple(row["key"][:2]) for row in rows):
        if demand == "fill":
            continue
        these = [row for row in rows if row["key"][:2] == [size, demand]]
        at = [Judged(these, horizon) for horizon in HORIZONS]
        cells = (
            f"{100 * each.bias():+.1f} % ({100 * each.bias_by_orders():+.1f} %)" for each in at
        )
        names = f"| `{size}` | {orders_of(size, demand)} | {len(these)} |"
        lines.append(f"{names} {' | '.join(cells)} |")
    return "\n".join(lines)


def rule(head):
    return "|" + "---|" * (head.count("|") - 1)


def percent(share):
    return f"{100 * share:.0f} %"


def sure(values, groups):
    """The interval of a share, in words; of a few groups nothing."""
    if len(set(groups)) < FEWEST:
        return ""
    low, high = 100 * np.quantile(resampled(values, groups), (0.025, 0.975))
    return f" ({low:.0f} to {high:.0f})"


def resampled(values, groups, quantile=None):
    """Means, or quantiles, of values drawn by whole groups, many times."""
    by_group = {}
    for group, value in zip(groups, values):
        by_group.setdefault(group, []).append(value)
    parts = [np.asarray(each, float) for each in by_group.values()]
    draws = np.random.default_rng(1).integers(len(parts), size=(DRAWS, len(parts)))
    drawn = (np.concatenate([parts[i] for i in draw]) for draw in draws)
    return [each.mean() if quantile is None else np.quantile(each, quantile) for each in drawn]


def briers(rows):
    """Brier's score of the odds of late orders, and that of their base rate."""
    odds, late = odds_and_late(rows)
    if not late.any():
        return "none was late", ""
    return f"{np.mean((odds - late) ** 2):.3f}", f"{np.var(late):.3f}"


def odds_and_late(rows):
    """The odds of all orders that were known and due, and whether they were late."""
    pairs = np.array([pair for row in rows for pair in row["late"]], float).reshape(-1, 2)
    return pairs.T


def draw_reliability(rows, path):
    """Draws how often orders with the same odds were late: on the diagonal, odds are right."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (upper, lower) = plt.subplots(
        2, figsize=(5, 5.5), sharex=True, height_ratios=(3, 1), layout="constrained"
    )
    upper.plot((0, 1), (0, 1), color="#666666", lw=1)
    for size, colour in (("medium", "#0072B2"), ("large", "#D55E00")):
        odds, late = odds_and_late([row for row in rows if row["key"][0] == size])
        if not len(odds):
            continue
        which = np.minimum(np.digitize(odds, BINS) - 1, len(BINS) - 2)
        count = np.bincount(which, minlength=len(BINS) - 1)
        known = count > 0
        mean, share = (
            np.bincount(which, values, len(BINS) - 1)[known] / count[known]
            for values in (odds, late)
        )
        spread = 1.96 * np.sqrt(share * (1 - share) / count[known])
        label = f"{size}: {len(odds):,} orders"
        upper.errorbar(mean, share, spread, fmt="o-", color=colour, capsize=3, label=label)
        lower.step(BINS, np.append(count, count[-1]), where="post", color=colour)
    upper.set(ylabel="share that was late", ylim=(-0.05, 1.05))
    upper.legend(frameon=False)
    lower.set(xlabel="odds of being late, by the forecast", ylabel="orders", yscale="log")
    figure.savefig(path, dpi=110)
