# SPDX-License-Identifier: Apache-2.0
"""Messages that are lost, doubled or swapped: nothing is done twice, no base is changed.

A master sends one order after another in pieces, and sends again what the state does not show.
VDA5050_HISTORIES says how many histories are played.
"""

import os
from dataclasses import dataclass, field

from grid_robot import GRID, Bench, drop, is_over, order, pick, row
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

HISTORIES = int(os.environ.get("VDA5050_HISTORIES", "60"))
TRIPS = [row(0, 6), [(6, 0), (6, 1), (6, 2), (5, 2)], [(5, 2), (4, 2), (4, 1), (4, 0)]]
FATES = st.lists(
    st.sampled_from(["arrives", "lost", "doubled", "late"]), min_size=4, max_size=40
)


@dataclass
class Wire:
    """A connection of quality of service 0 with a fate for each message; later ones arrive."""

    fates: list
    deliver: object
    late: list = field(default_factory=list)

    def send(self, message):
        fate = self.fates.pop(0) if self.fates else "arrives"
        if fate == "late":
            self.late.append(message)
            return
        for _ in range({"arrives": 1, "lost": 0, "doubled": 2}[fate]):
            self.deliver(message)
        if fate != "lost":
            self.flush()

    def flush(self):
        late, self.late = self.late, []
        for message in late:
            self.deliver(message)


class PatientMaster:
    """Drives the trips a piece at a time; `stride` nodes a message."""

    def __init__(self, bench, wire, stride):
        self.bench, self.wire, self.stride = bench, wire, stride
        self.trip, self.update, self.waited = 0, 0, 0
        self.last = None
        self.accepted = []

    def send_next(self):
        cells = TRIPS[self.trip]
        first = self.update * self.stride
        end = min(len(cells), first + self.stride + 1)
        actions = {0: [pick(id=f"p{self.trip}")]} if first == 0 else {}
        if end == len(cells):
            actions[end - 1 - first] = [drop(id=f"d{self.trip}")]
        self.last = order(
            f"trip{self.trip}", cells[first:], end - first, self.update, first, actions
        )
        # The horizon's own actions go with the piece that releases them.
        self.wire.send(self.last)

    def step(self):
        """Sends the next piece once the state shows the one before, or that one again."""
        state = self.bench.vehicle.state()
        shown = (state.order_id, state.order_update) == (f"trip{self.trip}", self.update)
        if self.last is None:
            self.send_next()
        elif not shown:
            self.waited += 1
            if self.waited % 5 == 0:
                self.wire.send(self.last)
        elif (self.update + 1) * self.stride < len(TRIPS[self.trip]) - 1:
            self.update += 1
            self.send_next()
        elif is_over(state):
            self.trip, self.update, self.last = self.trip + 1, 0, None


@settings(
    max_examples=HISTORIES, deadline=None, suppress_health_check=list(HealthCheck), database=None
)
@given(FATES, st.integers(1, 4), st.integers(1, 3), st.lists(st.booleans(), max_size=30))
def test_every_trip_is_driven_once_whatever_happens_to_its_messages(fates, stride, pace, deaf):
    bench = Bench(units={"7": (0, 0)})
    wire = Wire(fates, lambda message: bench.vehicle.on_order(message, bench.now))
    master = PatientMaster(bench, wire, stride)
    for _ in range(600):
        bench.robot.deaf = bool(deaf) and deaf.pop()
        master.step()
        bench.tick(pace)
        if master.trip == len(TRIPS):
            break
    assert master.trip == len(TRIPS), bench.vehicle.state()
    wire.flush()  # copies of what is long over
    bench.tick(20)
    driven = [cell for what, _, cell in bench.robot.events if what == "at"]
    assert driven == [cell for trip in TRIPS for cell in trip[1:]]
    lifts = [what for what, *_ in bench.robot.events if what != "at"]
    assert lifts == ["pick", "drop"] * len(TRIPS)
    assert all(GRID.contains(cell) for cell in driven)
    sequences = [s.last_node_sequence for s in bench.states if s.order_id == "trip0"]
    assert sequences == sorted(sequences)
