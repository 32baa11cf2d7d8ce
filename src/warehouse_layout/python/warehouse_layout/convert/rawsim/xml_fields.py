# SPDX-License-Identifier: Apache-2.0
"""Reads elements and numbers of RAWSim-O's XML files; errors name file and element."""

import xml.etree.ElementTree as ElementTree
from typing import overload
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import FormatError, PathName
from warehouse_layout.file import user_file

MOST = 1e9  # the largest number in a file


class InstanceError(FormatError):
    """Raised for a file that can't be used; names file, element and what was expected."""


def read_root(path: PathName, tag: str) -> Element:
    """Returns the root of a file, which must have a tag. Raises InstanceError."""
    try:
        root = user_file.read_xml(path)
    except OSError as error:
        raise InstanceError(f"{path}: {error.strerror}") from error
    except ElementTree.ParseError as error:
        raise InstanceError(f"{path}:{error.position[0]}: {error}") from error
    except (LookupError, ValueError) as error:  # an unknown encoding
        raise InstanceError(f"{path}:1: {error}") from error
    if root.tag != tag:
        raise InstanceError(f"{path}: <{root.tag}>; <{tag}> was expected")
    return root


def children(root: Element, group: str, tag: str) -> list[Element]:
    """Returns the elements of a tag in a group."""
    return root.findall(f"{group}/{tag}")


def number_of(path: PathName, element: Element, name: str, default: float | None = None) -> float:
    """Returns the number in an attribute; default: of a missing one, None: it must be there.

    Raises InstanceError.
    """
    text = element.get(name)
    if text is None and default is not None:
        return default
    try:
        value = float(text)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        value = float("nan")
    if not abs(value) <= MOST:
        what = f"{element.tag} {element.get('ID')}"
        raise InstanceError(f"{path}: {what}: {name} is {text!r}; a number was expected")
    return value


@overload
def text_of(path: PathName, root: Element, name: str, default: float) -> float: ...
@overload
def text_of(path: PathName, root: Element, name: str, default: None) -> float | None: ...
def text_of(path: PathName, root: Element, name: str, default: float | None) -> float | None:
    """Returns the number in the text of an element; default: where it is missing.

    Raises InstanceError unless the number is from 0 to MOST.
    """
    text = root.findtext(name)
    if text is None:
        return default
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0 <= value <= MOST:
        name = name.rpartition("/")[2]
        raise InstanceError(f"{path}: {name} is '{text}'; a number from 0 to {MOST:g} was expected")
    return value
