# SPDX-License-Identifier: Apache-2.0
"""Master and vehicle over a line that loses, doubles and swaps messages, while brokers, masters and
vehicles end and begin: what is ordered is done once and whole, and in the end all goes on.

VDA5050_HISTORIES says how many histories are played.
"""

import os

from grid_robot import order
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, precondition, rule
from two_sides import PLACES, BothSides, Coordinator

from warehouse_vda5050.master.commands import Cancel, Stop

HISTORIES = int(os.environ.get("VDA5050_HISTORIES", "25"))
CALM = 400  # [s] in which transports have to be carried out once messages arrive again
FATES = st.lists(st.sampled_from(["arrives", "lost", "doubled", "late"]), max_size=4)


class Histories(RuleBasedStateMachine):
    """A day of bad luck, a rule an accident; between them transports go on."""

    def __init__(self):
        super().__init__()
        self.sides = BothSides()
        self.coordinator = Coordinator(self.sides)

    def go_on(self, seconds=1, release=1):
        for _ in range(seconds):
            self.coordinator.step(release)
            self.sides.step()

    @rule(down=FATES, up=FATES, release=st.integers(0, 3), seconds=st.integers(1, 4))
    def messages_meet_their_fates(self, down, up, release, seconds):
        self.sides.down.fates, self.sides.up.fates = down, up
        self.go_on(seconds, release)

    @rule(seconds=st.integers(1, 30))
    def nothing_arrives(self, seconds):
        for line in (self.sides.down, self.sides.up):
            line.fates = ["lost"] * 100
        self.go_on(seconds)
        for line in (self.sides.down, self.sides.up):
            line.fates = []

    @rule(is_announced=st.booleans(), seconds=st.integers(1, 30))
    def the_broker_ends_and_begins(self, is_announced, seconds):
        self.sides.disconnect(is_announced)
        self.go_on(seconds)
        self.sides.connect()

    @rule()
    def the_master_ends_and_begins(self):
        self.sides.start_master()

    @rule(clock_back=st.sampled_from([0.0, 0.5, 500.0]), is_announced=st.booleans())
    def the_vehicles_program_ends_and_begins(self, clock_back, is_announced):
        self.sides.disconnect(is_announced)
        self.sides.restart_vehicle(clock_back)

    @rule(seconds=st.integers(1, 5))
    def the_robot_is_deaf(self, seconds):
        self.sides.robot.deaf = True
        self.go_on(seconds)
        self.sides.robot.deaf = False

    @rule(seconds=st.integers(1, 10))
    def it_is_paused(self, seconds):
        self.sides.master.command(Stop(True))
        self.go_on(seconds)
        self.sides.master.command(Stop(False))

    @rule()
    def it_is_cancelled(self):
        self.sides.master.command(Cancel())

    @precondition(lambda self: not self.sides.vehicle.is_free)
    @rule()
    def another_master_orders_it_too(self):
        cell = self.sides.robot.cell
        assert not self.sides.vehicle.on_order(order("theirs", [cell]), self.sides.bench.now)

    @rule()
    def another_master_cancels(self):
        self.sides.cancel_from_elsewhere()

    def teardown(self):
        """Once messages arrive again, transports are carried out."""
        self.go_on()  # what is late has come
        self.sides.master.command(Stop(False))
        robot, carried = self.sides.robot, self.coordinator.carried
        for _ in range(CALM):
            self.go_on()
            if self.coordinator.carried >= carried + 2:
                break
        assert self.coordinator.carried >= carried + 2, self.sides.master.__dict__
        lifts = [what for what, *_ in robot.events if what != "at"]
        assert lifts == ["pick", "drop"] * (len(lifts) // 2)
        assert robot.cell in PLACES


Histories.TestCase.settings = settings(
    max_examples=HISTORIES,
    stateful_step_count=30,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    database=None,
)
TestHistories = Histories.TestCase
