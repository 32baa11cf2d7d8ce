# SPDX-License-Identifier: Apache-2.0
"""Forecasts of the shift that runs."""

from fastapi import APIRouter, HTTPException, Path

from warehouse_msgs import srv
from warehouse_viewer.api import operations_json
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import INT32
from warehouse_viewer.api.schemas.forecasts import Forecast, NewForecast

router = APIRouter()
NUMBER = Path(ge=1, le=INT32, description="as the request for it answered")


@router.post("/forecasts", response_model=Forecast, status_code=202, responses=problems(*SENT))
async def ask_forecast(body: NewForecast, backend: ApiBackend = BACKEND) -> object:
    """Looks ahead of the shift that runs, many times, while that goes on. A newer request replaces
    one that is not done."""
    fields = body.minutes, body.runs, body.changes
    answer = await backend.call(backend.operations.call, "forecast", srv.Forecast, *fields)
    backend.operations.feed.forecasts.ask(answer.forecast_id)
    return {"forecast_id": answer.forecast_id, "state": "RUNNING"}


@router.get("/forecasts/latest", response_model=Forecast, responses=problems(404))
async def get_latest_forecast(backend: ApiBackend = BACKEND) -> object:
    """The newest forecast."""
    return _shown(backend, backend.operations.feed.forecasts.newest)


@router.get("/forecasts/{number}", response_model=Forecast, responses=problems(404))
async def get_forecast(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """A forecast; its bands once it is done."""
    return _shown(backend, number)


def _shown(backend: ApiBackend, number: int) -> object:
    book = backend.operations.feed.forecasts
    if not 0 < number <= book.newest:
        raise HTTPException(404, "there is no such forecast; POST /api/v1/forecasts asks for one")
    if result := book.result(number):
        return operations_json.forecast(result)
    return {"forecast_id": number, "state": "RUNNING" if number == book.newest else "REPLACED"}
