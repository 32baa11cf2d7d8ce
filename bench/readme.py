# SPDX-License-Identifier: Apache-2.0
"""The tables of README.md, made from the history. Its prose is written by hand; a table stands
between `<!-- figures: PART -->` and `<!-- end -->`."""

import re

import table
from programs import BENCH

FILE = BENCH / "README.md"
BLOCK = re.compile(r"(<!-- figures: (\S+) -->\n).*?(<!-- end -->)", re.DOTALL)


def update(history, path=FILE):
    """Writes the newest figures of each part into its block. Raises ValueError where a part has
    no block."""
    text = path.read_text()
    blocks = {name for _, name, _ in BLOCK.findall(text)}
    measured = {part for line in history.lines for part in line["parts"]}
    if missing := sorted(measured - blocks):
        raise ValueError(f"{path}: no block for {', '.join(missing)}: <!-- figures: PART -->")

    def block(match):
        begin, part, end = match.groups()
        rows = table.of_part(history, part) if part in measured else "Not measured yet."
        return f"{begin}\n{rows}\n\n{end}"

    path.write_text(BLOCK.sub(block, text))
