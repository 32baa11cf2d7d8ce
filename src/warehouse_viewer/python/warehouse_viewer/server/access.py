# SPDX-License-Identifier: Apache-2.0
"""Who may come in: token, origin, size and rate, before any of the application is reached."""

import hmac
import ipaddress
import re
import time
from collections.abc import Callable, Hashable, Mapping, Sequence
from http.cookies import BaseCookie, CookieError, SimpleCookie
from typing import Any
from urllib.parse import SplitResult, parse_qs, urlsplit

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from warehouse_viewer.json_text import dumps
from warehouse_viewer.server import token_page

Headers = Sequence[tuple[bytes, bytes]]  # as ASGI has them: names and values

MOST_BODY = 64 * 1024  # [bytes]
MOST_LAYOUT = 8 * 1024 * 1024  # the same where layouts, worlds and tables of orders are sent
# Paths of the files of pages. A page has up to a hundred: tabs that are opened within a second
# would lack some, if these requests were limited.
PAGE_FILES = re.compile(r"(/s/[^/]+)?/(web|three)/.*")
# Paths where layouts, worlds and tables of orders are sent, also of a simulation in a hub.
TAKES_LAYOUTS = re.compile(
    r"(/s/[^/]+)?(/(layout|whatif)/.*"
    r"|/api/v1/(warehouse|orders/table|worlds/[^/]+|simulations(/[^/]+/worlds)?))"
)
COOKIE = "warehouse_token"
CONTENT = b"default-src 'self'; img-src 'self' data:; frame-ancestors 'none'"
HEADERS = [
    (b"content-security-policy", CONTENT),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
]


def is_local(host: str) -> bool:
    """Returns whether only this machine reaches a server that listens there."""
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def is_page_file(scope: Scope) -> bool:
    """Returns whether a file of a page is asked for."""
    is_read = scope.get("method") in ("GET", "HEAD")
    return is_read and bool(PAGE_FILES.fullmatch(scope.get("path", "")))


def most_body(scope: Scope) -> int:
    """Returns how long a request's body may be [bytes]."""
    takes_layouts = TAKES_LAYOUTS.fullmatch(scope.get("path", ""))
    return MOST_LAYOUT if takes_layouts else MOST_BODY


AGAIN = [(b"retry-after", b"1")]
GUESSED = "too many wrong tokens came from this address; wait a while"
GUESSES, FIRST_GUESSES = 1.0, 10  # wrong tokens a second of each address, and at once


class RateLimit:
    """Limits requests of each address: `rate` per second, `burst` at once (two seconds' worth)."""

    MOST_ADDRESSES = 10000

    def __init__(
        self,
        rate: float,
        clock: Callable[[], float] = time.monotonic,
        burst: float | None = None,
    ) -> None:
        self._rate, self._clock = rate, clock
        self._burst = 2 * rate if burst is None else burst
        self._left: dict[Hashable, tuple[float, float]] = {}

    def allows(self, address: Hashable) -> bool:
        """Counts a request; returns whether the address may send it."""
        left = self.left(address)
        if len(self._left) > self.MOST_ADDRESSES:
            self._left.clear()
        self._left[address] = (max(0, left - 1), self._clock())
        return left >= 1

    def left(self, address: Hashable) -> float:
        """Returns how many requests the address may send now."""
        now = self._clock()
        left, then = self._left.get(address, (self._burst, now))
        return min(self._burst, left + (now - then) * self._rate)


class Refusal(Exception):  # noqa: N818 (an answer)
    """An HTTP status and the reason."""

    def __init__(
        self, status: int, reason: str, headers: Sequence[tuple[bytes, bytes]] = ()
    ) -> None:
        super().__init__(reason)
        self.status, self.headers = status, list(headers)


