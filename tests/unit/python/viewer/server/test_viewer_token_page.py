# SPDX-License-Identifier: Apache-2.0
"""A person without the token is asked for it, and comes in with it; the terminal tells it."""

from urllib.parse import urlencode

import pytest
from asgi import echo, request

from warehouse_viewer.server import invitation, token_page
from warehouse_viewer.server.access import AccessControl

HOST = {"host": "robots.example:8080"}
BROWSER = HOST | {"accept": "text/html,application/xhtml+xml,*/*;q=0.8"}
TOKEN = "s3cret;token&more"


def post(access, token, to="/"):
    body = urlencode({"token": token, "to": to}).encode()
    return request(access, "/token", method="POST", headers=BROWSER, body=[body[:5], body[5:]])


def test_a_browser_is_asked_in_a_form_and_a_program_told():
    access = AccessControl(echo, TOKEN)
    page = request(access, "/operations", headers=BROWSER)
    assert page.status == 401 and page.headers["content-type"].startswith("text/html")
    assert b'<form method="post" action="/token">' in page.body
    assert b'name="to" type="hidden" value="/operations"' in page.body
    assert b"role" not in page.body.split(b"<form")[0].split(b"</style>")[1]  # nothing is wrong yet
    program = request(access, "/api/v1/robots", headers=HOST | {"accept": "*/*"})
    assert program.status == 401 and program.headers["content-type"] == "application/json"


def test_the_form_lets_in_and_leads_to_what_was_asked_for():
    answer = post(AccessControl(echo, TOKEN), TOKEN, "/operations#pick1")
    assert (answer.status, answer.headers["location"]) == (303, "/operations#pick1")
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    assert TOKEN not in answer.headers["location"]
    access = AccessControl(echo, TOKEN)
    cookie = HOST | {"cookie": cookie.split("; ")[0]}
    assert request(access, "/", headers=cookie).status == 200


def test_a_wrong_token_is_said_to_be():
    answer = post(AccessControl(echo, TOKEN), "s3cret", "/operations")
    assert answer.status == 401 and b"That is not the token." in answer.body
    assert "set-cookie" not in answer.headers and b'value="/operations"' in answer.body
    long = request(
        AccessControl(echo, TOKEN), "/token", method="POST", headers=BROWSER, body=[b"x" * 10**5]
    )
    assert long.status == 401


@pytest.mark.parametrize(
    "to",
    [
        "https://evil.example/",
        "//evil.example",
        "/\\evil.example",
        "/\r\nset-cookie: a=b",
        "",
        "javascript:x",
    ],
)
def test_the_form_leads_nowhere_else(to):
    assert post(AccessControl(echo, TOKEN), TOKEN, to).headers["location"] == "/"


def test_what_is_asked_for_is_no_markup():
    page = token_page.text('/"><script>alert(1)</script>').decode()
    assert page.count("<script>") == 1


def test_without_a_token_there_is_no_form():
    assert (
        request(
            AccessControl(echo), "/token", method="POST", headers={"host": "localhost"}, body=[b"a"]
        ).body
        == b"a"
    )


def test_the_owner_s_terminal_tells_the_whole_address():
    here = "localhost", 8080
    assert invitation.text(*here) == "\nWatch it in a browser: http://localhost:8080/\n"
    result = invitation.text(*here, "abc", "/home/me/token", is_private=True)
    assert "http://localhost:8080/#token=abc\n" in result and "▀" not in result
    # A log does not.
    hidden = invitation.text("0.0.0.0", 8080, "abcdefgh", "/home/me/token")
    assert "abcdefgh" not in hidden and "/home/me/token" in hidden
    assert "…" not in result + hidden


def test_a_phone_can_read_the_address():
    pytest.importorskip("segno")
    result = invitation.text("0.0.0.0", 8080, "abc", "/home/me/token", is_private=True)
    assert "Or on a phone:" in result and "▀" in result
    assert max(map(len, result.splitlines())) < 80
