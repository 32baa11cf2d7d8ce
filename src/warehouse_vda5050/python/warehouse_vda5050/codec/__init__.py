# SPDX-License-Identifier: Apache-2.0
"""Turns messages into the JSON of one version of VDA 5050 and back.

codec = codec_for("2.1.0")
payload = codec.encode(State(...))
order, unknown = codec.decode(Kind.ORDER, payload)
"""

from warehouse_vda5050.codec.base import Codec, Decoded
from warehouse_vda5050.codec.v2 import CodecV2
from warehouse_vda5050.codec.v3 import CodecV3

VERSIONS = ("2.0.0", "2.1.0", "3.0.0")
DEFAULT_VERSION = "2.1.0"


class VersionError(ValueError):
    """A version that is not spoken here; the message says which are."""


def codec_for(version: str = DEFAULT_VERSION, strict: bool = False) -> Codec:
    """Returns the codec of a version, which accepts common deviations unless it is strict. Raises
    VersionError."""
    version = full_version(version)
    kind = CodecV3 if version.startswith("3") else CodecV2
    return kind(version, strict)


def full_version(text: str) -> str:
    """Returns a version as messages have it, 2.1.0 for 2.1. Raises VersionError."""
    for version in VERSIONS:
        if text in (version, version.removesuffix(".0")):
            return version
    raise VersionError(f"version is {text!r}; one of {', '.join(VERSIONS)} was expected")


__all__ = [
    "DEFAULT_VERSION",
    "VERSIONS",
    "Codec",
    "Decoded",
    "VersionError",
    "codec_for",
    "full_version",
]
