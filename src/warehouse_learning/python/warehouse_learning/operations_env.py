# SPDX-License-Identifier: Apache-2.0
"""The dispatcher of a whole shift as a Gymnasium environment: orders, stock and stations are those
of warehouse_operations, and each step is one decision that a policy of a shift makes."""

import threading
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike

from warehouse_learning.warehouses import ActionError
from warehouse_operations.policies.decisions import FEATURES, SHORTLIST, Decision
from warehouse_operations.policies.learned import Orders, Robots, Units
from warehouse_operations.runs import simulation
from warehouse_operations.runs.operations import Operations

ROLES = {"orders": Orders, "units": Units, "robots": Robots}
DECIDES = ("units",)
MINUTES = 60.0
HIGH = 1000.0  # no feature is above


class KivaOperationsEnv(gymnasium.Env):
    """One step is one decision: which of up to 16 candidates is taken.

    decides: the roles that are decided by actions, of `orders` (which order a station takes on),
    `units` (which unit is brought to it) and `robots` (which robot fetches it); the others have
    their default policies, or those of `policies`, as in a policy file. minutes: of a shift, which
    is an episode. Other options as of warehouse_operations.runs.simulation.Description: size or
    layout, physics (False: ideal robots, hundreds of times as fast), orders, robots, stations,
    realism.

    Observations are a dictionary: `role`, one hot in the order above, `candidates` (16, 8), a row
    for each that may be chosen, zeros beyond, and `mask` (16,), 1 where there is one. The reward is
    the number of pieces that were picked since the last decision; their sum is the shift's. An
    episode is truncated when the shift is over. info has `action_mask`, `usual`, what the default
    policy would take, `time` [s] and at the end `kpis`, as in kpis.json.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        decides: tuple[str, ...] | list[str] = DECIDES,
        minutes: float = MINUTES,
        physics: bool = False,
        policies: dict[str, Any] | None = None,
        render_mode: str | None = None,
        **options: Any,
    ) -> None:
        unknown = [role for role in decides if role not in ROLES]
        if unknown or not decides:
            raise ValueError(f"decides is {decides!r}; some of {', '.join(ROLES)} were expected")
        known = {f.name for f in fields(simulation.Description)} - {"seconds", "seed"}
        for name in options:
            if name not in known:
                raise ValueError(f"{name} is not an option; there are {', '.join(sorted(known))}")
        if not 0 < minutes <= 24 * 60:
            raise ValueError(f"minutes is {minutes!r}; a number above 0, up to 1440, was expected")
        self.decides, self.render_mode = tuple(decides), render_mode
        self._options = options | {"physics": physics, "seconds": 60 * minutes}
        self._policies = dict(policies or {})
        self.observation_space = spaces.Dict(
            {
                "role": spaces.Box(0, 1, (len(ROLES),), np.float32),
                "candidates": spaces.Box(-HIGH, HIGH, (SHORTLIST, FEATURES), np.float32),
                "mask": spaces.Box(0, 1, (SHORTLIST,), np.float32),
            }
        )
        self.action_space = spaces.Discrete(SHORTLIST)
        self._shift: _Shift | None = None
        self._operations: Operations | None = None
        self._decision: Decision | None = None
        self._is_over = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins a shift; the same seed begins the same one. Returns (observation, info).

        Raises what a wrong description raises; see warehouse_operations.runs.simulation.ERRORS.
        """
        super().reset(seed=seed)
        self.close()
        drawn = int(self.np_random.integers(2**31)) if seed is None else seed
        self._shift = _Shift(self._described(drawn), self.decides, self._policies)
        self._operations, self._picked = self._shift.operations, 0
        self._decision, self._is_over = self._shift.next(), False
        return self._observation(), self._info()

    def _described(self, seed: int) -> simulation.Description:
        return simulation.Description(**self._options, seed=seed)

    def step(self, action: ArrayLike) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Takes a candidate, and runs the shift to the next decision.

        Raises ActionError for what is not a candidate.
        """
        if self._shift is None or self._is_over:
            raise gymnasium.error.ResetNeeded("reset() begins an episode")
        actions = np.asarray(action)
        if actions.shape != () or actions.dtype.kind not in "iu" or not 0 <= actions < SHORTLIST:
            raise ActionError(
                f"dispatcher: action {action!r}; a whole number below {SHORTLIST} was expected"
            )
        if self._decision:
            # What is beyond the candidates is the last one: an agent without a mask can't go wrong.
            last = len(self._decision.keys) - 1
            self._decision = self._shift.next(min(int(actions), last))
        self._is_over = self._decision is None
        picked = self._shift.operations.shift.tally.items_picked
        reward, self._picked = float(picked - self._picked), picked
        return self._observation(), reward, False, self._is_over, self._info()

    def action_masks(self) -> np.ndarray:
        """Returns (16,) bool, as sb3_contrib's MaskablePPO asks for."""
        return np.arange(SHORTLIST) < (len(self._decision.keys) if self._decision else 1)

    @property
    def decision(self) -> Decision | None:
        """The present decision; None when the shift is over."""
        return self._decision

    def close(self) -> None:
        """Ends the shift."""
        if self._shift:
            self._shift.close()
            self._shift = None

    def _observation(self) -> dict[str, np.ndarray]:
        role = np.zeros(len(ROLES), np.float32)
        candidates = np.zeros((SHORTLIST, FEATURES), np.float32)
        if self._decision:
            role[list(ROLES).index(self._decision.role)] = 1
            candidates[: len(self._decision.keys)] = self._decision.rows.clip(-HIGH, HIGH)
        mask = self.action_masks().astype(np.float32)
        return {"role": role, "candidates": candidates, "mask": mask}

    def _info(self) -> dict[str, Any]:
        operations: Any = self._operations
        info = {"action_mask": self.action_masks().astype(np.int8), "time": operations.time}
        if self._decision:
            return info | {"usual": self._decision.usual}
        return info | {"kpis": operations.kpis()}


