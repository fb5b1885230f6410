"""Messages from a tab: a design to compute, a job to start, a job to stop."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from flexspline.pipeline.stress_limits import StressCase
from flexspline.results.studio.jobs import JobKind

_LARGEST_EXACT = 2**53
"""A browser counts no farther without rounding."""


class _Request(BaseModel):
    model_config = ConfigDict(strict=True, frozen=True)


class Want(_Request):
    """Figures of a design, and the picture of a view; `number` grows with each."""

    do: Literal["want"]
    number: int = Field(ge=0, le=_LARGEST_EXACT)
    tables: dict[str, Any]
    view: StressCase


class Start(_Request):
    """A job with a design."""

    do: Literal["job"]
    kind: JobKind
    tables: dict[str, Any]


class Stop(_Request):
    """The end of a job, if there is one of its kind."""

    do: Literal["stop"]
    kind: JobKind


Request = Want | Start | Stop
_REQUESTS: TypeAdapter[Request] = TypeAdapter(Annotated[Request, Field(discriminator="do")])


def request_from(text: str) -> Request:
    """A message of a tab.

    Raises
    ------
    ValueError : no JSON, nested too deeply, or none of these.
    """
    try:
        return _REQUESTS.validate_json(text)
    except ValidationError as fault:
        first = fault.errors(include_url=False, include_context=False, include_input=False)[0]
        raise ValueError(first["msg"]) from None
