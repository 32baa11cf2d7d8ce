# SPDX-License-Identifier: Apache-2.0
"""Numbers, names and answers that all subjects share."""

from pydantic import BaseModel, ConstrainedFloat, Extra, Field, conint, constr
from pydantic.errors import DictError

INT32 = 2**31 - 1
MOST_ROWS = 1000  # of a list, in one answer
MOST = 1e300  # of a number

Int32 = conint(ge=-INT32 - 1, le=INT32, strict=True)
Name = constr(max_length=100, regex=r"^[ -~]*$", strict=True)
Label = constr(min_length=1, max_length=100, regex=r"^[A-Za-z0-9_.-]+$", strict=True)


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


# No docstring: subclasses without one would show it in the API's description.
class Body(BaseModel):
    class Config:
        extra = Extra.forbid

    @classmethod
    def validate(cls, value):
        # pydantic would take a list of pairs, an empty one too.
        if isinstance(value, list):
            raise DictError
        return super().validate(value)


class Problem(BaseModel):
    detail: str = Field(description="the reason, for a person")


class Done(BaseModel):
    message: str
