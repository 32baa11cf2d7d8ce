# SPDX-License-Identifier: Apache-2.0
"""The official schemas of VDA 5050 (MIT), one a kind of message, and what does not fit them.

v2_1_0: those of 2.1.0, for all versions 2; those of 2.0.0 name actions otherwise than its text
does. v3_0_0: those of 3.0.0 as of July 2026; of the release itself three are no JSON.
"""

import functools
import json
from pathlib import Path
from typing import Any

import jsonschema

from warehouse_vda5050.topics import ABOUT_ZONES, Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.wire import parse

FOLDERS = {"2": "v2_1_0", "3": "v3_0_0"}  # by the first digit of a version


@functools.cache
def validator_of(kind: Kind, version: str = "2.1.0") -> Any:
    """Returns the validator of a kind of message in a version."""
    folder = FOLDERS.get(version[:1], FOLDERS["2"])
    if kind in ABOUT_ZONES:
        folder = FOLDERS["3"]  # no other version has them
    text = (Path(__file__).parent / folder / f"{kind.value}.json").read_text(encoding="utf-8")
    return jsonschema.Draft202012Validator(json.loads(text))


def why_invalid(kind: Kind, payload: bytes) -> str:
    """Returns in a sentence why a message does not fit the schema of the version that it names, ''
    if it does. An empty one, which removes what the broker has kept, does."""
    if not payload:
        return ""
    try:
        value = parse(payload)
    except MessageError as error:
        return str(error)
    version = str(value.get("version", "")).lstrip("vV")
    fault = next(validator_of(kind, version).iter_errors(value), None)
    if fault is None:
        return ""
    where = ".".join(map(str, fault.absolute_path))
    return f"{where}: {fault.message[:200]}" if where else fault.message[:200]
