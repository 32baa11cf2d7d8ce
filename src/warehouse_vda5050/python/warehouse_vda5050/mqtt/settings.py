# SPDX-License-Identifier: Apache-2.0
"""Where a broker is and how to be let in."""

import pathlib
from dataclasses import dataclass

from warehouse_layout.file import user_file


class BrokerError(ValueError):
    """No broker can be meant by this; the message names the argument and what was expected."""


@dataclass(frozen=True)
class BrokerSettings:
    """tls: whether to encrypt; `authority` is the file of who signed the broker's certificate, ''
    for those that the system trusts. A password without TLS is sent as it is."""

    host: str = "localhost"
    port: int = 1883
    tls: bool = False
    authority: str = ""
    user: str = ""
    password: str = ""


def read_settings(
    broker: str, tls: str = "", user: str = "", password_file: str = ""
) -> BrokerSettings:
    """Returns the settings from launch arguments. Raises BrokerError.

    broker: host or host:port. tls: '' or false, true, or the file of a certificate authority.
    """
    encrypted = tls.lower() not in ("", "false", "0", "no")
    authority = tls if encrypted and tls.lower() not in ("true", "1", "yes") else ""
    if authority and not pathlib.Path(authority).is_file():
        raise BrokerError(f"tls is {tls!r}; true, false or a certificate's file was expected")
    host, port = _address(broker, 8883 if encrypted else 1883)
    if password_file and not user:
        raise BrokerError("password_file is given without user")
    return BrokerSettings(host, port, encrypted, authority, user, _password(password_file))


def _address(broker: str, default: int) -> tuple[str, int]:
    host, _, port = broker.rpartition(":") if ":" in broker else (broker, "", str(default))
    host = host.removeprefix("[").removesuffix("]")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise BrokerError(f"broker is {broker!r}; HOST:PORT, or start, was expected")
    return host, int(port)


def _password(file: str) -> str:
    if not file:
        return ""
    try:
        return user_file.read_text(pathlib.Path(file).expanduser()).strip("\r\n")
    except (OSError, UnicodeDecodeError) as error:
        raise BrokerError(f"password_file is {file!r}: {error}") from None
