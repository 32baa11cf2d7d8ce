# SPDX-License-Identifier: Apache-2.0
"""Best known figures of public problems, to compare with.

Sources: the tables of best known solutions in github.com/MAPF-Competition/Benchmark-Archive, "2023
Competition/README.md" (finished errands) and "2024 Competition/README.md" (finished tasks). Teams
had a second a step on 32 cores.
"""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path


@dataclass(frozen=True)
class BestKnown:
    """The best that was published of a problem."""

    robots: int
    steps: int
    finished: int  # tasks
    team: str


def _table(prefix: str, rows: str) -> dict[str, BestKnown]:
    result = {}
    for row in rows.strip().splitlines():
        name, robots, steps, finished, team = row.split(maxsplit=4)
        result[prefix + name] = BestKnown(int(robots), int(steps), int(finished), team)
    return result


BEST_KNOWN = {
    **_table(
        "MR23-",
        """
        I-01   1500 1500  10385 Shadoks
        I-02   3000 3500  49186 Pikachu
        I-03    200  500   3042 Shadoks
        I-04    100  500   1741 Shadoks
        I-05    400 1000   7432 Pikachu
        I-06  10000 5000 197275 Shadoks
        I-07    600 1000   5914 Pikachu
        I-08    800 2000   6059 Shadoks
        I-09   6500 5000  28954 Pikachu
        I-10  10000 5000 194677 Shadoks
        """,
    ),
    **_table(
        "TR23-",
        """
        Paris             250 5000  6094 Pikachu
        brc202d           500 5000  6543 NCD-MIPT
        random            100 5000 15609 Pikachu
        sortation_large  2000 5000 24577 NCD-MIPT
        warehouse_large  5000 5000 19758 Pikachu
        """,
    ),
    **_table(
        "MR24-",
        """
        CITY-01     1500 3000   8445 Kitty Knight
        CITY-02     3000 3000  17010 SYSU-LCIS
        GAME        6500 5000  23274 No Man's Sky
        RANDOM-01    100  600    696 RAPID
        RANDOM-02    200  600   1260 Kitty Knight
        RANDOM-03    400  800   2368 No Man's Sky
        RANDOM-04    700 1000   2585 No Man's Sky
        RANDOM-05    800 2000   3050 No Man's Sky
        SORTATION  10000 5000 152714 No Man's Sky
        WAREHOUSE  10000 5000 154834 No Man's Sky
        """,
    ),
}


def best_known(path: str | PathLike[str], robots: int) -> BestKnown | None:
    """Returns the best known results for the problem in a file of that name with `robots` robots;
    None if the table lacks it. Some files are published without the prefix of their round."""
    stem = Path(path).stem
    names = (stem, *(prefix + stem for prefix in ("MR23-", "MR24-", "TR23-")))
    known = [BEST_KNOWN[name] for name in names if name in BEST_KNOWN]
    return next((entry for entry in known if entry.robots == robots), None)
