# SPDX-License-Identifier: Apache-2.0
"""Instant actions, each sent again until the vehicle reports its result."""

from dataclasses import dataclass

from warehouse_vda5050.master.text_limits import fitting_id
from warehouse_vda5050.model import Action, BlockingType, InstantActions, Lengths, VehicleState

RESEND = 2.0  # [s] without an answer
MOST_TIMES = 10


@dataclass
class _Pending:
    action: Action
    times: int = 0
    due: float = 0.0

    @property
    def is_given_up(self) -> bool:
        return self.times >= MOST_TIMES


class InstantRequests:
    """The instant actions of one vehicle that are not over yet. Times are [s] of any clock."""

    def __init__(self, run: str) -> None:
        self._run, self._count = run, 0
        self.lengths = Lengths()  # that the vehicle takes
        self._pending: dict[str, _Pending] = {}

    def ask(self, kind: str, *parameters: tuple[str, str]) -> str:
        """Adds an action with parameters, and returns its id."""
        self._count += 1
        name = fitting_id(self._run, self._count, self.lengths)
        action = Action(kind, name, BlockingType.NONE, parameters)
        self._pending[action.id] = _Pending(action)
        return action.id

    def forget(self, *kinds: str) -> None:
        """Stops sending actions of these types, which would undo a newer one."""
        self._pending = {
            name: request
            for name, request in self._pending.items()
            if request.action.type not in kinds
        }

    def due(self, now: float) -> InstantActions | None:
        """Returns the actions to send."""
        pending = [request for request in self._pending.values() if not request.is_given_up]
        due = [request for request in pending if request.due <= now]
        due = due[: self.lengths.instant_actions or None]  # the others go with the next message
        for request in due:
            request.times, request.due = request.times + 1, now + RESEND
        return InstantActions(tuple(request.action for request in due)) if due else None

    def is_pending(self, name: str) -> bool:
        """Returns whether an action is unanswered and is still sent."""
        return name in self._pending and not self._pending[name].is_given_up

    def is_given_up(self, name: str) -> bool:
        """Returns whether an action remained unanswered after all its repetitions."""
        return name in self._pending and self._pending[name].is_given_up

    def take(self, state: VehicleState) -> None:
        """Removes the actions that a state answers."""
        for action in state.actions:
            self._pending.pop(action.id, None)
