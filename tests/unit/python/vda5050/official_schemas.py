# SPDX-License-Identifier: Apache-2.0
"""The official schemas of 2.1.0 and of 3.0.0, one a kind of message."""

import json

from warehouse_vda5050.schemas import validator_of
from warehouse_vda5050.topics import Kind

VALIDATORS = {kind: validator_of(kind) for kind in Kind}


def faults(kind, payload, version="2.1.0"):
    """Returns what is wrong with a message as it was sent, a line each."""
    errors = validator_of(kind, version).iter_errors(json.loads(payload))
    return [f"{kind.value} {list(fault.path)}: {fault.message}" for fault in errors]
