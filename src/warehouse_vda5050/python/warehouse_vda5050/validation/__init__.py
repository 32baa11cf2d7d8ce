# SPDX-License-Identifier: Apache-2.0
"""Checks what came over the wire before anything acts upon it."""

from warehouse_vda5050.errors import Error, ErrorType, Predefined


class MessageError(ValueError):
    """Raised for a message that cannot be acted upon; `error` is its entry in a state."""

    def __init__(
        self,
        description: str,
        type: str = ErrorType.VALIDATION.value,
        references: tuple[tuple[str, str], ...] = (),
        precise: Predefined | None = None,
    ) -> None:
        super().__init__(description)
        text = description[:500]
        self.error = Error(type, description=text, references=references, precise=precise)
