# SPDX-License-Identifier: Apache-2.0
"""Files of the page: those that are there, and nothing else."""

import pytest
from asgi import request
from fastapi import FastAPI

from warehouse_sim.viewer.static_files import Files, FreshFiles


@pytest.mark.parametrize("kind", [Files, FreshFiles])
def test_serves_what_is_there(tmp_path, kind):
    (tmp_path / "page.html").write_text("hello")
    app = kind(directory=tmp_path)
    assert request(app, "/page.html").body == b"hello"


@pytest.mark.parametrize(
    "path",
    ["/nothing", "/\0", "/" + "x" * 300, "/" + "x/" * 3000, "/../secret", "/page.html/x"],
    ids=lambda path: repr(path[:12]),
)
def test_what_is_no_file_is_not_found(tmp_path, path):
    (tmp_path / "secret").write_text("secret")
    web = tmp_path / "web"
    web.mkdir()
    (web / "page.html").write_text("hello")
    assert status_of(FreshFiles(directory=web), path) == 404


def status_of(app, path):
    """As FastAPI answers."""
    outer = FastAPI()
    outer.mount("/web", app)
    return request(outer, f"/web{path}").status
