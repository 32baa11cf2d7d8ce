# SPDX-License-Identifier: Apache-2.0
"""Orders, stock, stations and figures of a shift."""

from typing import TYPE_CHECKING, Literal, get_args

from pydantic import BaseModel, Field, StrictBool

from warehouse_viewer.api.schemas.base import INT32, Person, UInt8
from warehouse_viewer.api.schemas.pydantic_versions import (
    Body,
    characters,
    integer,
    items,
    number,
    text,
)

State = Literal["OPEN", "ASSIGNED", "COMPLETED", "CANCELLED"]
Mode = Literal["AUTOMATIC", "MANUAL"]
PickOutcome = Literal["DONE", "SHORT", "DAMAGED"]
# Names by the numbers of the messages.
Activity = Literal["RESTING", "MOVING", "WORKING", "WAITING", "NEEDS_HELP"]
STATES, MODES, OUTCOMES = map(get_args, (State, Mode, PickOutcome))


if TYPE_CHECKING:
    Sku = str
    Reference = str
    Pieces = int
    PiecesOrNone = int
    OrderNumber = int
    ReportId = str
    Moment = float
else:
    Sku, Reference = text(r"^[ -~]+$", 80, least=1), text(r"^[ -~]*$", 200)
    Pieces, PiecesOrNone = integer(1, INT32), integer(0, INT32)
    OrderNumber = integer(0, 2**53)  # 0: none
    ReportId = text(r"^[!-~]*$", 80)
    Moment = number(0, 4e9)  # a simulated time [s]


class Line(Body):
    """Pieces of one kind of goods."""

    sku: Sku
    quantity: Pieces


class NewOrder(Body):
    """An order; `due` in simulated time, 0 = none."""

    reference: Reference = ""
    lines: list[Line] = Field(**items(1, 100))
    due: Moment = Field(0.0, description="[s], simulated time")
    priority: UInt8 = 0


class OrderChange(Body):
    """Makes an order more or less urgent; what is left out stays as it is."""

    priority: UInt8 | None = None
    due: Moment | None = Field(None, description="[s], simulated time; 0 = none")


class PastEvent(BaseModel):
    """Something that happened to an order."""

    time: float = Field(description="[s], simulated")
    kind: str
    sku: str
    quantity: int
    station: str
    storage_unit: str
    text: str


class OrderHistory(BaseModel):
    """What has become of an order so far, and what is on its way for it."""

    events: list[PastEvent] = Field(description="the oldest first, 500 at most")
    storage_units: list[str] = Field(description="at its station, or on their way there")
    estimated: float = Field(description="when it is likely complete [s], simulated; 0: not known")


class Accepted(BaseModel):
    """The number of an order that was accepted."""

    order_id: int
    message: str


class OrderTable(Body):
    """Orders as a table in CSV: columns reference, sku, quantity, and, if you like, due [s] and
    priority; rows of one reference are one order."""

    table: str = Field(**characters(1, 4_000_000))
    check_only: StrictBool = Field(False, description="accepts nothing, says what would be")


class TableFault(BaseModel):
    """What is wrong in a line of a table."""

    line: int = Field(description="counted from 1; 0: the table as a whole")
    column: str = Field(description="empty: the line as a whole")
    text: str


class TableAnswer(BaseModel):
    """What became of a table of orders: all are accepted, or none."""

    accepted: bool
    orders: int
    lines: int
    pieces: int
    order_ids: list[int] = Field(description="empty where it was only checked, or has faults")
    faults: list[TableFault] = Field(description="the first ones")


class StockedSku(BaseModel):
    """A SKU, and its pieces in stock that are not promised to an order."""

    sku: str
    available: int


class Skus(BaseModel):
    """SKUs, and how many there are in all."""

    total: int
    skus: list[StockedSku]


class OrderLine(BaseModel):
    """A line of an order, and the count of pieces already picked for it."""

    sku: str
    quantity: int
    picked: int


class Order(BaseModel):
    """Times are simulated seconds of the run in which it came; 0 = none, not yet."""

    order_id: int
    reference: str
    state: State
    station: str
    priority: int
    created: float
    due: float
    completed: float
    lines: list[OrderLine]


class Orders(BaseModel):
    """Orders, and how many there are in all."""

    total: int
    orders: list[Order]


