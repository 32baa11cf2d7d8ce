# SPDX-License-Identifier: Apache-2.0
"""Reads YAML files; a fault is a sentence with file and line."""

from pathlib import Path
from typing import Any

import yaml

from warehouse_layout.file import user_file


def read_yaml(path: str | Path, error: type[Exception]) -> Any:
    """Returns the content of a YAML file; raises `error` with a sentence."""
    try:
        return yaml.safe_load(user_file.read_text(path))
    except OSError as why:
        raise error(f"{path}: {why.strerror}") from why
    except yaml.YAMLError as why:
        mark = getattr(why, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        said = getattr(why, "problem", None) or getattr(why, "reason", None) or why
        raise error(f"{path}{line}: {said}; YAML was expected") from why
    # Causes include an impossible date, or a file that is not text.
    except (ValueError, OverflowError, RecursionError) as why:
        raise error(f"{path}: {why}; YAML was expected") from why
