# SPDX-License-Identifier: Apache-2.0
"""The name, id and layout file of the warehouse, as parameters."""

from typing import Any

NAME, NUMBER = "warehouse/name", "warehouse/id"
LAYOUT = "warehouse/layout"  # layout file of the present warehouse; "" without one
INT32 = 2**31


def read(ros: Any) -> tuple[str, int]:
    """Returns (name, id) of the warehouse that stands; ("", 0) for one without a name.

    Any node may set parameters: a value of another type is ignored with one warning.
    """
    name = ros.get_param(NAME, "")
    number = ros.get_param(NUMBER, 0)
    is_id = isinstance(number, int) and not isinstance(number, bool) and -INT32 <= number < INT32
    if not is_id:
        ros.logwarn_once(f"{NUMBER} is {number!r}; a whole number of 32 bits was expected")
    return str(name), number if is_id else 0


def layout(ros: Any) -> str:
    """Returns the path of the layout file of which the warehouse was built; "" without one."""
    return str(ros.get_param(LAYOUT, ""))


def write(ros: Any, name: str, number: int) -> None:
    """Sets the name and the id of the warehouse that stands."""
    ros.set_param(NAME, name)
    ros.set_param(NUMBER, number)
