# SPDX-License-Identifier: Apache-2.0
"""Messages of masters and vehicles, independent of a version's names: SI units, radians.

A codec turns these into the JSON of one version of VDA 5050 and back. All are values: none is
changed once made.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from warehouse_vda5050.errors import Error
from warehouse_vda5050.paths import PlannedPath, Waypoint
from warehouse_vda5050.zones.zone import Response, Zone, ZoneRequest, ZoneSetState

MAP_ID = "warehouse"  # the one map that robots of this project know
LEAST_SPEED = 0.01  # of speed limits: a robot creeps at it [m/s]


class BlockingType(StrEnum):
    """What an action keeps from happening beside it."""

    NONE = "NONE"  # nothing
    SINGLE = "SINGLE"  # other actions; 3.0 alone has it
    SOFT = "SOFT"  # driving
    HARD = "HARD"  # driving and other actions


class ActionStatus(StrEnum):
    """The progress of an action."""

    WAITING = "WAITING"
    INITIALIZING = "INITIALIZING"
    RUNNING = "RUNNING"
    PAUSED = "PAUSED"
    RETRIABLE = "RETRIABLE"  # it failed, and waits for retry or skipRetry; 3.0 alone has it
    FINISHED = "FINISHED"
    FAILED = "FAILED"

    @property
    def is_over(self) -> bool:
        """Whether it is final."""
        return self in (ActionStatus.FINISHED, ActionStatus.FAILED)


class ConnectionState(StrEnum):
    """Whether a vehicle hears its broker."""

    ONLINE = "ONLINE"
    OFFLINE = "OFFLINE"
    CONNECTIONBROKEN = "CONNECTIONBROKEN"


class OperatingMode(StrEnum):
    """Who commands a vehicle; orders are taken in AUTOMATIC and SEMIAUTOMATIC."""

    AUTOMATIC = "AUTOMATIC"
    SEMIAUTOMATIC = "SEMIAUTOMATIC"
    MANUAL = "MANUAL"
    SERVICE = "SERVICE"
    TEACHIN = "TEACHIN"


@dataclass(frozen=True)
class Header:
    """Stands before each message; headerId and timestamp are of the sender's topic."""

    header_id: int = 0
    timestamp: str = ""  # ISO 8601, UTC, wall clock
    version: str = ""
    manufacturer: str = ""
    serial: str = ""


@dataclass(frozen=True)
class Position:
    """A point of a map [m]; theta [rad] is None where any heading will do."""

    x: float
    y: float
    theta: float | None = None
    map_id: str = ""


@dataclass(frozen=True)
class Action:
    """What a vehicle shall do at a node or an edge, or at once."""

    type: str
    id: str
    blocking: BlockingType = BlockingType.HARD
    parameters: tuple[tuple[str, Any], ...] = ()
    description: str = ""
    retriable: bool = False  # 3.0 alone has it

    def parameter(self, key: str, default: Any = None) -> Any:
        """Returns the value of a parameter, as it was sent."""
        return dict(self.parameters).get(key, default)


# At once, rather than with an order; blocking is BlockingType.NONE as a rule.
InstantAction = Action


@dataclass(frozen=True)
class Node:
    """A point of an order; `position` is None where its id says where it is. `demands` are optional
    fields with their values, as field_rules names them: allowedDeviationXY …"""

    id: str
    sequence: int
    released: bool
    position: Position | None = None
    actions: tuple[Action, ...] = ()
    description: str = ""
    demands: tuple[tuple[str, Any], ...] = ()


@dataclass(frozen=True)
class Edge:
    """The way between two nodes, straight. `demands` are optional fields with their values, as
    field_rules names them: maxSpeed, trajectory …"""

    id: str
    sequence: int
    released: bool
    start: str = ""  # node ids; 3.0 has none
    end: str = ""
    actions: tuple[Action, ...] = ()
    demands: tuple[tuple[str, Any], ...] = ()


@dataclass(frozen=True)
class VehicleOrder:
    """Nodes with the edges between them; those released come first and are the base, the rest is
    the horizon."""

    id: str
    update: int
    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...] = ()
    header: Header = Header()
    zone_set: str = ""

    @property
    def base(self) -> tuple[Node, ...]:
        """The released nodes."""
        return tuple(node for node in self.nodes if node.released)


@dataclass(frozen=True)
class InstantActions:
    """Actions to be carried out at once."""

    actions: tuple[InstantAction, ...]
    header: Header = Header()


@dataclass(frozen=True)
class ZoneSet:
    """Zones of one map under an id that stands for them for ever; 3.0 alone has it."""

    id: str
    map_id: str
    zones: tuple[Zone, ...]
    header: Header = Header()


@dataclass(frozen=True)
class Responses:
    """A master's answers to requests of a vehicle; 3.0 alone has it."""

    responses: tuple[Response, ...]
    header: Header = Header()


@dataclass(frozen=True)
class NodeState:
    """A node that the vehicle has not passed yet."""

    id: str
    sequence: int
    released: bool
    position: Position | None = None


@dataclass(frozen=True)
class EdgeState:
    """An edge that the vehicle has not driven yet."""

    id: str
    sequence: int
    released: bool


@dataclass(frozen=True)
class ActionState:
    """The progress of an action; `instant` marks one that belongs to no order."""

    id: str
    type: str
    status: ActionStatus
    result: str = ""
    instant: bool = False


@dataclass(frozen=True)
class Battery:
    """charge in 0 … 100 percent."""

    charge: float = 100.0
    charging: bool = False


