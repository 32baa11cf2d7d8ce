# SPDX-License-Identifier: Apache-2.0
"""Pages written by hand: links lead somewhere, quoted messages are those of the code."""

import re

import pytest
from paths import ROOT

PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "SECURITY.md",
    *sorted((ROOT / "doc").rglob("*.md")),
]
GENERATED = {
    "messages",
    "services",
    "actions",
    "topics",
    "events",
    "launch",
    "parameters",
    "http",
    "commands",
    "policies",
    "vda5050-fields",
    "vda5050-cases",
    "vda5050-master-cases",
    "realism-parameters",
    "plugins",
    "changelog",
    "security",
    "benchmarks",
    "contributing",
}
MOST_WORDS = 900


def outside_of_blocks(text):
    return re.sub(r"^(```|~~~).*?^\1", "", text, flags=re.M | re.S)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files(page):
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", outside_of_blocks(page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        to = page.parent / target
        assert to.exists() or to.stem in GENERATED and to.suffix == ".md", f"{page}: {target}"


def test_readme_is_short():
    assert len((ROOT / "README.md").read_text().split()) <= MOST_WORDS


def test_troubleshooting_quotes_the_code():
    code = "\n".join(
        file.read_text()
        for pattern in ("nodes/*", "python/**/*.py", "src/**/*.cpp", "src/**/*.h")
        for file in ROOT.glob(f"src/*/{pattern}")
        if file.is_file()
    )
    code = re.sub(r'"\s*\n?\s*f?"', "", code) + (ROOT / "Makefile").read_text()
    text = (ROOT / "doc/how-to/troubleshooting.md").read_text()
    quoted = re.findall(r"^\| `([^`]+)`", text, re.M)
    assert len(quoted) > 25
    for message in quoted:
        for part in message.split("…"):
            if len(part.strip()) > 3:
                assert part in code, f"{message!r}: {part!r} is not in the code"
