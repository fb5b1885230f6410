"""Mesh size: the edge length grows with the distance from edges with stress concentration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexspline.fea.errors import SolidError
from flexspline.fea.solid.tetwild import Background

MOST_GRID_POINTS = 500_000
"""Most points of a grid of the wanted edge length in the part's box. Judgement: with more, the mesher takes
hours."""


@dataclass(frozen=True)
class Grading:
    """Edge length = min(far, near + growth · distance to an edge), lengths in mm."""

    near: float
    far: float
    growth: float = 0.5

    def scaled(self, factor: float) -> Grading:
        """Return the grading for a mesh `factor` times as coarse."""
        return Grading(self.near * factor, self.far * factor, self.growth)


def refuse_beyond(points: float, edge_mm: float) -> None:
    """Raise SolidError where edges of this length ask for more than MOST_GRID_POINTS."""
    if points > MOST_GRID_POINTS:
        raise SolidError(
            f"edges of {edge_mm:.3g} mm ask for a mesh of some {points:.2g} points, at most"
            f" {MOST_GRID_POINTS}: raise solver.edge_length_mm"
        )


def graded_background(
    edges: np.ndarray, box: tuple[np.ndarray, np.ndarray], grading: Grading
) -> Background | None:
    """Return the grading as a sizing field on a Delaunay mesh of edge points and a loose grid.

    Parameters
    ----------
    edges : (k, 3) points along the edges, in meshing space [mm].
    box : lower and upper corner (3,) of the part in meshing space.

    Raises
    ------
    SolidError : MOST_GRID_POINTS are too few for such short edges.
    """
    from scipy.spatial import Delaunay, cKDTree

    low, high = box[0] - grading.far, box[1] + grading.far
    counts = np.maximum(2, np.ceil((high - low) / grading.far).astype(int) + 1)
    refuse_beyond(float(np.prod(counts, dtype=float)), grading.far)
    if not len(edges) or grading.near >= grading.far:
        return None
    grid = np.stack(
        np.meshgrid(
            *(np.linspace(a, b, n) for a, b, n in zip(low, high, counts, strict=True)),
            indexing="ij",
        ),
        axis=-1,
    ).reshape(-1, 3)
    inner = ((grid > low) & (grid < high)).all(axis=1)
    # a regular grid is the degenerate case of Delaunay's criterion: loosen it, always the same way
    jitter = np.random.default_rng(0).uniform(-0.1, 0.1, grid.shape) * grading.far
    grid[inner] += jitter[inner]
    tree = cKDTree(edges)
    distance, _ = tree.query(grid)
    loose = distance > 0.5 * grading.far
    thinned = edges[_thin(edges, grading.near)]
    points = np.vstack([thinned, grid[loose | ~inner]])
    lengths = grading.near + grading.growth * tree.query(points)[0]
    tets = Delaunay(points).simplices
    return Background(points, tets, np.minimum(grading.far, lengths))


def _thin(points: np.ndarray, spacing: float) -> np.ndarray:
    """Indices of a subset with one point per cell of a grid of `spacing` [mm]."""
    cells = np.floor(points / spacing).astype(np.int64)
    return np.unique(cells, axis=0, return_index=True)[1]
