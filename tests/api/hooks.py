# SPDX-License-Identifier: Apache-2.0
"""Keeps the requests that schemathesis makes up quick; scripts/peers/fuzz_api uses it."""

import schemathesis

MOST = 20  # robots, items or shelves of a warehouse
PATIENCE = 0.3  # for a command [s]


@schemathesis.hook
def before_call(context, case, kwargs):
    if isinstance(case.body, dict):
        for count in ("robots", "items", "shelves"):
            if isinstance(number := case.body.get(count), int) and MOST < number <= 100000:
                case.body[count] = number % MOST
        if case.body.get("name") in ("medium", "large", "huge"):
            case.body["name"] = "small"
    timeout = (case.query or {}).get("timeout", 10)
    if case.path.endswith("/commands") and isinstance(timeout, int | float):
        case.query = {**(case.query or {}), "timeout": min(timeout, PATIENCE)}
