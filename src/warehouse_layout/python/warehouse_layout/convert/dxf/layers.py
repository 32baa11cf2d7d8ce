# SPDX-License-Identifier: Apache-2.0
"""Which layers of a drawing hold what: by our names, or by those that a file maps to them.

walls: [A-WALL, "S-COLS*"]       # ours: a layer of the drawing, or several; * stands for any text
storage: Regale
"""

import difflib
import fnmatch
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import yaml

from warehouse_layout.convert.common import FormatError, text_of

# What a layer can hold, and how layers are named that hold it; capitals, - _ and space are alike.
NAMES: Mapping[str, tuple[str, ...]] = {
    "walls": ("walls", "wall", "pillars", "pillar", "columns", "column"),
    "floor": ("floor",),
    "streets": ("streets", "street", "one way", "oneway"),
    "keep_out": ("keep out", "keepout"),
    "belts": ("belts", "belt", "conveyor belts", "conveyors", "conveyor"),
    "storage": (
        "storage",
        "storage units",
        "storage places",
        "shelves",
        "shelf",
        "racks",
        "rack",
        "pods",
        "pod",
    ),
    "parking": ("parking",),
    "charging": ("charging", "chargers", "charger"),
    "stations": ("stations", "station", "pick", "pick stations"),
    "replenish": ("replenish", "replenishment", "replenishment stations"),
    "robots": ("robots", "robot"),
}


# Words in names of layers, in the languages of drawings, the more particular ones first.
WORDS: Mapping[str, tuple[str, ...]] = {
    "charging": ("charg", "lade", "batter"),
    "parking": ("park",),
    "replenish": ("replen", "inbound", "wareneingang", "nachschub"),
    "stations": ("station", "pick", "pack", "arbeitspl", "workpl"),
    "belts": ("belt", "convey", "forder", "förder", "band"),
    "storage": ("rack", "shel", "regal", "storage", "pod", "lager", "etag", "estant"),
    "robots": ("robot", "agv", "amr", "fts"),
    "keep_out": ("keep", "sperr", "restrict", "danger"),
    "streets": ("street", "lane", "aisle", "path", "gang", "weg", "flow"),
    "walls": ("wall", "wand", "mauer", "mur", "col", "pillar", "stutz", "stütz", "saul", "säul"),
    "floor": ("floor", "boden", "slab", "hall"),
}


@dataclass(frozen=True)
class Layers:
    """Finds what a layer holds."""

    names: Mapping[str, tuple[str, ...]]

    def kind(self, layer: str) -> str:
        """Returns a key of NAMES for the name of a layer; "" for other layers."""
        plain = _plain(layer)
        for kind, patterns in self.names.items():
            if any(fnmatch.fnmatchcase(plain, _plain(pattern)) for pattern in patterns):
                return kind
        return ""


def proposed(layers: Iterable[str]) -> str:
    """Returns what a file for --layers could say about layers, by words in their names."""
    out: dict[str, list[str]] = {}
    for layer in layers:
        kind = next((k for k, words in WORDS.items() if any(w in _plain(layer) for w in words)), "")
        if kind:
            out.setdefault(kind, []).append(layer)
    lines = [f"{kind}: [{', '.join(names)}]" for kind, names in out.items()]
    return "; ".join(f"'{line}'" for line in lines) or "lines like 'walls: A-WALL'"


def _plain(name: str) -> str:
    return " ".join(name.lower().replace("-", " ").replace("_", " ").split())


def read(path: Path | None) -> Layers:
    """Returns the Layers that a YAML file describes; None: by our names. Raises FormatError."""
    if path is None:
        return Layers(NAMES)
    try:
        mapping = yaml.safe_load(text_of(path))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        place = f":{mark.line + 1}" if mark else ""
        raise FormatError(f"{path}{place}: is not YAML") from error
    if not isinstance(mapping, dict):
        raise FormatError(f"{path}: our names with layers were expected, like 'walls: A-WALL'")
    return Layers({**NAMES, **{str(k): _patterns(path, str(k), v) for k, v in mapping.items()}})


def _patterns(path: Path, kind: str, value: object) -> tuple[str, ...]:
    if kind not in NAMES:
        near = difflib.get_close_matches(kind, NAMES, 1)
        hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(NAMES)}"
        raise FormatError(f"{path}: '{kind}' is not one of our names; {hint}")
    values = value if isinstance(value, list) else [value]
    if not all(isinstance(v, (str, int)) and not isinstance(v, bool) for v in values):
        raise FormatError(f"{path}: {kind} is {value!r}; names of layers were expected")
    return tuple(str(v) for v in values)
