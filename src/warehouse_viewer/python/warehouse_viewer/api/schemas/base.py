# SPDX-License-Identifier: Apache-2.0
"""Numbers, names and answers that all subjects share."""

from typing import TYPE_CHECKING

from pydantic import BaseModel, Field

from warehouse_viewer.api.schemas.pydantic_versions import integer, number, text

INT32 = 2**31 - 1
MOST_ROWS = 1000  # of a list, in one answer

if TYPE_CHECKING:
    Int32 = int
    Int8 = int
    UInt8 = int
    Name = str
    Label = str
    Number = float
    Person = str
else:
    Int32, Int8, UInt8 = integer(-INT32 - 1, INT32), integer(-128, 127), integer(0, 255)
    Name = text(r"^[ -~]*$", 100)  # printable ASCII, or nothing
    Label = text(r"^[A-Za-z0-9_.-]+$", 100, least=1)
    Number = number()
    Person = text(r"^[^\x00-\x1f\x7f]*$", 60)


class Problem(BaseModel):
    """Says why a request was refused."""

    detail: str = Field(description="the reason, as a sentence")


class Done(BaseModel):
    """Says what was done."""

    message: str
