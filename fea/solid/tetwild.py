"""fTetWild in a child process with a time limit, because its C++ code can hang or crash.

Run as ``python -m flexspline.fea.solid.tetwild IN.npz OUT.npz PARENT`` it is the child; PARENT is its
parent's process number, without which it does not go on.
"""

from __future__ import annotations

import faulthandler
import os
import subprocess
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from flexspline.fea.child_python import child_command, end_with
from flexspline.fea.errors import MesherError, MesherTimeError

STOP_ENERGY = 10.0
"""fTetWild's own. AMIPS energy, of which a regular tetrahedron has 3."""
MESHER_SECONDS = 300.0
"""[s] Ten times a whole run of the six-hole cup with fTetWild (30 s). A mesher that takes longer may never
end."""


@dataclass(frozen=True)
class TetwildSettings:
    """fTetWild's parameters; lengths in mm, absolute.

    `stop_energy` is the AMIPS energy at which optimisation ends.
    """

    edge_length: float
    envelope: float
    stop_energy: float = STOP_ENERGY
    time_limit_s: float = MESHER_SECONDS


@dataclass(frozen=True)
class Background:
    """A sizing field: wanted edge lengths (n,) mm at the corners (n, 3) of tets (m, 4)."""

    points: np.ndarray
    tets: np.ndarray
    edge_length: np.ndarray


def tetrahedralize(
    vertices: np.ndarray,
    triangles: np.ndarray,
    settings: TetwildSettings,
    background: Background | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Fill a closed triangle surface (internal faces allowed) with tetrahedra.

    Parameters
    ----------
    vertices : (n, 3) mm; triangles : (m, 3) indices.

    Returns
    -------
    points (k, 3) mm and tets (t, 4), positively oriented.

    Raises
    ------
    MesherError : time limit passed, crash, or no elements.
    """
    with tempfile.TemporaryDirectory(prefix="flexspline-mesh-") as folder:
        given, made = Path(folder) / "in.npz", Path(folder) / "out.npz"
        values: dict[str, Any] = asdict(settings)
        if background is not None:
            values |= {f"bg_{k}": v for k, v in vars(background).items()}
        np.savez(given, vertices=vertices, triangles=triangles, **values)
        command = child_command(__name__, "mesh_in_child", str(given), str(made), str(os.getpid()))
        try:
            done = subprocess.run(
                command,
                cwd=folder,  # fTetWild leaves files where it runs
                timeout=settings.time_limit_s,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise MesherTimeError(
                f"the mesher did not finish within {settings.time_limit_s:.0f} s"
                f" at edge length {settings.edge_length:.3g} mm",
                "try a larger solver.edge_length_mm, or remove very small fillets and steps",
            ) from None
        if done.returncode != 0 or not made.exists():
            last = done.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["no message"]
            raise MesherError(
                f"the mesher ended with status {done.returncode} ({last[0][:200]})",
                "try a slightly different solver.edge_length_mm",
            )
        points, tets = _read(made)
    if len(tets) == 0:
        raise MesherError("the mesher returned no elements", "check the part's proportions")
    flipped = signed_volumes(points, tets) < 0
    tets[flipped] = tets[flipped][:, [0, 2, 1, 3]]
    return points, tets


def _read(made: Path) -> tuple[np.ndarray, np.ndarray]:
    try:
        with np.load(made) as out:
            return out["points"], out["tets"].astype(np.int64)
    except (OSError, ValueError, KeyError, EOFError, BadZipFile) as fault:
        reason = f"the mesher's result cannot be read ({type(fault).__name__})"
        raise MesherError(reason, "see whether the disk is full") from fault


def signed_volumes(points: np.ndarray, tets: np.ndarray) -> np.ndarray:
    """Return volumes (t,) mm³, positive when corner 3 lies on the side of (1-0)×(2-0)."""
    a, b, c = (points[tets[:, i]] - points[tets[:, 0]] for i in (1, 2, 3))
    return np.einsum("ij,ij->i", np.cross(a, b), c) / 6


GRACE_S = 30.0
"""[s] How long a child runs beyond the time limit if its parent did not end it. Judgement: only a killed
parent does not."""


def mesh_in_child(given: str, made: str, parent: str) -> None:
    """Mesh the file `given` into the file `made`, in a child of the process `parent`."""
    end_with(int(parent))  # elsewhere than on Linux by the time limit
    import pytetwild

    with np.load(given) as g:
        # a thread of C's, which fTetWild does not keep from running
        faulthandler.dump_traceback_later(float(g["time_limit_s"]) + GRACE_S, exit=True)
        vertices, triangles = g["vertices"], g["triangles"].astype(np.int32)
        sized = "bg_points" in g
        diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        points, tets = pytetwild.tetrahedralize(
            vertices,
            triangles,
            edge_length_abs=float(g["edge_length"]),
            epsilon=float(g["envelope"]) / diagonal,
            stop_energy=float(g["stop_energy"]),
            simplify=False,
            bg_vertices=g["bg_points"] if sized else None,
            bg_tets=g["bg_tets"].astype(np.int32) if sized else None,
            bg_values=g["bg_edge_length"] if sized else None,
        )
    np.savez(made, points=points, tets=tets)