class _StoppedError(Exception):
    """Ends the thread of a shift that its environment no longer needs."""


class _Shift:
    """A shift in a thread that waits where a policy is to decide: one of both threads runs."""

    def __init__(
        self,
        description: simulation.Description,
        decides: tuple[str, ...],
        policies: dict[str, Any],
    ) -> None:
        chosen = dict(policies)
        chosen.update({role: ROLES[role](self._ask) for role in decides})
        self._seconds = description.seconds
        described = simulation.Description(**{**vars(description), "policies": chosen})
        self.operations: Operations = simulation.open_operations(described)
        self._mine, self._theirs = threading.Semaphore(0), threading.Semaphore(0)
        self._decision: Decision | None = None
        self._answer = 0
        self._error: BaseException | None = None
        self._is_over = self._is_stopped = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        self._mine.acquire()

    def _run(self) -> None:
        try:
            self.operations.run(seconds=self._seconds)
        except _StoppedError:
            pass
        except BaseException as error:  # handed over to the environment's thread
            self._error = error
        self._decision, self._is_over = None, True
        self._mine.release()

    def _ask(self, decision: Decision) -> int:
        """Called where the shift needs a decision, in its thread."""
        if len(decision.keys) == 1:
            return 0
        self._decision = decision
        self._mine.release()
        self._theirs.acquire()
        if self._is_stopped:
            raise _StoppedError
        return self._answer

    def next(self, answer: int | None = None) -> Decision | None:
        """Answers the last decision, if there was one; returns the next, None when it is over."""
        if answer is not None and not self._is_over:
            self._answer = answer
            self._theirs.release()
            self._mine.acquire()
        if self._error:
            raise self._error
        return self._decision

    def close(self) -> None:
        """Ends the thread and the shift."""
        self._is_stopped = True
        if not self._is_over:
            self._theirs.release()
            self._thread.join()
        self.operations.close()


def run_shift(
    env: KivaOperationsEnv, choose: Callable[[Decision], int], seed: int
) -> dict[str, Any]:
    """Plays an episode; returns its kpis, with the `return`, the sum of rewards."""
    _, info = env.reset(seed=seed)
    total, is_over = 0.0, False
    while not is_over:
        action = choose(env.decision) if env.decision else 0
        _, reward, _, is_over, info = env.step(action)
        total += reward
    return info["kpis"] | {"return": total}


def usual(decision: Decision) -> int:
    """Returns what the default policy of the role would take."""
    return decision.usual
