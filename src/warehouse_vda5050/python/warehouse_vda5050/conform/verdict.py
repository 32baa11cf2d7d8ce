# SPDX-License-Identifier: Apache-2.0
"""What a case may come to."""

from enum import StrEnum


class Verdict(StrEnum):
    """The end of a case."""

    CONFORMS = "conforms"
    DIFFERS = "differs"
    UNSUPPORTED = "not supported"  # the vehicle's factsheet lacks what the case needs
    UNTESTABLE = "not testable here"


class Ended(Exception):  # noqa: N818 an end is no error of this program
    """Ends a case; the message is the reason."""

    verdict = Verdict.DIFFERS


class Differs(Ended):
    """The vehicle did something else than the specification says."""


class Unsupported(Ended):
    """The factsheet does not have what the case needs."""

    verdict = Verdict.UNSUPPORTED


class Untestable(Ended):
    """The case needs what is not at hand here."""

    verdict = Verdict.UNTESTABLE


class Interrupted(Exception):  # noqa: N818 nor is this
    """A person ends the run."""


def demand(condition: object, text: str) -> None:
    """Raises Differs with a text unless a condition holds."""
    if not condition:
        raise Differs(text)
