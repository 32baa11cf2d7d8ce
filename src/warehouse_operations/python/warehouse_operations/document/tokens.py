# SPDX-License-Identifier: Apache-2.0
"""The colours of the pages, for what can't read their design.css; a test compares the two.

A chart is drawn once, in the colours of LIGHT. In a page these are replaced by the variables of the
same names, so that the drawing follows the reader's theme.
"""

import re
from collections.abc import Mapping

DARK = {
    "page": "#0f1216",
    "panel": "#171b21",
    "line": "#2e3641",
    "edge": "#6b7889",
    "hover": "#262d37",
    "text": "#e8ecf1",
    "dim": "#a2adbb",
    "accent": "#6cacff",
    "resting": "#8b97a7",
    "moving": "#4f9cf9",
    "working": "#3fbf7f",
    "waiting": "#f2b036",
    "needs-help": "#f0605a",
}
LIGHT = {
    "page": "#f3f5f8",
    "panel": "#ffffff",
    "line": "#dbe1e8",
    "edge": "#7c8896",
    "hover": "#e9edf2",
    "text": "#17202b",
    "dim": "#535f6e",
    "accent": "#1257c4",
    "resting": "#5d6978",
    "moving": "#1a63d0",
    "working": "#0f7a43",
    "waiting": "#8f5600",
    "needs-help": "#bd2822",
}
# Colours of configurations side by side; no activity has one of them.
SERIES_DARK = ("#6cacff", "#f08cbd", "#3fc4bb", "#b79bf5", "#c9cc6a", "#a9b4c2")
SERIES_LIGHT = ("#1257c4", "#a8326e", "#0b7a75", "#7a45c9", "#6b6f1f", "#4d5967")
# The activities of robots by the token of their colour.
ACTIVITIES = {
    "to unit": "moving",
    "lift": "working",
    "to station": "moving",
    "queue": "waiting",
    "service": "working",
    "back": "moving",
    "idle": "resting",
}


def css() -> str:
    """Returns the rules that set the variables: light by default and in print, else dark."""
    dark, light = (
        "".join(f"--{name}:{colour};" for name, colour in {**colours, **_series(series)}.items())
        for colours, series in ((DARK, SERIES_DARK), (LIGHT, SERIES_LIGHT))
    )
    return (
        f":root{{color-scheme:light;{light}}}"
        f"@media screen and (prefers-color-scheme:dark){{:root{{color-scheme:dark;{dark}}}}}"
    )


def themed(drawing: str) -> str:
    """Returns an SVG in the colours of LIGHT as one in variables."""
    names = {colour: name for name, colour in _drawn().items()}
    return re.sub(
        r"#[0-9a-f]{6}\b",
        lambda match: f"var(--{names[match[0]]})" if match[0] in names else match[0],
        drawing,
    )


def colour(name: str) -> str:
    """Returns the colour to draw a token in."""
    return LIGHT[name]


def series(number: int) -> str:
    """Returns the colour of a configuration by its number, from 0."""
    return SERIES_LIGHT[number % len(SERIES_LIGHT)]


def names_of_series(count: int) -> list[str]:
    """Returns the variables of the first configurations' colours."""
    return [f"series-{number % len(SERIES_LIGHT) + 1}" for number in range(count)]


def _series(colours: tuple[str, ...]) -> Mapping[str, str]:
    return {f"series-{number}": colour for number, colour in enumerate(colours, start=1)}


def _drawn() -> dict[str, str]:
    """Maps names to colours; a series that has a token's colour is that token."""
    return {**_series(SERIES_LIGHT), **LIGHT}
