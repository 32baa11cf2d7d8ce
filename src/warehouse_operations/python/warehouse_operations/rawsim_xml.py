# SPDX-License-Identifier: Apache-2.0
"""Elements and numbers of RAWSim-O's XML files, read with faults that name file and element."""

import xml.etree.ElementTree as ElementTree

MOST = 1e9  # of any number in a file


class InstanceError(Exception):
    """A file that can't be used; the text names file, element and what was expected."""


def read_root(path, tag):
    try:
        root = ElementTree.parse(path).getroot()
    except OSError as error:
        raise InstanceError(f"{path}: {error.strerror}") from error
    except ElementTree.ParseError as error:
        raise InstanceError(f"{path}:{error.position[0]}: {error}") from error
    except (LookupError, ValueError) as error:  # an unknown encoding
        raise InstanceError(f"{path}:1: {error}") from error
    if root.tag != tag:
        raise InstanceError(f"{path}: <{root.tag}>; <{tag}> was expected")
    return root


def children(root, group, tag):
    return root.findall(f"{group}/{tag}")


def number_of(path, element, name, default=None):
    text = element.get(name)
    if text is None and default is not None:
        return default
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = float("nan")
    if not abs(value) <= MOST:
        what = f"{element.tag} {element.get('ID')}"
        raise InstanceError(f"{path}: {what}: {name} is {text!r}; a number was expected")
    return value


def text_of(path, root, name, default):
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
