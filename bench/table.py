# SPDX-License-Identifier: Apache-2.0
"""Figures against what they are to reach and what they were before, as a Markdown table."""

import math
import operator

BEYOND = {">=": operator.ge, "<=": operator.le}
MUCH = 1.2  # times slower than before is worth a word

RUN = ("what", "figure", "by the wall clock", "ratio to the arrays", "before", "limit", "")
README = ("what", "figure", "by the wall clock", "ratio to the arrays", "limit", "", "measured at")


def of_run(figures, history):
    """`figures`: {part: [Figure, ...]} of a run whose line the history doesn't have yet."""
    rows = []
    for part, values in figures.items():
        before = history.newest(part)
        rows += [_row(f) | _compared(f, *before.get(f.name, (None, None))) for f in values]
    return _text(RUN, rows)


def of_part(history, part):
    """The newest figures of a part, wherever they were measured."""
    rows = [
        _row(figure) | {"measured at": _place(line)}
        for figure, line in history.newest(part).values()
    ]
    return _text(README, rows)


def met(figure):
    """Whether a figure keeps its limit; by CPU time or by the wall clock, as it has them."""
    if not figure.limit:
        return ""
    if figure.value is None:
        return "nothing came"
    word, limit = figure.limit.split()
    beyond = [BEYOND[word](f, float(limit)) for f in (figure.wall, figure.value) if f is not None]
    return "met" if beyond[0] else "met by CPU" if any(beyond) else "**not met**"


def _row(figure):
    return {
        "what": figure.name,
        "figure": number(figure.value, figure.unit),
        "by the wall clock": number(figure.wall),
        "ratio to the arrays": number(figure.ratio),
        "limit": figure.limit.replace(">=", "≥").replace("<=", "≤"),
        "": met(figure),
    }


def _compared(figure, before, line):
    """Compares the ratios if both runs have them, else the figures themselves."""
    if before is None or None in (figure.value, before.value):
        return {"before": ""}
    ratios = figure.ratio is not None and before.ratio is not None
    a, b = (figure.ratio, before.ratio) if ratios else (figure.value, before.value)
    word = ""
    if ratios:  # others may be 0
        worse = b / a if figure.more_is_faster else a / b
        word = f", {worse:.1f} x slower now" if worse > MUCH else ""
    return {"before": f"{number(b)} at {line['commit']}{word}"}


def _place(line):
    if "load" not in line:
        return line["commit"]
    return f"{line['commit']}, {line['time'][:10]}, load {line['load']:.0f} on {line['cores']}"


def _text(columns, rows):
    lines = [dict(zip(columns, columns)), dict.fromkeys(columns, "-"), *rows]
    used = [c for c in columns if c in ("what", "figure") or any(row[c] for row in rows)]
    lines[0][""] = " "
    widths = {c: max(len(line[c]) for line in lines) for c in used}
    return "\n".join(
        "| " + " | ".join(_cell(line[c], widths[c]) for c in used) + " |" for line in lines
    )


def _cell(text, width):
    return "-" * width if text == "-" else text.ljust(width)


def number(value, unit=""):
    """Returns a value with three significant digits."""
    if value is None:
        return ""
    digits = 0 if abs(value) >= 100 else 2 - math.floor(math.log10(abs(value))) if value else 0
    return f"{value:,.{max(0, min(digits, 4))}f}{unit and unit != 'RTF' and ' ' + unit or ''}"
