# SPDX-License-Identifier: Apache-2.0
"""The actions of an order: which begins when, by their blocking types, and the progress of each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from warehouse_vda5050.model import Action, ActionState, ActionStatus, BlockingType, Node

# The robot stands for these whatever their blocking type says.
STANDING = frozenset({"pick", "drop", "startCharging", "stopCharging"})


def holds(action: Action) -> bool:
    """Returns whether the robot does not drive during an action."""
    return action.blocking in (BlockingType.SOFT, BlockingType.HARD) or action.type in STANDING


def holds_at(node: Node) -> bool:
    """Returns whether the robot has to stand at a node for one of its actions."""
    return any(holds(action) for action in node.actions)


class ActionQueue:
    """Actions of one order: reported at once, due when their node is passed, begun in that order.

    A HARD or SINGLE action waits until those before it are over, and those after it wait for it;
    so does a lift for a lift.
    """

    def __init__(self) -> None:
        self._states: dict[str, ActionState] = {}
        self._due: list[Action] = []
        self.running: list[Action] = []

    def add(self, nodes: Iterable[Node]) -> None:
        """Lists the actions of new nodes as WAITING."""
        for action in (action for node in nodes for action in node.actions):
            state = ActionState(action.id, action.type, ActionStatus.WAITING)
            self._states.setdefault(action.id, state)

    def keep_only(self, nodes: Iterable[Node]) -> None:
        """Drops waiting actions of a replaced horizon, whose nodes no longer exist."""
        known = {action.id for node in nodes for action in node.actions}
        known |= {action.id for action in [*self._due, *self.running]}
        waiting = ActionStatus.WAITING
        self._states = {
            id: s for id, s in self._states.items() if id in known or s.status is not waiting
        }

    def make_due(self, nodes: Iterable[Node]) -> None:
        """Lets the actions of passed nodes begin when it is their turn."""
        self._due += [action for node in nodes for action in node.actions]

    def next(self, standing: bool) -> Action | None:
        """Returns the action that may begin now and is RUNNING from here on, None if none may.

        standing: whether the robot neither drives nor is about to.
        """
        if not self._due:
            return None
        action = self._due[0]
        alone = (BlockingType.HARD, BlockingType.SINGLE)
        if self.running and action.blocking in alone:
            return None
        if any(other.blocking in alone for other in self.running):
            return None
        if holds(action) and not standing:
            return None
        if action.type in STANDING and any(other.type in STANDING for other in self.running):
            return None  # the robot has one lift
        self.running.append(self._due.pop(0))
        self._set(action.id, ActionStatus.RUNNING)
        return action

    def finish(self, action_id: str, result: str = "") -> None:
        """Ends an action that did what it should."""
        self._end(action_id, ActionStatus.FINISHED, result)

    def fail(self, action_id: str, reason: str) -> None:
        """Ends an action that could not be carried out; one that may be retried waits for that."""
        if any(action.id == action_id and action.retriable for action in self.running):
            self._set(action_id, ActionStatus.RETRIABLE, reason)
        else:
            self.give_up(action_id, reason)

    def give_up(self, action_id: str, reason: str) -> None:
        """Ends an action for good that was not carried out."""
        self._end(action_id, ActionStatus.FAILED, reason)

    def retry(self, action_id: str) -> Action | None:
        """Returns an action that waits for a retry, and is RUNNING from here on; None if it does
        not."""
        if action_id not in {state.id for state in self.retriable}:
            return None
        self._set(action_id, ActionStatus.RUNNING)
        return next(action for action in self.running if action.id == action_id)

    def fail_waiting(self, reason: str) -> None:
        """Ends all actions that have not begun."""
        self._due.clear()
        for id, state in self._states.items():
            if state.status is ActionStatus.WAITING:
                self._set(id, ActionStatus.FAILED, reason)

    def _end(self, action_id: str, status: ActionStatus, result: str) -> None:
        self.running = [action for action in self.running if action.id != action_id]
        self._set(action_id, status, result)

    def _set(self, action_id: str, status: ActionStatus, result: str = "") -> None:
        state = self._states[action_id]
        self._states[action_id] = replace(state, status=status, result=result[:500])

    def knows(self, action_id: str) -> bool:
        """Returns whether an action is one of the order's."""
        return action_id in self._states

    @property
    def holds_driving(self) -> bool:
        """Whether the robot has to stand for an action that runs or is due."""
        return any(holds(action) for action in [*self.running, *self._due])

    @property
    def is_over(self) -> bool:
        """Whether no action runs nor is due."""
        return not self.running and not self._due

    @property
    def failed(self) -> list[ActionState]:
        """The actions that could not be carried out."""
        return [s for s in self._states.values() if s.status is ActionStatus.FAILED]

    @property
    def retriable(self) -> list[ActionState]:
        """The actions that failed, and wait for a retry or its omission."""
        return [s for s in self._states.values() if s.status is ActionStatus.RETRIABLE]

    def states(self, paused: bool) -> tuple[ActionState, ...]:
        """Returns the states of all; running ones of a paused robot are PAUSED."""
        return tuple(
            replace(state, status=ActionStatus.PAUSED)
            if paused and state.status is ActionStatus.RUNNING
            else state
            for state in self._states.values()
        )
