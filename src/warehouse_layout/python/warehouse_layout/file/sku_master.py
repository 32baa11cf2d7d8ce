# SPDX-License-Identifier: Apache-2.0
"""The master data of SKUs: skus.csv.

    sku,weight_kg,length_m,width_m,height_m,pieces_a_bin,class
    bolt-m8,0.02,0.01,0.01,0.04,24,A

sku is required, all else optional. The default of pieces_a_bin is the number that fits into a bin
by the three edges.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from warehouse_layout.file.csv_table import CsvTable, fields, shown

OPTIONAL = ("weight_kg", "length_m", "width_m", "height_m", "pieces_a_bin", "class")
EDGES = ("length_m", "width_m", "height_m")
BIN = (0.20, 0.15, 0.12)  # inner edges of a bin [m], as worlds/models/item
MOST_KG, MOST_M, MOST_PIECES = 1000.0, 10.0, 100_000
CLASSES = ("", "A", "B", "C")


class SkuMasterError(ValueError):
    """Raised for an invalid file of SKUs; names file, line and column."""


@dataclass(frozen=True)
class Sku:
    """A SKU: weight of a piece [kg], number of pieces that a bin holds (0: any), its class."""

    weight: float = 0.0
    pieces_a_bin: int = 0
    class_: str = ""


def read(path: str | Path) -> dict[str, Sku]:
    """Returns the SKUs of a file by name. Raises SkuMasterError."""
    table = CsvTable(path, ("sku",), OPTIONAL, error=SkuMasterError)
    skus: dict[str, Sku] = {}
    for row in table:
        try:
            texts = fields(row)
            if not texts:
                continue
            name = texts["sku"]
            if not name or name in skus:
                raise ValueError(f"column sku is '{shown(name)}'; a SKU of its own was expected")
            skus[name] = _sku(texts)
        except ValueError as error:
            raise SkuMasterError(f"{path}:{table.line}: {error}") from error
    if not skus:
        raise SkuMasterError(f"{path}: has no SKU; a row for each was expected")
    return skus


def _sku(texts: Mapping[str, str]) -> Sku:
    class_ = texts.get("class", "").upper()
    if class_ not in CLASSES:
        raise ValueError(f"column class is '{shown(texts['class'])}'; A, B or C was expected")
    weight = _number(texts, "weight_kg", MOST_KG)
    pieces = _number(texts, "pieces_a_bin", MOST_PIECES)
    if pieces is not None and (pieces != int(pieces) or pieces < 1):
        raise ValueError(f"column pieces_a_bin is '{shown(texts['pieces_a_bin'])}'; 1 or more")
    edges = [_number(texts, name, MOST_M) for name in EDGES]
    if pieces is None and all(edges):
        pieces = fitting([edge for edge in edges if edge])
        if not pieces:
            raise ValueError(
                f"columns {', '.join(EDGES)}: no piece fits into a bin of"
                f" {' x '.join(f'{edge:g}' for edge in BIN)} m; smaller edges, or pieces_a_bin,"
                " were expected"
            )
    return Sku(weight or 0.0, int(pieces or 0), class_)


def fitting(edges: list[float]) -> int:
    """Returns the number of boxes of these edges [m] that fit into a BIN in one orientation."""
    return max(
        int(BIN[0] / a + 1e-9) * int(BIN[1] / b + 1e-9) * int(BIN[2] / c + 1e-9)
        for a, b, c in itertools.permutations(edges)
    )


def _number(texts: Mapping[str, str], column: str, most: float) -> float | None:
    text = texts.get(column, "")
    if not text:
        return None
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 < value <= most:
        raise ValueError(
            f"column {column} is '{shown(text)}'; a number above 0, up to {most:g}, was expected"
        )
    return value
