# SPDX-License-Identifier: Apache-2.0
"""Policies of a shift, by their roles."""

import inspect
from typing import Any

from reference.markdown import block, code, page, prose, table


def written() -> str:
    """Returns the page of policy files."""
    from warehouse_operations import policies

    sections = [section(role, names, policies) for role, names in policies.ROLES.items()]
    return page("Policy files", block(inspect.getdoc(policies) or ""), *sections)


def section(role: str, names: dict[str, Any], policies: Any) -> str:
    """Returns a role: what it decides, its method, and the classes that come along."""
    protocol = role_protocol(role, policies)
    method = policies.METHODS[role]
    signature = f"{method}{inspect.signature(getattr(protocol, method))}"
    rows = [
        (
            code(name) + (" (default)" if name == policies.DEFAULTS[role] else ""),
            options(policy),
            prose(about(policy)),
        )
        for name, policy in names.items()
    ]
    documentation = inspect.getdoc(getattr(protocol, method)) or ""
    return "\n\n".join(
        [
            f"## {role}",
            prose(inspect.getdoc(protocol) or ""),
            block(signature + "\n\n" + documentation),
            table(["name", "options", ""], rows),
        ]
    )


def role_protocol(role: str, policies: Any) -> Any:
    """Returns the protocol that a role's classes fulfil."""
    return (
        getattr(policies, policies.Policies.__annotations__[role])
        if isinstance(policies.Policies.__annotations__[role], str)
        else policies.Policies.__annotations__[role]
    )


def options(kind: Any) -> str:
    """Returns a class's options with their defaults."""
    if kind.__init__ is object.__init__:
        return ""
    parameters = list(inspect.signature(kind).parameters.values())
    return ", ".join(f"`{parameter.name}: {_default(parameter)}`" for parameter in parameters)


def about(kind: Any) -> str:
    """Returns the first paragraph of a class's docstring."""
    return (inspect.getdoc(kind) or "").split("\n\n")[0]


def _default(parameter: inspect.Parameter) -> str:
    return "needed" if parameter.default is parameter.empty else str(parameter.default)
