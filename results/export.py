"""STEP, STL and VTU files of a design."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from flexspline.fea.solid.deck import torsion_deck
from flexspline.fea.types import SolidField
from flexspline.geometry.cad import build_solid, write_step, write_stl
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.analysis import torque_field
from flexspline.pipeline.load_cases import wave_generator_field
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.results.atomic import write_bytes
from flexspline.results.renders.whole import Parity, whole_part

STL_CHORD_ERROR_MM = 0.01
"""Below what a printer or a viewer resolves."""


def write_exports(context: AnalysisContext, folder: Path) -> list[Path]:
    """Whole parts as STEP and STL [mm]; solved fields as VTU: displacement [mm], von Mises [MPa].

    Every file appears whole or not at all.
    """
    done: list[Path] = []
    for part in context.design.parts:
        with context.progress.stage(f"CAD of the whole {part.name}"):
            solid = build_solid(part)
            done.append(_whole(folder / f"{part.name}.step", partial(write_step, solid)))
            stl = partial(write_stl, solid, chord_error=STL_CHORD_ERROR_MM)
            done.append(_whole(folder / f"{part.name}.stl", stl))
    flexspline, shaft = context.part("flexspline"), context.part("shaft")
    fields: tuple[tuple[str, SolidField, Parity], ...] = (
        ("flexspline_torque", torque_field(flexspline), "antisymmetric"),
        ("shaft_torque", torque_field(shaft), "antisymmetric"),
        ("wave_generator", wave_generator_field(flexspline), "symmetric"),
    )
    for name, field, parity in fields:
        with context.progress.stage(f"VTU {name}"):
            done.append(_whole(folder / f"{name}.vtu", partial(_write_vtu, field, parity)))
    return done


def write_step_files(design: Design, folder: Path, progress: Progress) -> list[Path]:
    """Both whole parts as STEP [mm]; nothing is solved."""
    done = []
    for part in design.parts:
        with progress.stage(f"CAD of the whole {part.name}"):
            step = partial(write_step, build_solid(part))
            done.append(_whole(folder / f"{part.name}.step", step))
    return done


def write_decks(context: AnalysisContext, folder: Path) -> list[Path]:
    """The torsion case of both parts as CalculiX/Abaqus decks, on the meshes that gave K."""
    done = []
    for part in (context.part("flexspline"), context.part("shaft")):
        name, driven = part.name, part.part.driven
        twisted = part.twisted()
        with context.progress.stage(f"deck of the {name}"):
            on_this_mesh = twisted.stiffness.levels[-1].K_Nm_per_rad
            title = f"{context.design.name}: {name} under torsion"
            text = torsion_deck(twisted.meshed.mesh, part.material, driven, on_this_mesh, title)
            done.append(folder / f"{name}_torsion.inp")
            write_bytes(done[-1], text.encode())
    return done


ENDINGS = {".step": b"END-ISO-10303-21;", ".vtu": b"</VTKFile>"}
"""How whole files end: their writers say nothing of a full disk."""
STL_HEAD_BYTES, STL_TRIANGLE_BYTES = 84, 50
"""Of the binary format."""


class ExportError(ComputationError):
    """A file that its writer did not finish."""


def _whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Write among the scratch files under the same name, see that it is whole, move it into place.

    Raises
    ------
    ExportError : it is not.
    """
    with tempfile.TemporaryDirectory(prefix="flexspline-export-") as folder:
        made = Path(folder) / path.name
        write(made)
        data = made.read_bytes() if made.exists() else b""
        if not _is_whole(data, path.suffix):
            raise ExportError(f"{path.name} was not written whole; is the disk of {folder} full?")
        write_bytes(path, data)
    return path


def _is_whole(data: bytes, suffix: str) -> bool:
    if suffix == ".stl":
        triangles = int.from_bytes(data[80:84], "little")
        return len(data) == STL_HEAD_BYTES + STL_TRIANGLE_BYTES * triangles > STL_HEAD_BYTES
    return data.rstrip().endswith(ENDINGS[suffix])


def _write_vtu(field: SolidField, parity: Parity, path: Path) -> None:
    """The whole part, the sector reflected and turned, as quadratic tetrahedra."""
    import pyvista as pv

    whole = whole_part(field.mesh, field.displacement, field.mises, parity)
    grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: whole.cells}, whole.nodes)
    grid.point_data["displacement_mm"] = whole.displacement
    grid.point_data["von_mises_MPa"] = whole.mises
    grid.save(path)
