# SPDX-License-Identifier: Apache-2.0
"""Tables in CSV, as a text editor or a spreadsheet writes them.

The first line has names of columns. Fields end at commas, semicolons or tabs; the text is UTF-8,
with a byte order mark or without.
"""

import codecs
import csv
import io
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

SEPARATORS = ",;\t"
MOST_BYTES, MOST_ROWS = 64 * 2**20, 500_000
UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
SAVE_AS = "save it as CSV in UTF-8 (in spreadsheets: 'CSV UTF-8')"

Row = Mapping[Any, Any]  # texts by column; more fields than columns have the key None


class CsvTable:
    """The rows of a file, as texts by column. Raises `error` with the line that is malformed.

    needed, optional: names of columns; others may be there too. text: what there is in place of a
    file, which then only has a name. decimal_comma: 1,5 is one and a half.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        needed: Sequence[str],
        optional: Sequence[str] = (),
        error: type[Exception] = ValueError,
        text: str | None = None,
    ) -> None:
        self._path, self._error = path, error
        self._known = (*needed, *optional)
        text = self._text(Path(path)) if text is None else text.removeprefix("\ufeff")
        separator = self._separator(text)
        self.decimal_comma = separator == ";"
        self._reader = csv.DictReader(io.StringIO(text, newline=""), delimiter=separator)
        try:
            self._reader.fieldnames = _names(self._reader.fieldnames or ())
        except csv.Error as fault:
            raise error(f"{path}:1: {fault}") from fault
        self._check_columns(self._reader.fieldnames or (), needed)

    @property
    def line(self) -> int:
        """The line of the last row, counted from 1."""
        return self._reader.line_num

    def __iter__(self) -> Iterator[Row]:
        """Yields the rows as they are; see fields()."""
        try:
            for count, row in enumerate(self._reader):
                if count == MOST_ROWS:
                    raise self._error(f"{self._path}: more than {MOST_ROWS} rows; split the file")
                yield row
        except csv.Error as fault:
            raise self._error(f"{self._path}:{self.line}: {fault}") from fault

    def _text(self, path: Path) -> str:
        try:
            if path.exists() and not path.is_file():
                raise self._error(f"{path}: is not a file")
            if (size := path.stat().st_size) > MOST_BYTES:
                raise self._error(
                    f"{path}: has {size >> 20} MB; {MOST_BYTES >> 20} MB or less were expected; "
                    "split the file"
                )
            data = path.read_bytes()
        except OSError as fault:
            raise self._error(f"{path}: {fault.strerror}") from fault
        if data.startswith(UTF_16) or b"\0" in data[:200]:
            raise self._error(f"{path}: is in UTF-16, or not text; {SAVE_AS}")
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError as fault:
            line = data.count(b"\n", 0, fault.start) + 1
            byte = data[fault.start]
            raise self._error(f"{path}:{line}: byte {byte:#x} is not UTF-8; {SAVE_AS}") from fault

    def _separator(self, text: str) -> str:
        first = text.partition("\n")[0].lower()

        def known(separator: str) -> list[str]:
            return [c for c in self._known if c in _names(first.split(separator))]

        return max(SEPARATORS, key=lambda mark: (len(known(mark)), first.count(mark)))

    def _check_columns(self, names: Sequence[str], needed: Sequence[str]) -> None:
        lacking = [name for name in needed if name not in names]
        if lacking:
            listed = shown(", ".join(filter(None, names))) or "none"
            raise self._error(
                f"{self._path}:1: there is no column {', '.join(lacking)}; the first line has to "
                f"name the columns, those in it are: {listed}"
            )
        twice = [name for name in self._known if names.count(name) > 1]
        if twice:
            raise self._error(f"{self._path}:1: there are two columns {twice[0]}")


def _names(fields: Iterable[str]) -> list[str]:
    return [field.strip().strip('"').lower() for field in fields]


def fields(row: Row) -> dict[str, str]:
    """Returns the texts of a row by column; {} for a blank one. Raises ValueError for too many."""
    if None in row:
        raise ValueError("there are more fields than columns")
    texts = {name: (text or "").strip() for name, text in row.items()}
    return texts if any(texts.values()) else {}


def shown(text: str, most: int = 80) -> str:
    """Returns a text from outside, made safe for a message."""
    text = text if len(text) <= most else f"{text[:most]}…"
    return text if text.isprintable() else ascii(text)[1:-1]