class AccessControl:
    """ASGI middleware. With a token everybody needs it; without, only this machine's names serve.

    The latter keeps a foreign page from reaching the server under a name of its own that leads to
    127.0.0.1. A browser gives the token once, in a form (token_page) or as ?token=…, and a cookie
    from then on; programs send `Authorization: Bearer …`. An address that guesses waits: its tokens
    are not looked at in between, also where one is right. `other_token` serves as `token` does.
    """

    def __init__(
        self, app: ASGIApp, token: str = "", rate: float = 100, other_token: str = ""
    ) -> None:
        self._app, self._token, self._limit = app, token, RateLimit(rate)
        self._others = (other_token,) if other_token else ()
        self._guesses = RateLimit(GUESSES, burst=FIRST_GUESSES)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {k.decode("latin-1"): v.decode("latin-1") for k, v in scope["headers"]}
        try:
            self._check(scope, headers)
        except Refusal as refusal:
            asks_person = refusal.status == 401 and token_page.wanted(scope, headers)
            await (_ask(scope, send) if asks_person else _refuse(scope, send, refusal))
            return
        if scope["type"] == "websocket":
            await self._app(scope, receive, send)
        elif self._is_form(scope):
            await self._take_form(scope, receive, send)
        elif self._brings_token(scope):
            await _keep_token(send, self._token)
        else:
            await _limited(self._app, scope, receive, send)

    def _check(self, scope: Scope, headers: Mapping[str, str]) -> None:
        if not is_page_file(scope) and not self._limit.allows(_address(scope)):
            raise Refusal(429, "too many requests; slow down", AGAIN)
        if int(headers.get("content-length", "0") or 0) > most_body(scope):
            raise Refusal(413, f"the body is larger than {most_body(scope)} bytes")
        self._check_origin(headers)
        if not self._is_form(scope):
            self._check_token(scope, headers)
        elif self._guesses.left(_address(scope)) < 1:
            raise Refusal(429, GUESSED, AGAIN)

    def _is_form(self, scope: Scope) -> bool:
        """Whether a person sends the token."""
        posts = scope["type"] == "http" and scope["method"] == "POST"
        return bool(self._token) and posts and scope["path"] == token_page.PATH

    async def _take_form(self, scope: Scope, receive: Receive, send: Send) -> None:
        body, more = b"", True
        while more and len(body) <= token_page.MOST_FORM:
            message = await receive()
            body, more = body + message.get("body", b""), message.get("more_body", False)
        token, to = token_page.parse(body[: token_page.MOST_FORM])
        if self._is_right(scope, token):
            await _keep_token(send, self._token, to)
        else:
            await _ask(scope, send, to, wrong=True)

    def _check_origin(self, headers: Mapping[str, str]) -> None:
        host = headers.get("host", "")
        # Starlette's TrustedHostMiddleware knows no IPv6 addresses.
        if not self._token and not is_local(_split(f"//{host}").hostname or ""):
            raise Refusal(403, f"'{host}' is not a name of this machine alone; that needs a token")
        origin = headers.get("origin")
        if origin is not None and _split(origin).netloc != host:
            raise Refusal(403, f"the origin '{origin}' is foreign")

    def _check_token(self, scope: Scope, headers: Mapping[str, str]) -> None:
        if not self._token:
            return
        scheme, _, token = headers.get("authorization", "").partition(" ")
        if scheme.lower() != "bearer":
            token = _cookie(headers) or _query_token(scope)
        if token and self._guesses.left(_address(scope)) < 1:
            raise Refusal(429, GUESSED, AGAIN)
        if not self._is_right(scope, token):
            challenge = [(b"www-authenticate", b"Bearer")]
            raise Refusal(401, "give the token: ?token=… or Authorization: Bearer …", challenge)

    def _is_right(self, scope: Scope, token: str) -> bool:
        """Whether this is the token; counts it if not."""
        tokens = (self._token, *self._others)
        is_right = any(hmac.compare_digest(token.encode(), right.encode()) for right in tokens)
        if token and not is_right:
            self._guesses.allows(_address(scope))
        return is_right

    def _brings_token(self, scope: Scope) -> bool:
        """Whether a browser comes with the token in its address, where it should not stay."""
        return bool(self._token and scope["path"] == "/" and _query_token(scope))


def _address(scope: Scope) -> str:
    return scope["client"][0] if scope.get("client") else ""


def _split(address: str) -> SplitResult:
    """Its parts. Raises Refusal."""
    try:
        return urlsplit(address)
    except ValueError as error:
        raise Refusal(400, f"'{address}' is not an address: {error}") from error


def _query_token(scope: Scope) -> str:
    return parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]


def _cookie(headers: Mapping[str, str]) -> str:
    try:
        cookies: BaseCookie[str] = SimpleCookie(headers.get("cookie", ""))
    except CookieError:
        return ""
    morsel = cookies.get(COOKIE)
    return morsel.value if morsel else ""


async def _refuse(scope: Scope, send: Send, refusal: Refusal) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    body = dumps({"detail": str(refusal)}).encode()
    headers = [(b"content-type", b"application/json"), *refusal.headers, *HEADERS]
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


async def _ask(scope: Scope, send: Send, to: str | None = None, wrong: bool = False) -> None:
    """The page that asks for the token, and leads on to the requested page."""
    own = {
        b"content-security-policy": token_page.CONTENT,
        b"referrer-policy": b"same-origin",  # else a browser posts the form as of no origin
    }
    headers = [(b"content-type", b"text/html; charset=utf-8"), (b"cache-control", b"no-store")]
    headers += (dict(HEADERS) | own).items()
    body = token_page.text(scope["path"] if to is None else to, wrong)
    await send({"type": "http.response.start", "status": 401, "headers": headers})
    await send({"type": "http.response.body", "body": b"" if scope["method"] == "HEAD" else body})


async def _keep_token(send: Send, token: str, to: str = "/") -> None:
    cookie: BaseCookie[str] = SimpleCookie({COOKIE: token})
    attributes: dict[str, Any] = {"httponly": True, "samesite": "Strict", "path": "/"}
    cookie[COOKIE].update(attributes)
    headers = [(b"location", to.encode()), (b"set-cookie", cookie[COOKIE].OutputString().encode())]
    await send({"type": "http.response.start", "status": 303, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


async def _limited(app: ASGIApp, scope: Scope, receive: Receive, send: Send) -> None:
    """The application, with a body of bounded size whatever its header claims, and our headers."""
    size = 0

    async def bounded() -> Message:
        nonlocal size
        message = await receive()
        size += len(message.get("body", b""))
        if size > most_body(scope):
            return {"type": "http.disconnect"}
        return message

    async def headed(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = message | {"headers": _completed(message.get("headers", []))}
        await send(message)

    await app(scope, bounded, headed)


def _completed(headers: Headers) -> Headers:
    """Headers with ours, where an answer does not have its own."""
    own = {name.lower() for name, _ in headers}
    return [*headers, *(header for header in HEADERS if header[0] not in own)]
