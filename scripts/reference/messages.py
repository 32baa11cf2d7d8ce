# SPDX-License-Identifier: Apache-2.0
"""Messages, services and actions, from their files."""

from pathlib import Path

from reference.markdown import block, page, prose
from reference.pages import ROOT

PACKAGES = {
    "warehouse_msgs": "What the warehouse publishes and takes.",
    "gazebo_msgs": "Gazebo's, so that its clients connect.",
}
# What a file leaves out, since its fields say it all.
ABOUT = {
    "CancelOrder": "Cancels an order that is not complete.",
    "Quantiles": "How a quantity is distributed.",
}
FOLDERS = {"Messages": "msg", "Services": "srv", "Actions": "action"}


def files(folder: str) -> list[Path]:
    """Returns the files of a kind: msg, srv or action."""
    return sorted(
        (
            file
            for package in PACKAGES
            for file in (ROOT / "src" / package / folder).glob(f"*.{folder}")
        ),
        key=lambda file: (file.parts[-3] != "warehouse_msgs", file.name),
    )


def section(file: Path) -> str:
    """Returns a file's heading, what its first comment says, and its definition."""
    lines = [line for line in file.read_text().splitlines() if "SPDX-License" not in line]
    while lines and not lines[0].strip():
        lines.pop(0)
    about = []
    while lines and lines[0].startswith("#"):
        about.append(lines.pop(0).lstrip("# "))
    definition = "\n".join(lines).strip("\n") or "# empty"
    return "\n\n".join(
        [
            f"## {file.parts[-3]}/{file.stem}",
            prose(" ".join(about) or ABOUT.get(file.stem, "")),
            block(definition),
        ]
    )


def written(title: str) -> str:
    """Returns the page of messages, services or actions."""
    folder = FOLDERS[title]
    about = " ".join(f"`{name}`: {text}" for name, text in PACKAGES.items())
    parts = {
        "Services": "Above the dashes stands the request, below the response.",
        "Actions": "Goal, result and feedback, with dashes between.",
    }
    return page(title, about, parts.get(title, ""), *map(section, files(folder)))
