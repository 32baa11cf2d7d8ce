# SPDX-License-Identifier: Apache-2.0
"""Our master and our vehicle with a line between them, a second a step, and a coordinator that has
units carried to and fro. What must never happen is checked at each step."""

from dataclasses import dataclass, field, replace

from grid_robot import GRID, Bench

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.master.commands import Follow, Lift
from warehouse_vda5050.master.remote_vehicle import EventKind, RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.model import (
    Action,
    BlockingType,
    ConnectionState,
    InstantActions,
    VehicleOrder,
)
from warehouse_vda5050.topics import Identity, Kind
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

WHO = Identity("kiva", "1")
PLACES = ((3, 2), (8, 4), (1, 7))  # a unit goes from each to the next; at first it is at the first
UNIT = 7
CODEC = codec_for()


class Line:
    """One direction of quality of service 0: each message is lost, doubled, late, or arrives."""

    def __init__(self):
        self.fates = []  # of the next messages; further ones arrive
        self.on_its_way, self.late = [], []
        self.broken = False

    def post(self, message):
        fate = self.fates.pop(0) if self.fates else "arrives"
        if self.broken:
            return
        if fate == "late":
            self.late.append(message)
        self.on_its_way += [message] * {"arrives": 1, "doubled": 2}.get(fate, 0)

    def arrived(self):
        """Returns what has arrived; what is late comes a step later, after what was sent since."""
        arrived, self.on_its_way, self.late = self.on_its_way, self.late, []
        return [] if self.broken else arrived

    def cut(self, broken):
        self.broken = broken
        self.on_its_way, self.late = [], []


@dataclass
class Trip:
    """An order as the master sent it, and what the robot did of it. `base` counts the released."""

    cells: dict = field(default_factory=dict)
    base: int = 0
    reached: int = 1
    lifts: list = field(default_factory=list)  # types of its actions
    lifted: int = 0


class Witness:
    """Knows what was ordered, and that no more than that is done, and nothing twice."""

    def __init__(self):
        self.trips = {}
        self.event_count = 0  # events of the robot

    def note(self, order):
        trip = self.trips.setdefault(order.id, Trip())
        for node in order.nodes:
            i = node.sequence // 2
            if i < trip.base:
                assert trip.cells[i] == node.id, "the base was changed"
            trip.cells[i] = node.id
            trip.lifts = [action.type for action in node.actions] or trip.lifts
        released = order.nodes[0].sequence // 2 + len(order.base)
        assert released >= trip.base, "the base was taken back"
        trip.base = released

    def check(self, order_id, events):
        for what, _, cell in events[self.event_count :]:
            trip = self.trips[order_id]
            if what == "at":
                assert trip.reached < trip.base, f"{cell} is beyond the base of {order_id}"
                assert trip.cells[trip.reached] == GRID.node_id(cell), order_id
                trip.reached += 1
            else:
                trip.lifted += 1
                assert (trip.lifts, trip.lifted) == ([what], 1), f"{what} by {order_id}"
        self.event_count = len(events)


