# SPDX-License-Identifier: Apache-2.0
"""The official schemas of 2.1.0 and of 3.0.0, one a kind of message."""

import json

import jsonschema
import paths

from warehouse_vda5050.topics import Kind

FOLDER = paths.ROOT / "tests" / "vda5050"


def validators(version):
    folder = FOLDER / f"schemas_{version.replace('.', '_')}"
    return {
        kind: jsonschema.Draft202012Validator(
            json.loads((folder / f"{kind.value}.json").read_text())
        )
        for kind in Kind
    }


VALIDATORS = validators("2.1.0")


def faults(kind, payload, known=VALIDATORS):
    """Returns what is wrong with a message as it was sent, a line each."""
    errors = known[kind].iter_errors(json.loads(payload))
    return [f"{kind.value} {list(fault.path)}: {fault.message}" for fault in errors]
