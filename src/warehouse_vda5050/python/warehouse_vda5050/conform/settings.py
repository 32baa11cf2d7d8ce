# SPDX-License-Identifier: Apache-2.0
"""How a vehicle is tried."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Limits of time and of place.

    answer: until a message is answered by a state [s]. edge: longest drive along one edge [s].
    case: longest case [s]. idle: how long a state may be awaited [s]; the specification says 30.
    spacing: length of an edge without a list of nodes [m]; edges: their count. heading: direction
    of them [rad], None for the vehicle's own. action: an action for nodes that does no harm, with
    parameters; '' for waitForTrigger where `trigger` ends it. strict: whether recommendations
    count."""

    answer: float = 5.0
    edge: float = 30.0
    case: float = 120.0
    idle: float = 31.0
    spacing: float = 1.0
    edges: int = 3
    heading: float | None = None
    action: str = ""
    parameters: tuple[tuple[str, str], ...] = ()
    strict: bool = False
