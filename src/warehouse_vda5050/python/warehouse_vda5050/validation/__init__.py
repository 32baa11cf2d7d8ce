# SPDX-License-Identifier: Apache-2.0
"""Checks what came over the wire before anything acts upon it."""

from warehouse_vda5050.model import Error, ErrorType


class MessageError(ValueError):
    """A message that cannot be acted upon; `error` is what a state tells of it."""

    def __init__(
        self,
        description: str,
        type: str = ErrorType.VALIDATION.value,
        references: tuple[tuple[str, str], ...] = (),
        hint: str = "",
    ) -> None:
        super().__init__(description)
        self.error = Error(type, description=description[:500], hint=hint, references=references)
