# SPDX-License-Identifier: Apache-2.0
"""How a master is tried."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """Limits of time [s]. patience: until the master has sent an order, as long as it sends any;
    impatience: the same after it has sent none twice; trip: until an order is over; watch: how long
    what must not come is waited for; reaction: what a master may take to act by a state. strict:
    whether recommendations count."""

    patience: float = 60.0
    impatience: float = 5.0
    trip: float = 120.0
    watch: float = 8.0
    reaction: float = 2.0
    strict: bool = False
