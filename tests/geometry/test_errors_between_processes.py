"""An error that a worker raises arrives as it was, whatever its own `__init__` takes."""

from __future__ import annotations

import pickle

import pytest

from flexspline.geometry.errors import DesignError, FlexsplineError
from flexspline.pipeline.errors import NestingError


@pytest.mark.parametrize(
    "fault",
    [
        NestingError("the part", 2.0, "the part without holes", 1.0),
        DesignError("flexspline.length_mm", 0.0, "must be above 0", (DesignError("a", 1, "b"),)),
    ],
)
def test_an_error_arrives_as_it_was(fault: FlexsplineError) -> None:
    there = pickle.loads(pickle.dumps(fault))
    assert type(there) is type(fault)
    assert str(there) == str(fault)
    assert str(there.__dict__) == str(fault.__dict__)
