# SPDX-License-Identifier: Apache-2.0
"""The page about the HTTP API, served without ROS: nothing that it describes can be tried."""

import contextlib
import threading
import time

import uvicorn
from editor_page import PATIENCE
from fastapi import FastAPI

from warehouse_viewer.api import description, routes
from warehouse_viewer.server.connections import listen_near
from warehouse_viewer.server.site import API, Site

SHOWN = "document.querySelectorAll('#operations details').length > 20"


@contextlib.contextmanager
def docs():
    """The address of the page."""
    app = FastAPI(title="Kiva warehouse", version="1", openapi_url=None, docs_url=None)
    app.include_router(routes.router)
    app.get("/api/v1/openapi.json")(lambda: description.described(app))
    app.router.routes.extend(Site(API).routes())
    listener = listen_near("127.0.0.1", 0)
    server = uvicorn.Server(uvicorn.Config(app, log_level="error"))
    thread = threading.Thread(target=server.run, args=([listener],))
    thread.start()
    try:
        end = time.monotonic() + PATIENCE
        while not server.started:
            assert time.monotonic() < end, "the server does not start"
            time.sleep(0.02)
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/api/docs"
    finally:
        server.should_exit = True
        thread.join(PATIENCE)
