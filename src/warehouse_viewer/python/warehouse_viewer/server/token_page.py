# SPDX-License-Identifier: Apache-2.0
"""The page that asks a person for the token: by keyboard, or from an address that ends in #token=….

What follows a # a browser keeps to itself, so that no log and no proxy sees it; the form is posted.
"""

import html
import re
from collections.abc import Mapping
from urllib.parse import parse_qs

from starlette.types import Scope

from warehouse_viewer.server.csp import csp_source

PATH = "/token"
MOST_FORM = 2000  # [bytes]
STYLE = """
:root { color-scheme: dark light; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 26rem; margin: 12vh auto; padding: 0 1rem; }
label { display: block; font-weight: 600; }
input { width: 100%; box-sizing: border-box; font: inherit; min-height: 44px; }
input { padding: 4px 10px; margin: .3rem 0 .8rem; }
button { font: inherit; min-height: 44px; padding: 4px 24px; }
[role="alert"] { border-left: 4px solid #d55e00; padding-left: .6rem; }
"""
SCRIPT = """
const form = document.forms[0], given = location.hash.match(/^#token=(.*)/);
if (given) {
  history.replaceState(null, '', location.pathname + location.search);
  form.token.value = decodeURIComponent(given[1]);
  form.submit();
} else form.to.value += location.hash;
"""
PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Token – Kiva warehouse</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><style>{style}</style></head>
<body><main><h1>Kiva warehouse</h1><p>This page is for those who have its token. The terminal in
which the warehouse was started shows it, or its file.</p>{wrong}
<form method="post" action="{path}"><label for="token">Token</label>
<input id="token" name="token" type="password" autocomplete="current-password" required autofocus>
<input name="to" type="hidden" value="{to}"><button>Come in</button></form></main>
<script>{script}</script></body></html>
"""


CONTENT = (
    f"default-src 'none'; style-src {csp_source(STYLE)}; script-src {csp_source(SCRIPT)}; "
    "form-action 'self'; frame-ancestors 'none'"
).encode()


def text(to: str = "/", wrong: bool = False) -> bytes:
    """Returns the page, which leads on to the path `to`; `wrong`: the last token was."""
    notice = '<p role="alert">That is not the token.</p>' if wrong else ""
    return PAGE.format(
        style=STYLE, script=SCRIPT, path=PATH, to=html.escape(local(to)), wrong=notice
    ).encode()


def wanted(scope: Scope, headers: Mapping[str, str]) -> bool:
    """Returns whether a browser asks for a page."""
    is_page = scope["method"] in ("GET", "HEAD") and "text/html" in headers.get("accept", "")
    return scope["type"] == "http" and is_page


def parse(body: bytes) -> tuple[str, str]:
    """Returns (token, path to lead on to) of a posted form."""
    fields = parse_qs(body.decode("latin-1"), keep_blank_values=True)
    return fields.get("token", [""])[0], local(fields.get("to", ["/"])[0])


def local(to: str) -> str:
    """Returns a path of this server as it is, and "/" for anything else."""
    return to if re.fullmatch(r"/(?![/\\])[!-\[\]-~]*", to) else "/"
