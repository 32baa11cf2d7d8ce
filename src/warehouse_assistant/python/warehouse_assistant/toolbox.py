# SPDX-License-Identifier: Apache-2.0
"""How a tool is registered: with a title, hints, and whether it changes something."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any

from mcp.server import MCPServer
from mcp.types import ToolAnnotations
from pydantic import Field

from warehouse_assistant.hub_client import HubClient
from warehouse_assistant.library import Library
from warehouse_assistant.words import Replies

Tool = Callable[..., Any]

Simulation = Annotated[
    str, Field(max_length=40, description="name of a simulation; empty: the only one that runs")
]
Robot = Annotated[int, Field(ge=1, le=2**31 - 1, description="the number of a robot: 3 of kiva3")]
Unit = Annotated[
    int, Field(ge=1, le=2**31 - 1, description="the number of a storage unit: 12 of storage_unit12")
]
Station = Annotated[str, Field(min_length=1, max_length=100, description="a station, as pick1")]
Priority = Annotated[int, Field(ge=0, le=255, description="higher ones come first")]


@dataclass
class Toolbox:
    """The context of all tools: their registry, the hub, the documentation, long replies."""

    server: MCPServer
    hub: HubClient
    library: Library
    replies: Replies = field(default_factory=Replies)
    changing: set[str] = field(default_factory=set)  # names of tools that need permission

    def reads(self, title: str) -> Callable[[Tool], Tool]:
        """Registers a function as a tool that changes nothing."""
        return self._registered(title, True, False, True)

    def changes(
        self, title: str, *, destroys: bool = False, repeatable: bool = False
    ) -> Callable[[Tool], Tool]:
        """Registers a function as a tool that needs permission.

        destroys: its effect can't be undone. repeatable: a second call with the same arguments
        changes nothing more.
        """
        return self._registered(title, False, destroys, repeatable)

    def _registered(
        self, title: str, reads: bool, destroys: bool, repeatable: bool
    ) -> Callable[[Tool], Tool]:
        hints = ToolAnnotations(
            title=title,
            read_only_hint=reads,
            destructive_hint=destroys,
            idempotent_hint=repeatable,
            open_world_hint=False,
        )

        def register(tool: Tool) -> Tool:
            if not reads:
                self.changing.add(tool.__name__)
            return self.server.tool(title=title, annotations=hints, structured_output=False)(tool)

        return register
