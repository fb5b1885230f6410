"""STEP, STL, VTU and mesh files of a design."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from flexspline.fea.solid.deck import torsion_deck
from flexspline.fea.solid.unfold import Parity
from flexspline.fea.solid.whole import whole_part
from flexspline.fea.types import SolidField
from flexspline.geometry.cad import build_solid, write_step, write_stl
from flexspline.geometry.design import Design
from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.ellipse_peak import ellipse_field
from flexspline.pipeline.part_stiffness import turned_field, twisted_part
from flexspline.pipeline.parts import AnalysisContext, PartModel
from flexspline.pipeline.progress import Progress
from flexspline.pipeline.temporary_files import scratch_folder, temporary_folder
from flexspline.pipeline.torque_stress import torque_field
from flexspline.results.atomic import named, write_bytes
from flexspline.results.mesh_files import PatchedMesh, write_mesh
from flexspline.results.plain_letters import plain

STL_CHORD_ERROR_MM = 0.01
"""Below what a printer or a viewer resolves."""


def write_exports(
    context: AnalysisContext, folder: Path, formats: Sequence[str] = (), deck: bool = False
) -> list[Path]:
    """Whole parts as STEP and STL [mm]; solved fields as VTU: displacement [mm], von Mises [MPa].

    `formats` (`results.mesh_files`): also the meshes that gave K, of the whole parts. `deck`: also the
    torsion case as CalculiX/Abaqus decks. CAD comes first, and each file as soon as it can be written, whole
    or not at all.
    """
    done: list[Path] = []
    models = (context.part("flexspline"), context.part("shaft"))
    for model in models:
        model.refuse_settings()
    done += write_cad(context.design, folder, context.progress, stl=True)
    for model in models:
        done += _write_meshes(model, folder, formats)
        done += [_write_deck(model, folder)] if deck else []
        torque = folder / f"{model.name}_torque.vtu"
        done.append(_write_field(model, torque, torque_field, "antisymmetric"))
    wave_generator = folder / "wave_generator.vtu"
    return [*done, _write_field(models[0], wave_generator, ellipse_field, "symmetric")]


def write_cad(design: Design, folder: Path, progress: Progress, stl: bool = False) -> list[Path]:
    """Both whole parts as STEP [mm], and as `stl` where wanted; nothing is solved."""
    done = []
    for part in design.parts:
        with progress.stage(f"CAD of the whole {part.name}"):
            solid = build_solid(part)
            step = partial(write_step, solid, name=plain(f"{design.name}, {part.name}"))
            done.append(write_whole(folder / f"{part.name}.step", step))
            if stl:
                triangles = partial(write_stl, solid, chord_error=STL_CHORD_ERROR_MM)
                done.append(write_whole(folder / f"{part.name}.stl", triangles))
    return done


def _write_meshes(part: PartModel, folder: Path, formats: Sequence[str]) -> list[Path]:
    if not formats:
        return []
    mesh = PatchedMesh.of(part.name, twisted_part(part).meshed.mesh)
    done = []
    for suffix in formats:
        with part.context.progress.stage(f"{suffix} of the {part.name}"):
            done.append(write_whole(folder / f"{part.name}.{suffix}", partial(write_mesh, mesh)))
    return done


def _write_deck(part: PartModel, folder: Path) -> Path:
    """The torsion case as a CalculiX/Abaqus deck, on the sector's mesh that gave K."""
    twisted = twisted_part(part)
    path = folder / f"{part.name}_torsion.inp"
    with part.context.progress.stage(f"deck of the {part.name}"):
        on_this_mesh = turned_field(part, twisted).K_Nm_per_rad
        title = f"{part.context.design.name}: {part.name} under torsion"
        mesh, driven = twisted.meshed.mesh, part.part.driven
        text = torsion_deck(mesh, part.material, driven, on_this_mesh, title)
        write_bytes(path, text.encode())
    return path


ENDINGS = {".step": b"END-ISO-10303-21;", ".vtu": b"</VTKFile>"}
"""Last bytes of a complete file, by suffix. They are checked because the writers of the CAD kernel do not
report a full disk."""
STL_HEAD_BYTES, STL_TRIANGLE_BYTES = 84, 50
"""Sizes in a binary STL file."""


class ExportError(ComputationError):
    """A file that its writer did not finish."""


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Write among the scratch files under the same name, see that it is whole, move it into place.

    Raises
    ------
    ExportError : it is not. OSError : with the path's name, or that of the folder for temporary files.
    """
    with scratch_folder("flexspline-export-") as folder:
        made = folder / path.name
        with named(path):
            write(made)
        data = made.read_bytes() if made.exists() else b""
    if not _is_whole(data, path.suffix):
        raise ExportError(
            f"{path.name} was not written completely; is the folder for temporary files (TMPDIR), "
            f"{temporary_folder()}, full, or the size of files limited (ulimit -f)?"
        )
    write_bytes(path, data)
    return path


def _is_whole(data: bytes, suffix: str) -> bool:
    if suffix == ".stl":
        triangles = int.from_bytes(data[80:84], "little")  # after 80 bytes of text
        return len(data) == STL_HEAD_BYTES + STL_TRIANGLE_BYTES * triangles > STL_HEAD_BYTES
    return bool(data) and data.rstrip().endswith(ENDINGS.get(suffix, b""))


def _write_field(
    part: PartModel, path: Path, solve: Callable[[PartModel], SolidField], parity: Parity
) -> Path:
    """A field of the whole part, the sector reflected and turned, as quadratic tetrahedra."""
    import meshio

    field = solve(part)
    with part.context.progress.stage(f"VTU {path.stem}"):
        whole = whole_part(field.mesh, field.displacement, field.mises, parity)
        data = {"displacement_mm": whole.displacement, "von_mises_MPa": whole.mises}
        return write_whole(path, meshio.Mesh(whole.nodes, [("tetra10", whole.cells)], data).write)
