# SPDX-License-Identifier: Apache-2.0
"""Whether addresses elsewhere, to which pages lead, still answer."""

import re
import urllib.error
import urllib.request
from collections import defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from examples.blocks import ROOT

ADDRESS = re.compile(r"\]\((https?://[^)\s]+)\)|<(https?://[^>\s]+)>|`(https?://[^`\s]+)`_")
HERE = re.compile(r"https?://(localhost|127\.|[\w.-]*\.local\b|host[:/])")  # in examples
GONE = (404, 410)  # other refusals are for robots, not for readers
AGENT = {"User-Agent": "Mozilla/5.0 (link check of the documentation)"}
AT_ONCE = 8


class Answer(NamedTuple):
    """What an address says: `status` is 0 where it was not reached."""

    address: str
    status: int
    text: str


def addresses(pages: Iterable[Path]) -> dict[str, list[str]]:
    """Returns {address elsewhere: the pages that lead to it}."""
    out = defaultdict(list)
    for page in pages:
        for match in ADDRESS.findall(page.read_text()):
            address = next(filter(None, match)).partition("#")[0]
            place = str(page.relative_to(ROOT)) if page.is_relative_to(ROOT) else str(page)
            if not HERE.match(address) and place not in out[address]:
                out[address].append(place)
    return {url: places for url, places in out.items() if places}


def ask(address: str, timeout: float) -> Answer:
    """Returns what an address answers within `timeout` seconds."""
    request = urllib.request.Request(address, headers=AGENT)
    try:
        with urllib.request.urlopen(request, timeout=timeout) as answer:
            return Answer(address, answer.status, "")
    except urllib.error.HTTPError as error:
        return Answer(address, error.code, error.reason)
    except (OSError, ValueError) as error:
        return Answer(address, 0, str(getattr(error, "reason", error)))


def answers(urls: Iterable[str], timeout: float) -> list[Answer]:
    """Returns what all addresses answer, in their order."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(lambda url: ask(url, timeout), urls))