class Place(BaseModel):
    """A bin on a storage unit: what lies in it, in pieces."""

    item: str
    shelf_id: int
    sku: str
    quantity: int
    reserved: int
    capacity: int


class Stock(BaseModel):
    """Bins, how many there are in all, and their pieces."""

    total: int
    pieces: int
    places: list[Place]


class Pick(BaseModel):
    """Pieces to be taken out at a station for an order."""

    sku: str
    quantity: int
    item: str
    order_id: int
    reference: str
    sequence: int = Field(description="number of the task; a partly done task gets a new number")
    tote: int = Field(description="place of the order's tote at the station, from 1; 0: none")


class Tote(BaseModel):
    """An order's tote at a picking station, and what still goes into it."""

    position: int = Field(description="from 1; the order's own until it leaves the station")
    order_id: int
    reference: str
    lines_left: int
    pieces_left: int
    pieces: int = Field(description="pieces of the whole order")


class Queued(BaseModel):
    """A storage unit on its way to a station."""

    unit: int
    robot: int = Field(description="that carries it; 0: none does yet")
    stands: float = Field(description="how long the robot has stood [s]")
    is_long: bool = Field(description="whether that is too long")


class Station(BaseModel):
    """A picking or replenishment station, and its work."""

    name: str
    kind: str
    open: bool
    mode: Mode
    shelf_id: int
    inbound: list[int]
    orders: list[int]
    slots: int
    picks: list[Pick]
    pieces: int
    busy_fraction: float
    waiting: float = Field(
        description="time that the station has waited for a person [s]; 0: it does not wait"
    )
    activity: Activity = Field(description="at a glance; WAITING: too long without a unit")
    since: float = Field(
        description="since when the unit is there, or the station does what it does [s], simulated"
    )
    pieces_per_hour: float = Field(description="of the last quarter of an hour")
    inbound_orders: list[int] = Field(
        description="an order that each unit of `inbound` is brought for; 0: goods, or not known"
    )
    why: str = Field("", description="why it waits, or what it does; see /why")
    queue: list[Queued] = Field(description="of `inbound`")
    totes: list[Tote] = Field(description="by position; of a station in mode MANUAL alone")


class Stations(BaseModel):
    """All stations."""

    stations: list[Station]


class SetStation(Body):
    """Opens or closes a station, and sets its mode."""

    open: StrictBool
    mode: Mode = "AUTOMATIC"
    by: Person = Field("", description="name of the person that sets it; empty: not known")


class Confirmation(Line):
    """Confirms that a number of pieces was taken out, or a bundle was put in."""


class Short(Line):
    """Reports a number of pieces as missing or damaged; those to be put in stay out."""

    damaged: StrictBool = False


class PickReport(Body):
    """The outcome of a pick at a station. SHORT: `quantity` pieces are missing, 0 if the
    bin is empty; DAMAGED: `quantity` are. A report that comes again under its id gets the first
    answer."""

    order_id: OrderNumber = 0
    item: Sku
    quantity: PiecesOrNone
    outcome: PickOutcome = "DONE"
    id: ReportId = Field("", description="the sender's name of this report; another one for each")


class Reported(BaseModel):
    """Says what a pick's report has led to."""

    message: str
    quantity: int = Field(description="pieces taken, put in or written off")


class Throughput(BaseModel):
    """What the stations did in each interval of the last hour, the oldest first. Intervals begin at
    whole multiples of their length; the last one goes on."""

    interval: float = Field(description="duration of an interval [s], simulated")
    begin: float = Field(
        description="begin of the first interval [s], simulated; the shift's begin if that is later"
    )
    end: float = Field(description="end of the last complete interval [s]")
    items_picked: list[int]
    pieces_stored: list[int]
    orders_completed: list[int]


class Notices(BaseModel):
    """Notices, as text."""

    notices: list[str]


class Heat(BaseModel):
    """Where robots drive and wait, by cell, row after row from the smallest y on."""

    seconds: float = Field(description="time that the map covers [s], an hour at most")
    x: float = Field(description="x of the first cell's centre [m]")
    y: float
    spacing: float = Field(description="spacing of the cells [m]")
    width: int = Field(description="cells in a row")
    traffic: list[float] = Field(description="robots that came into the cell")
    waiting: list[float] = Field(description="[s] that robots waited there for their way")
