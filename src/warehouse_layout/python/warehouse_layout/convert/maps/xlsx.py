# SPDX-License-Identifier: Apache-2.0
"""Reads the texts in the first sheet of a workbook, `.xlsx` (ECMA-376), by the standard library."""

import re
import xml.etree.ElementTree as ElementTree
import zipfile
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import MOST_CELLS, FormatError, PathName

MOST_BYTES = 200_000_000  # of a part, unpacked
_SHEET = re.compile(r"xl/worksheets/sheet(\d+)\.xml")


def first_sheet(path: PathName) -> list[list[str]]:
    """Returns the rows of the first sheet, as long as they are filled. Raises FormatError."""
    try:
        with zipfile.ZipFile(path) as archive:
            sheets = sorted(
                (int(sheet[1]), name)
                for name in archive.namelist()
                if (sheet := _SHEET.fullmatch(name))
            )
            if not sheets:
                raise FormatError(f"{path}: the workbook has no sheet")
            texts = _shared(path, archive)
            return _rows(path, _part(path, archive, sheets[0][1]), texts)
    except (zipfile.BadZipFile, OSError, ElementTree.ParseError, KeyError, ValueError) as error:
        if isinstance(error, FormatError):
            raise
        raise FormatError(f"{path}: the workbook can't be read: {error}") from error


def address(row: int, column: int) -> str:
    """Returns a cell's address in a spreadsheet, `B3`; row and column from 0."""
    letters, left = "", column + 1
    while left:
        left, digit = divmod(left - 1, 26)
        letters = chr(ord("A") + digit) + letters
    return f"{letters}{row + 1}"


def _part(path: PathName, archive: zipfile.ZipFile, name: str) -> Element:
    if archive.getinfo(name).file_size > MOST_BYTES:
        raise FormatError(f"{path}: {name} is larger than {MOST_BYTES:,} bytes")
    return ElementTree.fromstring(archive.read(name))


def _shared(path: PathName, archive: zipfile.ZipFile) -> list[str]:
    """Returns the texts that cells refer to by their numbers."""
    name = "xl/sharedStrings.xml"
    if name not in archive.namelist():
        return []
    return [_text(item) for item in _part(path, archive, name).iterfind("{*}si")]


def _text(element: Element) -> str:
    return "".join(part.text or "" for part in element.iterfind(".//{*}t"))


def _rows(path: PathName, sheet: Element, texts: list[str]) -> list[list[str]]:
    values: dict[tuple[int, int], str] = {}
    for row_number, row in enumerate(sheet.iterfind("{*}sheetData/{*}row")):
        at_row = int(row.get("r", row_number + 1)) - 1
        for number, cell in enumerate(row.iterfind("{*}c")):
            column = _column(cell.get("r", ""), number)
            if text := _value(cell, texts):
                values[at_row, column] = text
    height = max((row for row, _ in values), default=-1) + 1
    width = max((column for _, column in values), default=-1) + 1
    if height * width > MOST_CELLS:
        raise FormatError(f"{path}: a sheet of {width} x {height} cells; {MOST_CELLS} at most")
    return [[values.get((row, column), "") for column in range(width)] for row in range(height)]


def _column(reference: str, default: int) -> int:
    out = 0
    for letter in re.match(r"[A-Z]*", reference)[0]:  # type: ignore[index]
        out = 26 * out + ord(letter) - ord("A") + 1
    return out - 1 if out else default


def _value(cell: Element, texts: list[str]) -> str:
    if cell.get("t") == "inlineStr":
        return _text(cell)
    value = cell.findtext("{*}v") or ""
    return texts[int(value)] if cell.get("t") == "s" and value else value
