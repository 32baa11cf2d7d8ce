# SPDX-License-Identifier: Apache-2.0
"""Checks the arguments of operations.launch before anything starts: each function returns its
argument as the shift takes it, files by their whole path, or raises one of simulation.ERRORS.
Relative paths start at `folder`."""

from pathlib import Path

import numpy as np

from warehouse_operations.policies import Policies
from warehouse_operations.stock import orders_text
from warehouse_operations.stock.demand import make_demand
from warehouse_operations.store import schema
from warehouse_operations.store.engines import DatabaseError, lock, make_engine, path_of, prepare


def orders(text: str, folder: Path) -> str:
    """Checks orders, but for the SKUs of a file: the shift alone knows its stock."""
    text = orders_text.with_file(text, lambda file: _whole_path(file, folder))
    make_demand(text, None, (1, 1), np.random.default_rng(1))
    return text


def policies(text: str, folder: Path) -> str:
    """Checks a YAML file of policies."""
    text = _whole_path(text, folder)
    Policies.read(text)
    return text


def database(text: str, folder: Path) -> str:
    """Checks a database's URL or file; creates none."""
    text = text if "://" in text else _whole_path(text, folder)
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


def _whole_path(text: str, folder: Path) -> str:
    return str(folder / Path(text).expanduser())
