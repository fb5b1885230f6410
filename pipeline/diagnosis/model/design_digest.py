"""Digests of the design values on which an extended model depends."""

from __future__ import annotations

import json
from collections.abc import Mapping
from hashlib import sha256

from flexspline.geometry.design import Design

TABLES = ("flexspline", "shaft", "material", "gear", "bearing", "wave_generator")
"""Of a design file: geometry, stiffness and gap come from these. Its name and its solver change no gear."""
DIGEST_LETTERS = 12
"""Of a digest: 48 bits tell any two designs apart that a person ever compares."""


def design_digests(design: Design) -> dict[str, str]:
    """SHA-256 of each table's values, its first letters, by the table's name.

    Values at their defaults do not count, so a key that a later version adds changes no digest.
    """
    said = design.model_dump(mode="json", include=set(TABLES), exclude_defaults=True)
    return {name: _digest(said.get(name, {})) for name in TABLES}


def changed_tables(design: Design, recorded: Mapping[str, str]) -> tuple[str, ...]:
    """Tables of a design that are not as a model's file recorded them; none where it recorded none."""
    digests = design_digests(design)
    return tuple(n for n in TABLES if n in recorded and recorded[n] != digests[n])


def _digest(values: object) -> str:
    return sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:DIGEST_LETTERS]
