# SPDX-License-Identifier: Apache-2.0
"""The numbers in messages as the words that the messages define for them."""

from warehouse_msgs.msg import Event, KivaStatus


def _constants(kind, prefix=""):
    """{value: name} of a message type's constants that begin so, without the beginning."""
    named = {n: v for n, v in vars(kind).items() if n.isupper() and isinstance(v, int)}
    return {v: n.removeprefix(prefix) for n, v in named.items() if n.startswith(prefix)}


EVENT = _constants(Event)
STATUS = _constants(KivaStatus, "STATUS_")
STATE = _constants(KivaStatus, "STATE_")
