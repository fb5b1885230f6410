"""The kinds of flexspline, each in a file of its own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args

from flexspline.geometry.cup import Cup
from flexspline.geometry.flexspline_shape import FlexsplineShape
from flexspline.geometry.hat import Hat

Flexspline = Cup | Hat
SHAPES: Mapping[str, type[FlexsplineShape]] = {
    get_args(c.model_fields["kind"].annotation)[0]: c for c in get_args(Flexspline)
}
"""By `flexspline.kind`."""
KINDS = tuple(SHAPES)
"""What `flexspline.kind` may be."""
