# SPDX-License-Identifier: Apache-2.0
"""YAML files whose faults are reported by line and field."""

from pathlib import Path
from typing import Any

import yaml

from warehouse_layout.file import user_file
from warehouse_operations.stock.yaml_file import read_yaml

Place = tuple[str | int, ...]  # keys and indices from the top


class LinedYaml:
    """The content of a YAML file, and the line of each part. Raises `error` with a sentence."""

    def __init__(self, path: str | Path, error: type[Exception]) -> None:
        self.path, self._error = path, error
        self.content = read_yaml(path, error)
        self._lines: dict[Place, int] = {}
        node = yaml.compose(user_file.read_text(path), Loader=yaml.SafeLoader)
        if node is not None:
            self._note(node, ())

    def line(self, place: Place) -> int:
        """Returns the line of a part, or of the nearest part around it."""
        around = (place[:n] for n in range(len(place), -1, -1))
        return next((self._lines[part] for part in around if part in self._lines), 1)

    def fault(self, place: Place, text: str) -> Exception:
        """Returns the error about a part of the file: `FILE:LINE: FIELD TEXT`."""
        field = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in place)
        field = field.removeprefix(".")
        return self._error(f"{self.path}:{self.line(place)}: {f'{field} ' if field else ''}{text}")

    def _note(self, node: yaml.Node, place: Place) -> None:
        self._lines.setdefault(place, node.start_mark.line + 1)
        if isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                self._lines[*place, key.value] = key.start_mark.line + 1
                self._note(value, (*place, key.value))
        elif isinstance(node, yaml.SequenceNode):
            for i, value in enumerate(node.value):
                self._note(value, (*place, i))


def shown(value: Any) -> str:
    """Returns a value in YAML, for a message."""
    text = yaml.safe_dump(value, default_flow_style=True, width=10**9)
    return text.removesuffix("\n").removesuffix("...").strip()[:80]
