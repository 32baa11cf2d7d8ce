# SPDX-License-Identifier: Apache-2.0
"""Tells other programs of alarms: JSON by POST to their URLs, as each begins and ends."""

import json
import logging
import queue
import re
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Mapping, Sequence
from http.client import HTTPException
from typing import Any
from urllib.parse import urlsplit

TIMEOUT = 5.0  # for an answer [s, wall]
PAUSES = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0)  # before each further attempt [s, wall]
KEPT = 1000  # messages that wait for a URL; the oldest go first
LOG = logging.getLogger(__name__)
MODEL = re.compile(r"[a-z_]+\d+")
LOST = (400, 401, 403, 404, 405, 410, 413, 415, 422)  # answers that another attempt would get, too


def read(text: str) -> list[str]:
    """Returns the URLs of a list with commas or spaces. Raises ValueError with what is wrong."""
    urls = text.replace(",", " ").split()
    wrong = [fault for url in urls if (fault := _fault(url))]
    if wrong:
        raise ValueError("; ".join(wrong))
    return list(dict.fromkeys(urls))


def _fault(url: str) -> str:
    try:
        parts = urlsplit(url)
        is_right = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
    except ValueError:  # a port that is no number
        is_right = False
    return "" if is_right else f"'{url}': an address http://… or https://… was expected"


def _host(url: str) -> str:
    """Returns the part of a URL that is no secret."""
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.hostname}{f':{parts.port}' if parts.port else ''}"


def message(event: str, alarm: Mapping[str, Any], address: str) -> dict[str, Any]:
    """Returns what is sent of an alarm as JSON has it; `event`: begin or end; `address`: of the
    pages, where its link leads to the moment of its begin."""
    subject = str(alarm["subject"])
    shown = f"&see={subject}" if MODEL.fullmatch(subject) else ""
    link = f"{address}/#t={alarm['since']:.1f}{shown}"
    fields = ("id", "kind", "severity", "title", "subject", "cause", "consequences", "since")
    remedy = {"remedy": alarm["to_do"], "remedies": [row["label"] for row in alarm["remedies"]]}
    end = {name: alarm[name] for name in ("until", "duration") if name in alarm}
    return {"event": event} | {name: alarm[name] for name in fields} | remedy | end | {"link": link}


class Webhooks:
    """Posts messages to URLs, each in a thread of its own: a dead one delays no other, and no
    caller ever waits."""

    def __init__(
        self,
        urls: Sequence[str],
        pauses: Sequence[float] = PAUSES,
        wait: Callable[[float], object] = time.sleep,
    ) -> None:
        self._pauses, self._wait = pauses, wait
        self._queues = {url: queue.Queue[Mapping[str, Any]](KEPT) for url in urls}
        for url in self._queues:
            threading.Thread(target=self._run, args=(url,), daemon=True).start()

    def post(self, content: Mapping[str, Any]) -> None:
        """Has every URL get a message."""
        for url, waiting in self._queues.items():
            while True:
                try:
                    waiting.put_nowait(content)
                    break
                except queue.Full:
                    _drop_oldest(url, waiting)

    def _run(self, url: str) -> None:
        opener = urllib.request.build_opener(_NoRedirects)
        while True:
            content = self._queues[url].get()
            fault = self._send(opener, url, content)
            if fault:
                number = content.get("id")
                LOG.warning("webhook %s: alarm %s was not taken: %s", _host(url), number, fault)

    def _send(
        self, opener: urllib.request.OpenerDirector, url: str, content: Mapping[str, Any]
    ) -> str:
        """Sends a message until it is taken; returns why it was not in the end, or ""."""
        fault = ""
        for pause in (0.0, *self._pauses):
            if pause:
                self._wait(pause)
            try:
                _post(opener, url, content)
                return ""
            except urllib.error.HTTPError as error:
                fault = f"{error.code} {error.reason}"
                error.close()
                if error.code in LOST:
                    return fault
            except (OSError, HTTPException, ValueError) as error:
                fault = str(error)
        return fault


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    """A POST that is redirected would arrive as a GET."""

    def redirect_request(self, *_: Any) -> None:
        return None


def _post(opener: urllib.request.OpenerDirector, url: str, content: Mapping[str, Any]) -> None:
    headers = {"content-type": "application/json", "user-agent": "kiva-warehouse"}
    request = urllib.request.Request(url, json.dumps(content).encode(), headers, method="POST")
    with opener.open(request, timeout=TIMEOUT) as answer:
        answer.read(1)


def _drop_oldest(url: str, waiting: "queue.Queue[Mapping[str, Any]]") -> None:
    try:
        waiting.get_nowait()
        text = "webhook %s: more than %d messages wait; the oldest is left out"
        LOG.warning(text, _host(url), KEPT)
    except queue.Empty:
        pass
