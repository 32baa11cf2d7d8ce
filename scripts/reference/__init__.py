# SPDX-License-Identifier: Apache-2.0
"""The generated part of the reference: each page is made from the code that it describes."""

from collections.abc import Callable
from functools import partial

from reference import (
    apis,
    commands,
    events,
    http,
    launching,
    messages,
    numbers,
    policies,
    topics,
    vda5050,
)

PAGES: dict[str, Callable[[], str]] = {
    "messages.md": partial(messages.written, "Messages"),
    "services.md": partial(messages.written, "Services"),
    "actions.md": partial(messages.written, "Actions"),
    "topics.md": topics.written,
    "events.md": events.written,
    "launch.md": launching.launches,
    "parameters.md": launching.parameters,
    "http.md": http.written,
    "hub-http.md": http.written_of_hub,
    "vda5050-fields.md": vda5050.written,
    "vda5050-cases.md": vda5050.cases,
    "vda5050-master-cases.md": vda5050.master_cases,
    "commands.md": commands.written,
    "policies.md": policies.written,
    "realism-parameters.md": numbers.realism,
    "plugins.md": numbers.plugins,
}
# Those that take Sphinx long.
API_PAGES: dict[str, Callable[[], str]] = {
    **{f"cpp/{name}.md": partial(apis.cpp, name) for name in apis.NAMESPACES},
    **{f"python/{name}.md": partial(apis.python, name) for name in apis.ABOUT},
}
