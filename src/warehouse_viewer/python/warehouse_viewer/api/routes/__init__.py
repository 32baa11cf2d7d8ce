# SPDX-License-Identifier: Apache-2.0
"""The routes below /api/v1, a module for each subject, and the WebSockets."""

from fastapi import APIRouter

from warehouse_viewer.api.routes import (
    coordinator,
    events,
    figures,
    forecasts,
    models,
    orders,
    robots,
    shift,
    simulation,
    stations,
    vda5050,
    warehouse,
    watch,
    zones,
)

router = APIRouter(prefix="/api/v1")
for _subject in (
    warehouse,
    events,
    robots,
    models,
    simulation,
    shift,
    coordinator,
    orders,
    stations,
    figures,
    forecasts,
    watch,
    zones,
    vda5050,
):
    router.include_router(_subject.router)
