# SPDX-License-Identifier: Apache-2.0
"""What the benchmarks measured, against what they are to reach, as one table."""

import math
import operator

BEYOND = {">=": operator.ge, "<=": operator.le}


class Table:
    """Lines of: what, figure, the same by CPU seconds, limit, and whether it is met."""

    def __init__(self):
        self._lines = []

    def add(self, what, figure, cpu=None, limit=None, unit=""):
        """`limit` is such as ">= 12". A `figure` that is text says why there is none."""
        self._lines.append((what, _text(figure, unit), _text(cpu, ""), limit or "", ""))
        if limit and isinstance(figure, (int, float)):
            word, value = limit.split()
            met = [BEYOND[word](f, float(value)) for f in (figure, cpu) if f is not None]
            verdict = "yes" if met[0] else "by CPU" if any(met) else "NO"
            self._lines[-1] = (*self._lines[-1][:4], verdict)

    def __str__(self):
        rows = [("what", "figure", "by CPU s", "limit", "met"), *self._lines]
        rows.insert(1, ("-",) * 5)
        widths = [max(len(row[i]) for row in rows) for i in range(5)]
        return "\n".join(_row(row, widths) for row in rows)


def _row(row, widths):
    fill = "-" if row[0] == "-" else " "
    cells = [row[0].ljust(widths[0], fill)]
    cells += [cell.rjust(width, fill) for cell, width in zip(row[1:], widths[1:])]
    return "| " + " | ".join(cells) + " |"


def _text(figure, unit):
    if figure is None:
        return ""
    if isinstance(figure, str):
        return figure
    digits = 0 if figure >= 100 else max(0, 2 - math.floor(math.log10(figure)) if figure else 0)
    return f"{figure:,.{min(digits, 4)}f}{unit and ' ' + unit}"
