# SPDX-License-Identifier: Apache-2.0
"""Checks what operations.launch is given before anything starts: each function returns its argument
as the shift takes it, files by their whole path, or raises one of simulation.ERRORS."""

from pathlib import Path

import numpy as np

from warehouse_operations import schema
from warehouse_operations.demand import make_demand
from warehouse_operations.engines import DatabaseError, lock, make_engine, path_of, prepare
from warehouse_operations.policies import Policies


def orders(text):
    """Whether a file's SKUs are there, only the shift can tell."""
    text = _whole_path(text) if text.endswith(".csv") else text
    make_demand(text, None, (1, 1), np.random.default_rng(1))
    return text


def policies(text):
    text = _whole_path(text)
    Policies.read(text)
    return text


def database(text):
    """One that is not there yet is not made."""
    text = text if "://" in text else _whole_path(text)
    engine = make_engine(text)
    path = path_of(engine)
    if path and not path.parent.is_dir():
        raise DatabaseError(f"{path}: there is no folder {path.parent}")
    try:
        if not path or path.exists():
            with lock(engine, text):
                prepare(engine, text, makes=False)
    except DatabaseError as error:
        if not isinstance(error.__cause__, schema.EmptyError):
            raise
    finally:
        engine.dispose()
    return text


def _whole_path(text):
    return str(Path(text).expanduser().absolute())