class BothSides:
    """The vehicle, whose events `witness` sees, and the master, with the lines `down` and `up`."""

    def __init__(self):
        self.bench = Bench((0, 0), {f"storage_unit{UNIT}": PLACES[0]})
        self.down, self.up = Line(), Line()
        self.witness, self.clock, self.runs = Witness(), 1000.0, 0
        self.order_id = ""  # of the vehicle's last order
        self.progress = {}  # by run and order, how far the vehicle told to be
        self.start_master()
        self.restart_vehicle(0.0)

    @property
    def robot(self):
        return self.bench.robot

    @property
    def vehicle(self):
        return self.bench.vehicle

    def start_master(self):
        """A new master; the broker tells it that the vehicle is there, if it is."""
        self.runs += 1
        self.master = RemoteVehicle(RemoteRobot(1, WHO), GRID, f"run{self.runs}")
        self.master_headers = Headers(WHO, "2.1.0", lambda: self.clock)
        self.events = []
        self.down.cut(self.down.broken)
        self.up.cut(self.up.broken)
        if not self.up.broken:
            self.master.take_connection(ConnectionState.ONLINE, self.clock)

    def restart_vehicle(self, clock_back):
        """The vehicle's program ends without a word and begins again, its clock set back; the robot
        drives on."""
        self.runs += 1
        settings = VehicleSettings(first_path=1000 * self.runs)
        self.bench.vehicle = Vehicle(self.robot, GRID, settings)
        self.vehicle_headers = Headers(WHO, "2.1.0", lambda: self.clock - clock_back)
        self.connect()

    def connect(self):
        """The vehicle is at the broker again. Of what there was before nothing arrives."""
        self.down.cut(False)
        self.up.cut(False)
        self.master.take_connection(ConnectionState.ONLINE, self.clock)
        self.vehicle.request_state()

    def disconnect(self, is_announced):
        """The broker is gone; `is_announced`: it said before that the vehicle is."""
        self.down.cut(True)
        self.up.cut(True)
        if is_announced:
            self.master.take_connection(ConnectionState.CONNECTIONBROKEN, self.clock)

    def cancel_from_elsewhere(self):
        """Another master cancels what the vehicle does; none tells ours."""
        action = Action("cancelOrder", f"elsewhere-{self.clock}", BlockingType.NONE)
        self.vehicle.on_instant_actions(InstantActions((action,)), self.bench.now)

    def step(self):
        self.clock += 1.0
        for message in self.master.messages(self.clock):
            self.send(message)
        for kind, payload in self.down.arrived():
            self.deliver(kind, CODEC.decode(kind, payload).message)
        before = len(self.bench.states)
        self.bench.tick()
        self.observe()
        for state in self.bench.states[before:]:
            self.check_state(state)
            self.post(self.up, self.vehicle_headers, Kind.STATE, state)
        for kind, payload in self.up.arrived():
            self.master.take_state(CODEC.decode(kind, payload).message, self.clock)
        self.events += self.master.take_events()

    def send(self, message):
        kind = Kind.ORDER if isinstance(message, VehicleOrder) else Kind.INSTANT_ACTIONS
        if kind is Kind.ORDER:
            self.witness.note(message)
        self.post(self.down, self.master_headers, kind, message)

    def post(self, line, headers, kind, message):
        line.post((kind, CODEC.encode(replace(message, header=headers.next(kind)))))

    def deliver(self, kind, message):
        now = self.bench.now
        if kind is Kind.ORDER:
            self.vehicle.on_order(message, now)
        else:
            self.vehicle.on_instant_actions(message, now)

    def observe(self):
        if self.vehicle.order:
            self.order_id = self.vehicle.order.id
        self.witness.check(self.order_id, self.robot.events)

    def check_state(self, state):
        run = self.vehicle.settings.first_path, state.order_id
        far = state.order_update, state.last_node_sequence
        before = self.progress.setdefault(run, far)
        assert not state.order_id or (far[0] >= before[0] and far[1] >= before[1]), "goes back"
        self.progress[run] = far

    def take_events(self):
        events, self.events = self.events, []
        return events


class Coordinator:
    """Has the unit carried from place to place by what the master tells; `carried` counts."""

    def __init__(self, sides):
        self.sides, self.carried, self.path_id = sides, 0, 0
        self.points, self.released = (), 0
        self.place = 0  # where the unit stands, or stood before it was taken up

    def step(self, release):
        """Gives the next command, and releases so many points more of the path under way."""
        master = self.sides.master
        self.carried += sum(e.kind is EventKind.DROPPED for e in self.sides.take_events())
        if not master.is_idle:
            self.release(release)
        elif not master.view.why_not:
            self.next_command(1 + max(1, release))

    def release(self, more):
        if more and self.released < len(self.points):
            self.released = min(len(self.points), self.released + more)
            self.sides.master.command(Follow(self.path_id, 0, (), self.released))

    def next_command(self, released):
        master, stands = self.sides.master, self.sides.robot.units.get(f"storage_unit{UNIT}")
        self.place = PLACES.index(stands) if stands else self.place
        goal = PLACES[(self.place + bool(master.load)) % len(PLACES)]
        here = GRID.cell_at(*master.view.pose[:2])
        self.points = () if here == goal else way(here, goal)
        if not self.points:
            master.command(Lift(not master.load, UNIT))
            return
        self.path_id, self.released = self.path_id + 1, min(len(self.points), released)
        master.command(Follow(self.path_id, 0, self.points, self.released))


def way(start, goal):
    """Points from one cell to another, along x first."""
    cells = [start]
    while cells[-1] != goal:
        x, y = cells[-1]
        step = (1 if goal[0] > x else -1, 0) if x != goal[0] else (0, 1 if goal[1] > y else -1)
        cells.append((x + step[0], y + step[1]))
    return tuple((float(x), float(y)) for x, y in cells)
