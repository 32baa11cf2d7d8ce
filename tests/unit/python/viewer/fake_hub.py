# SPDX-License-Identifier: Apache-2.0
"""A hub without ROS and a page without a browser."""

import json

from warehouse_viewer.api import catalogue
from warehouse_viewer.page.hub import Hub
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.source import Source


class Socket:
    """Keeps what a page would receive."""

    def __init__(self):
        self.texts, self.updates = [], []

    async def send_text(self, text):
        self.texts.append(json.loads(text))

    async def send_bytes(self, data):
        self.updates.append(data)


class FakeFeed(dict):
    """Stands in for a Feed that has heard these messages."""

    coordinator = None

    def __missing__(self, name):
        return None

    def subscribe_extras(self, paths, ways, scans):
        """Does nothing: it has what it has."""


def hub_of(world, journal=None):
    source = Source(FakeFeed(), None, journal or Journal(), catalogue.plain_coordinator)
    return Hub(source, world.model)
