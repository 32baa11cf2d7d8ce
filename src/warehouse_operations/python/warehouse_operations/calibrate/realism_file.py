# SPDX-License-Identifier: Apache-2.0
"""A realism file of what was measured: each number with its interval and samples as a comment, and
what was too little to say by name.

`realism:=FILE`, `--realism FILE` and `measured: FILE` of a layout take it.
"""

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass

from warehouse_operations.calibrate.estimates import Estimate, Finding, TooLittle

HEAD = """\
# SPDX-License-Identifier: Apache-2.0
# Measured by calibrate: realism:=FILE, --realism FILE, or measured: FILE in a layout.
# Behind each number: its 95 % interval, and of how many samples it is."""
DIGITS = 5
NEGLIGIBLE = 0.005  # a deviation below this share of the time of a piece counts as 0
SIMPLE = re.compile(r"[A-Za-z0-9_]+")


@dataclass(frozen=True)
class Line:
    """A number of a section. key: "" for what no file takes. unit: for the table."""

    section: str
    key: str
    name: str
    unit: str
    finding: Finding
    deviation: Finding | None = None  # of the time of a piece
    station: str = ""  # that differs from the others


def text(lines: Sequence[Line], sources: Sequence[str]) -> str:
    """Returns the content of a file."""
    out = [HEAD, *(f"# Source: {source}" for source in sources)]
    for section in dict.fromkeys(line.section for line in lines if not line.station):
        out += _section(section, [line for line in lines if line.section == section])
    return "\n".join(out) + "\n"


def _section(section: str, lines: Sequence[Line]) -> list[str]:
    """Returns the lines of a section; comments alone where nothing was measured."""
    content = [_line(line, "  ") for line in lines if not line.station]
    if not any(isinstance(line.finding, Estimate) and line.key for line in lines):
        return [
            f"# {section}: nothing was measured",
            *(f"# {text.strip(' #')}" for text in content),
        ]
    stations = [line for line in lines if line.station]
    if stations:
        content.append("  stations:")
        for name in dict.fromkeys(line.station for line in stations):
            content.append(f"    {quoted(name)}:")
            content += [_line(line, "      ") for line in stations if line.station == name]
    return [f"{section}:", *content]


def _line(line: Line, indent: str) -> str:
    if isinstance(line.finding, TooLittle):
        return f"{indent}# {line.key or line.name}: {line.finding}"
    said = evidence(line.finding)
    if not line.key:
        return f"{indent}# {line.name}: {number(line.finding.value)} {line.unit}, {said}"
    value = number(line.finding.value)
    if _spreads(line):
        assert isinstance(line.deviation, Estimate)
        value = f"{{mean: {value}, sd: {number(line.deviation.value)}}}"
    return f"{indent}{line.key}: {value}  # {said}"


def _spreads(line: Line) -> bool:
    """Returns whether the time of a piece differs from piece to piece."""
    both = isinstance(line.deviation, Estimate) and isinstance(line.finding, Estimate)
    if not both:
        return False
    assert isinstance(line.deviation, Estimate) and isinstance(line.finding, Estimate)
    return line.deviation.value > NEGLIGIBLE * line.finding.value


def evidence(estimate: Estimate) -> str:
    """Returns interval and samples of an estimate."""
    ends = f"{number(estimate.low)} to {number(estimate.high)}"
    return f"{ends}, {estimate.count} {estimate.kind}"


def number(value: float) -> str:
    """Returns a number as a file and a table have it."""
    return f"{value:.{DIGITS}g}" if abs(value) < 1e5 else f"{value:.0f}"


def quoted(name: str) -> str:
    """Returns a key of YAML."""
    return name if SIMPLE.fullmatch(name) and not name.isdecimal() else json.dumps(name)


def table(lines: Sequence[Line]) -> str:
    """Returns what was measured as a table for people, and what was not, by name."""
    rows = [f"{'':28}{'value':>10}  {'95 % interval':>22}  of"]
    for line in lines:
        name = f"{line.name} at {line.station}" if line.station else line.name
        if isinstance(line.finding, Estimate):
            value, low, high = (
                number(v) for v in (line.finding.value, line.finding.low, line.finding.high)
            )
            ends = f"{low} to {high}"
            unit = f" [{line.unit}]" if line.unit else ""
            of = f"{line.finding.count} {line.finding.kind}"
            rows.append(f"{name + unit:28}{value:>10}  {ends:>22}  {of}")
    lacking = [line for line in lines if isinstance(line.finding, TooLittle)]
    if lacking:
        rows += ["", "Too little to say:"]
        rows += [
            f"  {line.name} ({line.finding.count} {line.finding.kind}, "
            f"{line.finding.least} were expected)"
            for line in lacking
            if isinstance(line.finding, TooLittle)
        ]
    return "\n".join(rows)
