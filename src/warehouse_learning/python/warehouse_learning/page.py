# SPDX-License-Identifier: Apache-2.0
"""Pictures as they come, on a page of this machine: http://127.0.0.1:PORT."""

import struct
import sys
import threading
import zlib
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

PORT = 8090  # the next free one if it is taken
TRIES = 20
PAGE = b"""<!doctype html><meta charset="utf-8"><title>Kiva warehouse</title>
<style>body{margin:0;background:#222;display:grid;place-items:center;height:100vh}
img{max-width:98vw;max-height:98vh;image-rendering:pixelated}</style>
<img src="/stream" alt="the warehouse from above">"""


class Page:
    """Serves the newest picture until it is closed."""

    def __init__(self, port=PORT):
        self._news = threading.Condition()
        self._png, self._number, self._closed = b"", 0, False
        self._server = self._serve(port)
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/"
        print(f"watch it: {self.url}", file=sys.stderr)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def show(self, pixels):
        """(height, width, 3) uint8."""
        png = encode(pixels)
        with self._news:
            self._png, self._number = png, self._number + 1
            self._news.notify_all()

    def close(self):
        """Ends the server; whoever looks keeps the last picture."""
        with self._news:
            self._closed = True
            self._news.notify_all()
        self._server.shutdown()
        self._server.server_close()

    def next(self, seen):
        """(number, PNG) of a picture after number `seen`, waiting for it; None once closed."""
        with self._news:
            self._news.wait_for(lambda: self._closed or self._number > seen)
            return None if self._closed else (self._number, self._png)

    def _serve(self, port):
        for i in range(TRIES):
            try:
                server = ThreadingHTTPServer(("127.0.0.1", port + i), _Handler)
            except OSError:
                continue
            server.daemon_threads = True
            server.page = self
            return server
        raise OSError(f"no port from {port} to {port + TRIES - 1} is free for the page")


class _Handler(BaseHTTPRequestHandler):
    def do_GET(self):  # noqa: N802
        if self.path == "/stream":
            return self._stream()
        if self.path != "/":
            return self.send_error(404)
        self._head("text/html; charset=utf-8")
        return self.wfile.write(PAGE)

    def log_message(self, *_):
        """A page that is looked at is no news."""

    def _head(self, kind):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Cache-Control", "no-store")
        self.end_headers()

    def _stream(self):
        self._head("multipart/x-mixed-replace; boundary=frame")
        seen = 0
        while (found := self.server.page.next(seen)) is not None:
            seen, png = found
            part = b"--frame\r\nContent-Type: image/png\r\nContent-Length: %d\r\n\r\n" % len(png)
            try:
                self.wfile.write(part + png + b"\r\n")
            except OSError:
                return


def encode(pixels):
    """A PNG of (height, width, 3) uint8."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = (b"IHDR", head), (b"IDAT", zlib.compress(rows, 1)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(map(_chunk, *zip(*parts)))


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