@dataclass(frozen=True)
class AgvPosition:
    """Where a vehicle is [m, rad]; `initialized` is whether it knows that."""

    x: float
    y: float
    theta: float
    map_id: str = MAP_ID
    initialized: bool = True


@dataclass(frozen=True)
class Velocity:
    """A velocity in the vehicle's own frame, x forward [m/s, rad/s]."""

    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0


@dataclass(frozen=True)
class Load:
    """What a vehicle carries."""

    id: str
    type: str = "unit"


@dataclass(frozen=True)
class VehicleState:
    """The state of a vehicle, sent at every event and at least each 30 s."""

    order_id: str = ""
    order_update: int = 0
    last_node: str = ""
    last_node_sequence: int = 0
    nodes: tuple[NodeState, ...] = ()
    edges: tuple[EdgeState, ...] = ()
    actions: tuple[ActionState, ...] = ()
    driving: bool = False
    paused: bool = False
    new_base_request: bool = False
    position: AgvPosition | None = None
    velocity: Velocity | None = None
    loads: tuple[Load, ...] = ()
    battery: Battery = Battery()
    mode: OperatingMode = OperatingMode.AUTOMATIC
    errors: tuple[Error, ...] = ()
    emergency_stop: bool = False
    field_violation: bool = False
    maps: tuple[str, ...] = ()
    distance_since_last_node: float | None = None  # [m]
    zone_sets: tuple[ZoneSetState, ...] = ()  # 3.0 alone has this and what follows
    zone_requests: tuple[ZoneRequest, ...] = ()
    planned: PlannedPath | None = None
    intermediate: tuple[Waypoint, ...] = ()
    header: Header = Header()


@dataclass(frozen=True)
class Connection:
    """Whether a vehicle is there; retained by the broker."""

    state: ConnectionState
    header: Header = Header()


@dataclass(frozen=True)
class Visualization:
    """Position and speed alone, for pictures. state_id: headerId of the state before it; 3.0 alone
    has it."""

    position: AgvPosition | None = None
    velocity: Velocity | None = None
    header: Header = Header()
    state_id: int = 0


@dataclass(frozen=True)
class SupportedAction:
    """An action that a vehicle knows; scopes are INSTANT, NODE, EDGE, parameters are (key, type,
    optional, description); no blocking types where a factsheet of others does not say."""

    type: str
    scopes: tuple[str, ...]
    description: str = ""
    parameters: tuple[tuple[str, str, bool, str], ...] = ()
    blocking: tuple[BlockingType, ...] = (BlockingType.NONE,)
    can_pause: bool = False
    can_cancel: bool = False


@dataclass(frozen=True)
class LoadSet:
    """A kind of load that a vehicle takes, up to some size [m], mass [kg] and speed with it [m/s];
    None where its factsheet does not say."""

    name: str
    load_type: str
    length: float | None = None
    width: float | None = None
    height: float | None = None
    max_mass: float | None = None
    max_speed: float | None = None


@dataclass(frozen=True)
class Lengths:
    """The longest strings and arrays that a vehicle takes, by maxStringLens and maxArrayLens of its
    factsheet; 0 is no limit. word: enumerations and keys; is_numeric: ids are digits alone."""

    message: int = 0  # bytes
    id: int = 0
    is_numeric: bool = False
    word: int = 0
    load_id: int = 0
    node_actions: int = 0
    parameters: int = 0  # of an action
    instant_actions: int = 0  # of a message


@dataclass(frozen=True)
class Factsheet:
    """What a kind of vehicle is and can [m, kg, s]. `load_sets` is empty where it names none;
    `silent` names fields, as in 2.1.0, that it leaves out and that have the values of here;
    `faults` are sentences about fields that do not fit the schema."""

    series: str = "Kiva"
    description: str = ""
    kinematics: str = "DIFF"
    vehicle_class: str = "CARRIER"
    max_load_mass: float = 450.0
    length: float = 0.76
    width: float = 0.6
    height: float = 0.4
    max_speed: float = 1.5
    max_acceleration: float = 1.0
    max_deceleration: float = 1.0
    lift_time: float = 2.2
    quarter_turn: float = 0.625  # the time that it takes
    load_size: tuple[float, float] = (0.8, 0.8)
    load_type: str = "unit"
    height_loaded: float = 1.9
    precision: float = 0.005  # how near to a node's position it comes
    heading_precision: float = 0.02  # [rad]
    localization: tuple[str, ...] = ("GRID",)
    navigation: tuple[str, ...] = ("VIRTUAL_LINE_GUIDED",)
    actions: tuple[SupportedAction, ...] = ()
    # Parameters of orders and what a vehicle makes of them, SUPPORTED or REQUIRED.
    parameters: tuple[tuple[str, str, str], ...] = ()
    max_nodes: int = 1000
    max_actions: int = 20
    max_message: int = 1 << 20  # bytes
    max_errors: int = 20
    state_interval: float = 30.0
    order_interval: float = 0.0  # least time between two orders [s]
    versions: tuple[tuple[str, str], ...] = ()
    zone_types: tuple[str, ...] = ()  # that it keeps to; 3.0 alone has it
    max_zones: int = 0  # of one zone set
    load_sets: tuple[LoadSet, ...] = ()
    silent: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    header: Header = field(default_factory=Header)
    keeps_speeds: bool = False  # whether it slows down for edges and zones with speed limits
    lengths: Lengths = Lengths()  # that a master's messages keep to


@dataclass(frozen=True)
class InvalidFactsheet:
    """A factsheet that can't be read; `fault` names the field and what was expected."""

    fault: str


ToVehicle = VehicleOrder | InstantActions | ZoneSet | Responses
Message = ToVehicle | VehicleState | Connection | Visualization | Factsheet
