"""Models made wrong on purpose: less material comes out stiffer than more."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flexspline.fea.types import Stiffness
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline import enclosure, load_cases, solid_torsion
from flexspline.pipeline.enclosure import Names


def swap_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut and whole body change places."""
    between = enclosure.between

    def turned(cut: Stiffness, whole: Stiffness, names: Names) -> Stiffness:
        return between(whole.times(1.1), cut, names)

    monkeypatch.setattr(enclosure, "between", turned)


def stiffen_solid_model(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wall a tenth too thick, say: K in torsion is 5 % off where ± 0.3 % is claimed."""
    solve = solid_torsion.solid_stiffness

    def off(*given: object, **named: object) -> object:
        found = solve(*given, **named)
        return replace(found, stiffness=found.stiffness.times(1.05))

    monkeypatch.setattr(solid_torsion, "solid_stiffness", off)


def without_torsion(monkeypatch: pytest.MonkeyPatch) -> None:
    """K_b in torsion cannot be found, so it cannot help in a load case of the rim."""

    def fails(*given: object) -> Stiffness:
        raise ComputationError("no mesh for torsion")

    monkeypatch.setattr(load_cases, "part_stiffness", fails)
