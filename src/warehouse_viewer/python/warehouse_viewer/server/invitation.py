# SPDX-License-Identifier: Apache-2.0
"""The addresses of the warehouse's pages, as its terminal shows them."""

import io
import socket
from contextlib import suppress
from urllib.parse import quote

from warehouse_viewer.server import access

EVERYWHERE = ("", "0.0.0.0", "::")  # hosts at which a server hears all machines
ELSEWHERE = "192.0.2.1"  # no machine's (RFC 5737): nothing is sent to it
OPENING = "Watch it in a browser:"


def address(host: str, port: int) -> str:
    """Returns the address of a server that listens there, for a browser."""
    if host in EVERYWHERE:
        host = socket.gethostname()
    elif access.is_local(host):
        host = "localhost"
    return _url(host, port)


def text(host: str, port: int, token: str = "", place: str = "", is_private: bool = False) -> str:
    """Returns what the terminal shows.

    Only with `is_private`, where its owner alone reads the terminal, that has the token, which lies
    at `place`, and a picture of the address for a phone if other machines reach it.
    """
    first = f"\n{OPENING} {address(host, port)}"
    if not token:
        return f"{first}\n"
    if not is_private:
        return f"{first}\nIt asks for the token, which is in {place}\n"
    secret = f"#token={quote(token)}"
    others = "" if access.is_local(host) else _picture(_numeric(host, port) + secret)
    return f"{first}{secret}\nThe token is in {place}\n{others}"


def _url(host: str, port: int) -> str:
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/"


def _numeric(host: str, port: int) -> str:
    """The same for a phone, which knows no names of the machines around it."""
    with suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        if host in EVERYWHERE:
            probe.connect((ELSEWHERE, 9))
            return _url(probe.getsockname()[0], port)
    return address(host, port)


def _picture(url: str) -> str:
    """A QR code in half blocks; nothing where segno is not installed."""
    try:
        import segno
    except ImportError:
        return ""
    out = io.StringIO()
    segno.make(url, error="l", micro=False).terminal(out, compact=True)
    return f"Or on a phone:\n{out.getvalue()}"
