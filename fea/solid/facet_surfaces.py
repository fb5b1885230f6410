"""The surface of each facet of a mesh, and its patch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexspline.fea.errors import MeshQualityError
from flexspline.geometry.surfaces import ON_SURFACE_MM, Surface


def surfaces_of(corners: np.ndarray, faces: np.ndarray, surfaces: Sequence[Surface]) -> np.ndarray:
    """Return the surface (k,) on which each face's corners lie exactly; of several, its centre decides.

    Of two that coincide, the planes of a half part, it is the first, as in `geometry.tagged`.

    Parameters
    ----------
    corners : (n, 3) mm. faces : (k, 3) indices.

    Raises
    ------
    MeshQualityError : a face lies on none.
    """
    centres = corners[faces].mean(axis=1)
    distance = np.array([np.abs(s.project(corners) - corners).max(axis=1) for s in surfaces])
    away = np.array([np.abs(s.project(centres) - centres).max(axis=1) for s in surfaces])
    lies = distance[:, faces].max(axis=2) < ON_SURFACE_MM
    if not lies.any(axis=0).all():
        raise MeshQualityError(
            f"{int((~lies.any(axis=0)).sum())} facets lie on no surface of the part"
        )
    away = np.where(lies, away, np.inf)
    return np.asarray((away < away.min(axis=0) + ON_SURFACE_MM).argmax(axis=0))


def patches_of(
    facet_surface: np.ndarray, surfaces: Sequence[Surface]
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the number (k,) of each facet's patch, and the patches' names; "" comes first: no patch."""
    names = tuple(dict.fromkeys(["", *(s.patch for s in surfaces)]))
    return np.array([names.index(s.patch) for s in surfaces])[facet_surface], names
