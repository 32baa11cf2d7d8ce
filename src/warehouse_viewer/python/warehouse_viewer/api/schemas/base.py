# SPDX-License-Identifier: Apache-2.0
"""Numbers, names and answers that all subjects share."""

import re
from typing import Any

from pydantic import BaseModel, ConstrainedFloat, ConstrainedInt, ConstrainedStr, Extra, Field
from pydantic.errors import DictError

INT32 = 2**31 - 1
MOST_ROWS = 1000  # of a list, in one answer
MOST = 1e300  # of a number


class Int32(ConstrainedInt):
    """A 32-bit integer."""

    strict, ge, le = True, -INT32 - 1, INT32


class Int8(ConstrainedInt):
    """An 8-bit integer."""

    strict, ge, le = True, -128, 127


class UInt8(ConstrainedInt):
    """An 8-bit integer without a sign."""

    strict, ge, le = True, 0, 255


class Name(ConstrainedStr):
    """Printable ASCII, or nothing."""

    strict, max_length, regex = True, 100, re.compile(r"^[ -~]*$")


class Label(ConstrainedStr):
    """A name of letters, digits, dots and dashes."""

    strict, min_length, max_length = True, 1, 100
    regex = re.compile(r"^[A-Za-z0-9_.-]+$")


class Number(ConstrainedFloat):
    """A finite number; no text that looks like one."""

    allow_inf_nan = False
    ge, le = -MOST, MOST

    @classmethod
    def __get_validators__(cls):
        yield cls._check
        yield from super().__get_validators__()

    @classmethod
    def _check(cls, value):
        # An integer too large for a float would be an error of ours further on.
        if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > MOST:
            raise ValueError("a finite number was expected")
        return value


class Body(BaseModel):
    """A request's body: refuses keys that it does not know."""

    class Config:
        """Refuses unknown keys."""

        extra = Extra.forbid

    @classmethod
    def validate(cls, value: Any) -> Any:
        """Returns the body of a dictionary; pydantic.ValidationError if it is wrong."""
        # pydantic would take a list of pairs, an empty one too.
        if isinstance(value, list):
            raise DictError
        return super().validate(value)


class Problem(BaseModel):
    """Says why a request was refused."""

    detail: str = Field(description="the reason, as a sentence")


class Done(BaseModel):
    """Says what was done."""

    message: str
