# SPDX-License-Identifier: Apache-2.0
"""The official schemas of 2.1.0, one a kind of message."""

import json

import jsonschema
import paths

from warehouse_vda5050.topics import Kind

FOLDER = paths.ROOT / "tests" / "vda5050" / "schemas_2_1_0"
VALIDATORS = {
    kind: jsonschema.Draft202012Validator(json.loads((FOLDER / f"{kind.value}.json").read_text()))
    for kind in Kind
}


def faults(kind, payload):
    """Returns what is wrong with a message as it was sent, a line each."""
    errors = VALIDATORS[kind].iter_errors(json.loads(payload))
    return [f"{kind.value} {list(fault.path)}: {fault.message}" for fault in errors]
