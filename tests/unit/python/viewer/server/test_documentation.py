# SPDX-License-Identifier: Apache-2.0
"""The documentation is served where it was built; its pages run their own scripts alone."""

import base64
import hashlib
import json

import pytest
from asgi import request
from starlette.applications import Starlette

from warehouse_viewer.server import documentation
from warehouse_viewer.server.site import DOCS, FLOOR, Site

SCRIPT = "document.body.dataset.theme = 'auto';"


@pytest.fixture
def built(tmp_path):
    folder = tmp_path / "docs"
    folder.mkdir()
    (folder / "index.html").write_text(f"<h1>Begin</h1><script>{SCRIPT}</script>")
    (folder / "page.html").write_text("<h1>A page</h1>")
    return folder


def site(*folders):
    return Starlette(routes=documentation.routes(folders))


def test_shows_the_first_folder_that_is_built(tmp_path, built):
    app = site(tmp_path / "none", built)
    assert b"Begin" in request(app, "/docs/").body
    assert b"A page" in request(app, "/docs/page.html").body
    assert request(app, "/docs/nothing.html").status == 404


def test_leads_to_the_folder(built):
    answer = request(site(built), "/docs")
    assert answer.status == 307 and answer.headers["location"] == "/docs/"


def test_tells_how_to_build_what_is_missing(tmp_path):
    answer = request(site(tmp_path / "none"), "/docs/")
    assert answer.status == 404 and b"make docs" in answer.body


def test_pages_lead_to_it_only_where_it_is_built(tmp_path, built, monkeypatch):
    app = Starlette(routes=Site(FLOOR, DOCS).routes())
    for folder, titles in ((tmp_path / "none", ["Floor"]), (built, ["Floor", "Docs"])):
        monkeypatch.setattr(documentation, "FOLDERS", (folder,))
        assert [page["title"] for page in json.loads(request(app, "/pages").body)] == titles


def test_only_its_own_scripts_run(built):
    policy = request(site(built), "/docs/").headers["content-security-policy"]
    own = base64.b64encode(hashlib.sha256(SCRIPT.encode()).digest()).decode()
    assert f"script-src 'self' 'sha256-{own}';" in policy
