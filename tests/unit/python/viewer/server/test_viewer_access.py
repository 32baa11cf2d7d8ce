# SPDX-License-Identifier: Apache-2.0
"""Who comes in: this machine alone, or who brings the token; no foreign page, nothing too large."""

import asyncio
import json

import pytest
from asgi import echo, request

from warehouse_viewer.server.access import (
    MOST_BODY,
    MOST_LAYOUT,
    AccessControl,
    RateLimit,
    is_local,
)

LOCAL = {"host": "localhost:8080"}
AWAY = {"host": "robots.example:8080"}
TOKEN = "s3cret;token"


def status(access, headers=LOCAL, **options):
    return request(access, "/api/v1/robots", headers=headers, **options).status


def test_this_machine_comes_in_without_a_token():
    for host in ("localhost:8080", "127.0.0.1:8080", "[::1]:8080", "localhost"):
        assert status(AccessControl(echo), {"host": host}) == 200


def test_a_name_of_another_machine_does_not():
    answer = request(AccessControl(echo), "/", headers=AWAY)
    assert answer.status == 403
    assert "robots.example" in json.loads(answer.body)["detail"]


@pytest.mark.parametrize("host", ["[", "[::1", "]", "[x]:80"])
def test_a_host_that_is_no_address_is_refused(host):
    assert status(AccessControl(echo), {"host": host}) in (400, 403)
    assert status(AccessControl(echo), LOCAL | {"origin": f"http://{host}"}) in (400, 403)


def test_a_foreign_origin_is_refused():
    assert status(AccessControl(echo), LOCAL | {"origin": "http://localhost:8080"}) == 200
    for origin in ("http://evil.example", "http://localhost:9999", "null"):
        assert status(AccessControl(echo), LOCAL | {"origin": origin}) == 403


def test_a_foreign_origin_is_refused_at_the_websocket_too():
    sent = []

    async def send(message):
        sent.append(message)

    headers = [(b"host", b"localhost:8080"), (b"origin", b"http://evil.example")]
    scope = {"type": "websocket", "path": "/live", "query_string": b"", "headers": headers}
    asyncio.run(AccessControl(echo)(scope, None, send))
    assert sent == [{"type": "websocket.close", "code": 1008}]


def test_the_token_opens_from_anywhere():
    access = AccessControl(echo, TOKEN)
    assert status(access, AWAY) == 401
    assert status(access, LOCAL) == 401
    assert status(access, AWAY | {"authorization": "Bearer wrong"}) == 401
    assert status(access, AWAY | {"authorization": f"Bearer {TOKEN}"}) == 200
    assert status(access, AWAY | {"authorization": f"bearer {TOKEN}"}) == 200
    assert status(access, AWAY, query="token=s3cret%3Btoken") == 200


def test_a_browser_keeps_the_token_as_a_cookie():
    access = AccessControl(echo, TOKEN)
    answer = request(access, "/", query="token=s3cret%3Btoken", headers=AWAY)
    assert (answer.status, answer.headers["location"]) == (303, "/")
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    assert status(access, AWAY | {"cookie": cookie.split("; ")[0]}) == 200


def test_a_large_body_is_refused_whatever_it_claims():
    assert status(AccessControl(echo), LOCAL | {"content-length": str(MOST_BODY + 1)}) == 413
    chunks = (b"x" * MOST_BODY, b"x", b"x")
    assert status(AccessControl(echo), body=chunks) == 400
    assert status(AccessControl(echo), body=(b"x" * MOST_BODY,)) == 200


def test_every_answer_forbids_other_hosts():
    for headers in (LOCAL, AWAY):
        answer = request(AccessControl(echo), "/", headers=headers)
        assert "default-src 'self'" in answer.headers["content-security-policy"]


def test_too_many_requests_of_one_address_are_refused():
    access = AccessControl(echo, rate=2)
    assert [status(access) for _ in range(5)] == [200, 200, 200, 200, 429]
    assert status(access, client="5.6.7.8") == 200


def test_the_files_of_pages_are_not_counted():
    access = AccessControl(echo, rate=2)
    for path in ("/web/js/main.js", "/s/hall/three/build/three.module.js"):
        assert {request(access, path, headers=LOCAL).status for _ in range(9)} == {200}
    assert [status(access) for _ in range(5)] == [200, 200, 200, 200, 429]


def test_the_limit_eases_with_time():
    now = [0.0]
    limit = RateLimit(2, clock=lambda: now[0])
    assert [limit.allows("a") for _ in range(5)] == [True] * 4 + [False]
    now[0] = 0.5
    assert [limit.allows("a") for _ in range(2)] == [True, False]


@pytest.mark.parametrize(
    ("host", "local"),
    [("127.0.0.1", True), ("127.3.2.1", True), ("::1", True), ("localhost", True)]
    + [("0.0.0.0", False), ("::", False), ("192.168.0.2", False), ("localhost.evil", False)],
)
def test_knows_which_hosts_are_this_machine_alone(host, local):
    assert is_local(host) is local


@pytest.mark.parametrize("path", ["/layout/check", "/api/v1/warehouse"])
def test_layouts_may_be_longer_than_other_bodies(path):
    for size, expected in ((MOST_BODY + 1, 200), (MOST_LAYOUT + 1, 413)):
        headers = LOCAL | {"content-length": str(size)}
        assert request(AccessControl(echo), path, headers=headers).status == expected


def test_an_address_that_guesses_tokens_waits():
    now = [0.0]
    access = AccessControl(echo, TOKEN, rate=1000)
    access._guesses = RateLimit(1, clock=lambda: now[0], burst=10)

    def bearing(token):
        return status(access, AWAY | {"authorization": f"Bearer {token}"})

    assert [bearing(f"guess{n}") for n in range(12)] == [401] * 10 + [429] * 2
    assert bearing(TOKEN) == 429  # else the answer would tell a right guess
    assert status(access, AWAY) == 401  # who brings none does not guess
    now[0] += 5
    assert bearing(TOKEN) == 200
    assert status(AccessControl(echo, TOKEN), AWAY | {"authorization": f"Bearer {TOKEN}"}) == 200
