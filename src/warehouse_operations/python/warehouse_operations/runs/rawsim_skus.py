# SPDX-License-Identifier: Apache-2.0
"""Reads files of SKUs (.xgenc) of RAWSim-O, which its settings name."""

import math
from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.xml_fields import MOST, InstanceError, read_root, text_of
from warehouse_operations.goods.kinds import Kinds

FILE = "InventoryConfiguration/SimpleItemConfiguration/GeneratorConfigFile"
MOST_BUNDLE = 10_000  # pieces


def of_settings(path: PathName, root: Element) -> Kinds | None:
    """Returns the SKUs of the file that settings name, if it lies beside them; else those of the
    settings' ranges; None without any. Raises InstanceError."""
    inventory = root.find("InventoryConfiguration")
    if inventory is None:
        return None
    weight = _range(path, inventory, "ItemWeight", 5.0)
    bundle = _range(path, inventory, "BundleSize", 6.0)
    file = _beside(path, root.findtext(FILE, ""))
    if file:
        return read(file, weight, bundle)
    if inventory.find("ItemWeightMin") is None and inventory.find("BundleSizeMin") is None:
        return None
    return Kinds.drawn(weight, (int(bundle[0]), int(bundle[1])))


def remarks(path: PathName, name: str) -> Iterator[str]:
    """Yields a sentence about a file of SKUs that can't be followed, or about a part of it."""
    file = _beside(path, name)
    if file is None:
        yield f"{path}: GeneratorConfigFile {name} is not followed: it does not lie beside it"
    elif text_of(file, read_root(file, "SimpleItemGeneratorConfiguration"), "ProbToUseCoWeight", 0):
        yield f"{file}: ItemCoWeights is not followed: lines of an order are independent here"


def read(
    path: PathName, weight: tuple[float, float] = (5.0, 5.0), bundle: tuple[float, float] = (6, 6)
) -> Kinds:
    """Returns the SKUs of a file. weight, bundle: ranges of what it leaves out.

    Raises InstanceError.
    """
    root = read_root(path, "SimpleItemGeneratorConfiguration")
    numbers = [*_pairs(path, root, "ItemDescriptions")]
    if not numbers:
        raise InstanceError(f"{path}: ItemDescriptions has no SKU; one or more was expected")
    drawn = Kinds.drawn(weight, (int(bundle[0]), int(bundle[1])), len(numbers))
    skus = dict(zip(numbers, drawn.weights))
    weights = _of(path, root, "ItemDescriptionWeights", skus)
    bundles = _of(path, root, "ItemDescriptionBundleSizes", skus)
    usual = text_of(path, root, "DefaultWeight", 1.0)
    popularity = dict.fromkeys(drawn.weights, usual) | _of(path, root, "ItemWeights", skus)
    if not sum(popularity.values()) > 0:
        raise InstanceError(f"{path}: ItemWeights are 0; a SKU that is asked for was expected")
    return Kinds(
        {**drawn.weights, **weights},
        {**drawn.bundles, **{sku: int(size) for sku, size in bundles.items()}},
        popularity,
    )


def _of(path: PathName, root: Element, group: str, skus: dict[int, str]) -> dict[str, float]:
    """Returns the numbers of a group by SKU. Raises InstanceError."""
    pairs = _pairs(path, root, group)
    for number, value in pairs.items():
        if number not in skus:
            raise InstanceError(f"{path}: {group} has Key {number}, which no ItemDescription has")
        least = 0.0 if group == "ItemWeights" else 1.0 if group.endswith("Sizes") else 1e-6
        most = MOST_BUNDLE if group.endswith("Sizes") else MOST
        if not least <= value <= most:
            raise InstanceError(
                f"{path}: {group} of Key {number} is {value:g}; {least:g} to {most:g} was expected"
            )
    return {skus[number]: value for number, value in pairs.items()}


def _pairs(path: PathName, root: Element, group: str) -> dict[int, float]:
    """Returns the values of a group by their keys. Raises InstanceError."""
    pairs: dict[int, float] = {}
    for element in root.iterfind(f"{group}/*"):
        texts = element.findtext("Key", ""), element.findtext("Value", "")
        try:
            key, value = int(texts[0]), float(texts[1])
        except ValueError:
            key, value = 0, math.nan
        if not abs(value) <= MOST:
            raise InstanceError(
                f"{path}: {group} has Key '{texts[0]}' with Value '{texts[1]}'; numbers were"
                " expected"
            )
        pairs[key] = value
    return pairs


def _range(path: PathName, inventory: Element, name: str, usual: float) -> tuple[float, float]:
    least = text_of(path, inventory, f"{name}Min", usual)
    most = text_of(path, inventory, f"{name}Max", max(least, usual))
    if not 0 < least <= most <= MOST_BUNDLE:
        raise InstanceError(
            f"{path}: {name}Min is {least:g} and {name}Max {most:g}; above 0 to {MOST_BUNDLE},"
            " ascending, was expected"
        )
    return least, most


def _beside(path: PathName, name: str) -> Path | None:
    """Returns the file of that name in the folder of a file, if there is one."""
    file = Path(path).parent / Path(name.replace("\\", "/")).name
    return file if name and file.is_file() else None
