# SPDX-License-Identifier: Apache-2.0
"""Files of the page: those that are there, and nothing else."""

import gzip
import re
import tempfile
from pathlib import Path

import brotli
import pytest
from asgi import request
from fastapi import FastAPI
from starlette.applications import Starlette

from warehouse_layout.floor import palette
from warehouse_viewer.server.site import Site
from warehouse_viewer.server.static_files import Files, FreshFiles
from warehouse_viewer.shared_files import WEB


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
    """The answers of FastAPI."""
    outer = FastAPI()
    outer.mount("/web", app)
    return request(outer, f"/web{path}").status


@pytest.mark.parametrize(
    ("name", "accepted", "unpack"),
    [
        ("br", "gzip, deflate, br", brotli.decompress),
        ("gzip", "gzip, deflate", gzip.decompress),
    ],
)
def test_a_text_travels_compressed_and_once(name, accepted, unpack):
    with tempfile.TemporaryDirectory() as folder:
        text = "const same = 'again';\n" * 1000
        (Path(folder) / "page.js").write_text(text)
        app = FreshFiles(directory=folder)
        taken = {"accept-encoding": accepted}
        packed = request(app, "/page.js", headers=taken)
        assert unpack(packed.body).decode() == text
        assert len(packed.body) < len(text) / 20
        assert packed.headers["content-encoding"] == name
        assert packed.headers["content-type"].startswith("text/javascript")
        assert packed.headers["cache-control"] == "no-cache"
        tag = packed.headers["etag"]
        again = request(app, "/page.js", headers=taken | {"if-none-match": tag})
        assert (again.status, again.body) == (304, b"")
        (Path(folder) / "page.js").write_text(text + "// another\n")
        assert request(app, "/page.js", headers=taken | {"if-none-match": tag}).status == 200
        # Programs that take none get the file itself, and neither is taken for the other.
        plain = request(app, "/page.js")
        assert (
            plain.body.decode() == text + "// another\n" and "content-encoding" not in plain.headers
        )
        assert plain.headers["vary"] == packed.headers["vary"] == "accept-encoding"


def test_what_is_there_for_good_is_kept_by_a_browser(tmp_path):
    (tmp_path / "page.bin").write_bytes(b"\0")
    answer = request(Files(directory=tmp_path), "/page.bin", headers={"accept-encoding": "gzip"})
    assert "max-age" in answer.headers["cache-control"]
    assert "content-encoding" not in answer.headers


def test_the_palette_has_each_cell_that_pages_draw_once_a_theme():
    css = request(Starlette(routes=Site().routes()), "/web/palette.css").body.decode()
    looks = re.findall(r"look: '(\w+)'", (WEB / "js/editor/characters.js").read_text())
    assert looks and set(looks) <= set(palette.CELLS)
    light = css.partition('[data-theme="light"]')[2]
    for kind, colours in palette.CELLS.items():
        assert css.count(f"--cell-{kind}:") == 2 and f"--cell-{kind}:{colours[0]};" in light
