# SPDX-License-Identifier: Apache-2.0
"""Damaged copies of a text: bytes, tokens and lines; the same generator gives the same ones."""

import re

ODD = (
    "",
    ":",
    "~",
    "-1",
    "0",
    "5",
    "1e400",
    "nan",
    "-inf",
    "18446744073709551616",
    "10000000000",
    "0.5",
    "true",
    "queues-8",
    "[]",
    "{}",
    "[1, 2]",
    "{a: 1}",
    "2024-02-31",
    "!!python/name:os.system",
    "&a [*a]",
    "\0",
    "ä",
    "x" * 300,
)
# Numbers, words, and what is put between them.
TOKEN = re.compile(r"[\w.+-]+|[^\w\s]")


def mutated(text, random):
    """The text with one to three changes, as bytes."""
    data = text.encode()
    for _ in range(int(random.integers(1, 4))):
        change = (_byte, _token, _token, _token, _line)[random.integers(5)]
        data = change(data, random)
    return data


def _byte(data, random):
    at = int(random.integers(len(data) + 1))
    kind = random.integers(4)
    if kind == 0:
        return data[:at] + bytes([random.integers(256)]) + data[at + 1 :]
    if kind == 1:
        return data[:at]
    length = int(random.integers(1, 20))
    if kind == 2:
        return data[:at] + data[at + length :]
    return data[:at] + data[at : at + length] + data[at:]


def _token(data, random):
    text = data.decode(errors="surrogateescape")
    tokens = list(TOKEN.finditer(text))
    if not tokens:
        return data
    token = tokens[random.integers(len(tokens))]
    other = tokens[random.integers(len(tokens))].group()
    new = other if random.random() < 0.3 else ODD[random.integers(len(ODD))]
    return (text[: token.start()] + new + text[token.end() :]).encode(errors="surrogateescape")


def _line(data, random):
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    at, other = random.integers(len(lines), size=2)
    if random.random() < 0.5:
        del lines[at]
    else:
        lines.insert(int(at), lines[other])
    return b"".join(lines)
