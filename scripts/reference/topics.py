# SPDX-License-Identifier: Apache-2.0
"""Topics, services and actions by name, with their types. What they carry stands in their files.

A test compares the names with those in the code, and `make docs-test` names and types with those of
a warehouse that runs.
"""

import re
from typing import NamedTuple

from reference.markdown import code, page, prose, table
from reference.pages import ROOT

TABLE = ROOT / "scripts/reference/names.txt"


class Name(NamedTuple):
    """A name of the ROS graph."""

    name: str
    type: str
    node: str
    note: str = ""


def names(section: str) -> list[Name]:
    """Returns the lines of a section of names.txt: published, taken, services, actions, gazebo."""
    text = TABLE.read_text().partition(f"[{section}]\n")[2].partition("\n[")[0]
    return [Name(*(part.strip() for part in line.split("|"))) for line in text.split("\n") if line]


def services() -> list[Name]:
    """Returns all services."""
    return names("services") + names("gazebo")


# Topics and services that ROS itself, an action or a node's logger brings.
BROUGHT = re.compile(r"/(move|carry)/\w+$|/rosout\w*$|/statistics$|logger(s|_level)$")


def unlisted(published: dict[str, str], offered: list[str]) -> list[str]:
    """Returns the topics (given with types) and services that run and that the tables lack."""
    known = {topic.name: topic.type for topic in names("published") + names("taken")}
    undocumented = []
    for name, kind in published.items():
        plain = re.sub(r"^/(items|storage_units)/[^/]+/", r"/\1/<name>/", name)
        plain = re.sub(r"^/kiva\d+/", "/kiva<id>/", plain)
        if not BROUGHT.search(name) and known.get(plain) != kind:
            undocumented.append(f"{name} {kind}")
    listed = {topic.name for topic in services()}
    return undocumented + [
        name for name in offered if not BROUGHT.search(name) and name not in listed
    ]


def about(type_name: str) -> str:
    """Returns the first sentence of a type's comment, "" where it is of another package."""
    package, name = type_name.split("/")
    name = name.removesuffix("Action") if package == "warehouse_msgs" else name
    for folder in ("msg", "srv", "action"):
        file = ROOT / "src" / package / folder / f"{name}.{folder}"
        if file.exists():
            lines = [
                line.lstrip("# ") for line in file.read_text().splitlines() if "SPDX" not in line
            ]
            text = " ".join(_leading(file, lines))
            return text.split(". ")[0].rstrip(".:")
    return ""


def _leading(file, lines):
    """The lines of the first comment."""
    raw = [line for line in file.read_text().splitlines() if "SPDX" not in line]
    for line, words in zip(raw, lines):
        if not line.startswith("#"):
            return
        yield words


def rows(listed: list[Name], with_notes: bool = True) -> list[tuple[str, ...]]:
    """Returns the rows of a table."""
    kinds = {"msg": "messages", "srv": "services", "action": "actions"}

    def linked(topic):
        package, name = topic.type.split("/")
        for folder, where in kinds.items():
            bare = name.removesuffix("Action") if folder == "action" else name
            if (ROOT / "src" / package / folder / f"{bare}.{folder}").exists():
                anchor = f"{package}/{bare}".lower().replace("/", "")
                return f"[{topic.type}]({where}.md#{anchor})"
        return code(topic.type)

    return [
        (
            code(topic.name),
            linked(topic),
            topic.node,
            ". ".join(part for part in (topic.note, prose(about(topic.type))) if part),
        )
        for topic in listed
    ]


INTRODUCTION = (
    "Robots stand on grid points, 1 m apart unless a world says otherwise. SI units, radians, x "
    "forward, y left, z up, frame `world`. A robot with plugins of gazebo_ros has topics of its "
    "own: [plugins](plugins.md). A simulation in a namespace has all of these within it: [two "
    "simulations](../how-to/namespaces.md)."
)
COMMANDS = (
    "Each command is answered by ACCEPTED or REFUSED, and each accepted one ends in DONE "
    "or BLOCKED; [commands of robots](robots.md) has the rules."
)
GOALS = "With feedback and a result. A cancelled goal ends with the command that is under way."


def written() -> str:
    """Returns the page of names."""

    def section(title, listed, about=""):
        head = [title.split()[0].rstrip("s").lower(), "type", "node", ""]
        return f"## {title}\n\n{about}\n\n{table(head, rows(listed))}"

    return page(
        "Topics, services and actions",
        INTRODUCTION,
        section("Topics to read", names("published")),
        section("Commands", names("taken"), COMMANDS),
        section("Services", services()),
        section("Actions", names("actions"), GOALS),
    )
