# SPDX-License-Identifier: Apache-2.0
"""Carries out the actions of an order at a node: lifting, charging, waiting for a trigger."""

from warehouse_vda5050.driver import Driver, Report
from warehouse_vda5050.model import Action
from warehouse_vda5050.vehicle.actions import ActionQueue

PATIENCE = 3.0  # a lift that has not begun within this is commanded again [s]
ATTEMPTS = 20


class Hands:
    """What one vehicle does beside driving. One lift at a time."""

    def __init__(self, driver: Driver, actions: ActionQueue) -> None:
        self._driver, self.actions = driver, actions
        self._lift: Action | None = None
        self._asked = 0.0
        self._attempts = 0
        self._seen_busy = False

    def begin(self, action: Action, report: Report, now: float) -> None:
        """Begins an action that is its turn."""
        if action.type in ("pick", "drop"):
            self._begin_lift(action, report, now)
        elif action.type in ("startCharging", "stopCharging"):
            reason = self._driver.charge(action.type == "startCharging")
            if reason:
                self.actions.fail(action.id, reason)
            else:
                self.actions.finish(action.id)

    def _begin_lift(self, action: Action, report: Report, now: float) -> None:
        up, unit = action.type == "pick", unit_of(action)
        if up and report.load:
            self.actions.fail(action.id, f"the robot carries {report.load} already")
        elif not up and not report.load:
            self.actions.fail(action.id, "the robot carries nothing")
        elif not up and unit and unit != report.load:
            self.actions.fail(action.id, f"the robot carries {report.load}, not {unit}")
        else:
            self._lift, self._attempts, self._seen_busy = action, 0, False
            self._ask(now)

    def _ask(self, now: float) -> None:
        assert self._lift
        self._asked, self._attempts = now, self._attempts + 1
        self._driver.lift(unit_of(self._lift), self._lift.type == "pick")

    def watch(self, report: Report, now: float) -> None:
        """Ends a lift that is done or failed; asks again for one that was not heard."""
        action = self._lift
        if action is None:
            return
        self._seen_busy |= report.busy
        if not report.busy and bool(report.load) == (action.type == "pick"):
            self._end(f"carries {report.load}" if report.load else "")
        elif report.refusal and now - self._asked > 0.5:
            self._end(fault=report.refusal)
        elif self._seen_busy and not report.busy:
            self._end(fault="the lift ended without the unit")
        elif not self._seen_busy and now - self._asked > PATIENCE:
            if self._attempts < ATTEMPTS:
                self._ask(now)
            else:
                self._end(fault="the robot does not answer")

    def _end(self, result: str = "", fault: str = "") -> None:
        assert self._lift
        if fault:
            self.actions.fail(self._lift.id, fault)
        else:
            self.actions.finish(self._lift.id, result)
        self._lift = None

    def trigger(self) -> bool:
        """Ends all actions that wait for a trigger. Returns whether there was one."""
        waiting = [a for a in self.actions.running if a.type == "waitForTrigger"]
        for action in waiting:
            self.actions.finish(action.id)
        return bool(waiting)

    def give_up(self) -> None:
        """Ends what need not come to its end: all but a lift."""
        for action in [a for a in self.actions.running if a is not self._lift]:
            self.actions.give_up(action.id, "the order was cancelled")

    def retry(self, action_id: str, report: Report, now: float) -> bool:
        """Begins an action again that failed and waits for that. Returns whether it did."""
        action = self.actions.retry(action_id)
        if action:
            self.begin(action, report, now)
        return action is not None

    def skip(self, action_id: str) -> bool:
        """Ends an action that failed and waits for a retry. Returns whether it did."""
        waiting = [state for state in self.actions.retriable if state.id == action_id]
        for state in waiting:
            self.actions.give_up(state.id, state.result)
        return bool(waiting)


def unit_of(action: Action) -> str:
    """Returns the unit that a pick or drop names, '' if it names none: masters send texts or
    numbers."""
    value = action.parameter("loadId", "")
    if isinstance(value, float) and value == int(value):
        value = int(value)
    return str(value).strip() if isinstance(value, (str, int)) else ""
