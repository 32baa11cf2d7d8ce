# SPDX-License-Identifier: Apache-2.0
"""The API's imports from pydantic: Debian 12 has version 1, Debian 13 version 2."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Any

import pydantic
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, conint, constr

IS_1 = pydantic.VERSION.startswith("1.")
MOST = 1e300  # of a number


def integer(least: int, most: int) -> Any:
    """Returns the type of integers from `least` to `most`."""
    return conint(strict=True, ge=least, le=most)


def text(pattern: str, most: int, least: int = 0) -> Any:
    """Returns the type of texts that match `pattern`, with `least` to `most` characters."""
    options = {"regex" if IS_1 else "pattern": pattern}
    return constr(strict=True, min_length=least, max_length=most, **options)


def items(least: int, most: int) -> dict[str, int]:
    """Returns the options of the Field of a list of `least` to `most` elements."""
    what = "items" if IS_1 else "length"
    return {f"min_{what}": least, f"max_{what}": most}


def characters(least: int, most: int) -> dict[str, int]:
    """Returns the options of the Field of a text of `least` to `most` characters."""
    return {"min_length": least, "max_length": most}


def schema_extra(more: dict[str, Any]) -> dict[str, Any]:
    """Returns the options of a model whose JSON schema has `more` in it."""
    return {"schema_extra" if IS_1 else "json_schema_extra": more}


def names_of(model: type[BaseModel]) -> list[str]:
    """Returns the names of a model's fields."""
    return list(model.__fields__ if IS_1 else model.model_fields)


def as_dict(model: BaseModel, **options: Any) -> dict[str, Any]:
    """Returns the values of a model by name; for options such as `exclude` see pydantic."""
    return model.dict(**options) if IS_1 else model.model_dump(**options)


def as_json(model: BaseModel) -> str:
    """Returns a model as JSON."""
    return model.json() if IS_1 else model.model_dump_json()


def faults_of(error: RequestValidationError) -> list[dict[str, Any]]:
    """Returns what is wrong with a request, for its answer.

    pydantic 2 adds the input, which JSON may not be able to hold.
    """
    keys = ("loc", "msg", "type", "ctx") if IS_1 else ("loc", "msg", "type")
    return [{key: fault[key] for key in keys if key in fault} for fault in error.errors()]


def _finite(value: Any) -> Any:
    # An integer too large for a float would be an error of ours further on.
    if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > MOST:
        raise ValueError("a finite number was expected")
    return value


if IS_1:
    from pydantic import ConstrainedFloat, root_validator
    from pydantic.error_wrappers import ErrorWrapper
    from pydantic.errors import DictError, StrError
    from pydantic.schema import schema

    class _Number(ConstrainedFloat):
        allow_inf_nan = False

        @classmethod
        def __get_validators__(cls) -> Iterator[Callable[..., Any]]:
            yield _finite
            yield from super().__get_validators__()

    def number(least: float = -MOST, most: float = MOST) -> Any:
        """Returns the type of finite numbers from `least` to `most`; a text is refused."""
        return type("Number", (_Number,), {"ge": least, "le": most})

    def check_all(check: Callable[[Mapping[str, Any]], None]) -> Any:
        """Returns what, as a class attribute, calls check(values) for each model that is valid."""

        def validate(cls: type, values: dict[str, Any]) -> Any:
            check(values)
            return values

        return root_validator(skip_on_failure=True, allow_reuse=True)(validate)

    def no_text(*place: str) -> RequestValidationError:
        """Returns the error of a request with something else than a text at that place."""
        return RequestValidationError([ErrorWrapper(StrError(), place)])

    def schemas_of(models: Iterable[type[BaseModel]], prefix: str) -> dict[str, Any]:
        """Returns the JSON schemas of models by name; `prefix` begins references to them."""
        return schema(list(models), ref_prefix=prefix)["definitions"]

else:
    from pydantic import BeforeValidator, Field, model_validator
    from pydantic.json_schema import models_json_schema

    def number(least: float = -MOST, most: float = MOST) -> Any:
        """Returns the type of finite numbers from `least` to `most`; a text is refused."""
        field = Field(ge=least, le=most, allow_inf_nan=False)
        return Annotated[float, field, BeforeValidator(_finite)]

    def check_all(check: Callable[[Mapping[str, Any]], None]) -> Any:
        """Returns what, as a class attribute, calls check(values) for each model that is valid."""

        def validate(model: BaseModel) -> BaseModel:
            check(vars(model))
            return model

        return model_validator(mode="after")(validate)

    def no_text(*place: str) -> RequestValidationError:
        """Returns the error of a request with something else than a text at that place."""
        said = {"type": "string_type", "loc": place, "msg": "Input should be a valid string"}
        return RequestValidationError([said])

    def schemas_of(models: Iterable[type[BaseModel]], prefix: str) -> dict[str, Any]:
        """Returns the JSON schemas of models by name; `prefix` begins references to them."""
        pairs = [(model, "serialization") for model in models]
        return models_json_schema(pairs, ref_template=prefix + "{model}")[1]["$defs"]


class Body(BaseModel, extra="forbid"):  # type: ignore[call-arg]
    """A request's body: refuses keys that it does not know."""

    if IS_1:

        @classmethod
        def validate(cls, value: Any) -> Any:
            """Returns the body of a dictionary; pydantic.ValidationError if it is wrong."""
            # pydantic 1 would take a list of pairs, an empty one too.
            if isinstance(value, list):
                raise DictError
            return super().validate(value)
