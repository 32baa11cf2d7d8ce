# SPDX-License-Identifier: Apache-2.0
"""When a shift is looked ahead of without a request."""

from time import monotonic as clock
from types import SimpleNamespace

import pytest
from fake_ros import FakeRos

from warehouse_operations.ros import forecast_service
from warehouse_operations.ros.forecast_service import PAUSED, ForecastService

EVERY = 600.0  # [s]


@pytest.fixture
def site(monkeypatch):
    """A service with its `host`, and the forecasts that were `begun`."""
    monkeypatch.setattr(forecast_service, "rospy", FakeRos())
    services = SimpleNamespace(serve=lambda *_: None)
    monkeypatch.setattr(forecast_service, "CommandServices", lambda _ros: services)
    begun = []
    monkeypatch.setattr(ForecastService, "_begin", lambda _self, asked: begun.append(asked))
    host = SimpleNamespace(last_step=clock())
    return SimpleNamespace(service=ForecastService(host, EVERY), host=host, begun=begun)


def test_the_first_forecast_is_made_as_soon_as_time_passes(site):
    site.host.last_step = clock() - 2 * PAUSED  # on a busy machine a node takes long to begin
    site.service.keep_up(0.1)
    assert not site.begun
    site.host.last_step = clock()
    site.service.keep_up(0.2)
    assert len(site.begun) == 1


def test_the_next_one_is_made_when_it_is_due(site):
    for now in (0.1, 0.2, EVERY, EVERY + 0.1, EVERY + 0.2):
        site.service.keep_up(now)
    assert len(site.begun) == 2
    site.service.keep_up(0.1)  # the world was reset
    assert len(site.begun) == 3
