"""All pictures of a run, drawn once for the same content and kept.

Charts are drawn here, parts meanwhile in processes of their own (`results.renders.pool`): where that fails,
those pictures are missing and everything else comes. What is missing is not kept: the next run tries again.
"""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from flexspline.geometry.part import PartName
from flexspline.pipeline.analysis import RunResult
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, angle_rad
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash
from flexspline.pipeline.parts import AnalysisContext
from flexspline.results.atomic import write_bytes
from flexspline.results.figures.budget import write_budget
from flexspline.results.figures.convergence import write_convergence
from flexspline.results.figures.gear import CURVE, LOADS, write_gear_angle, write_gear_loads
from flexspline.results.figures.torque_angle import write_torque_angle
from flexspline.results.renders.ellipse_picture import write_ellipse_picture, write_turning_ellipse
from flexspline.results.renders.mesh_picture import write_mesh_picture
from flexspline.results.renders.pool import DrawingPool
from flexspline.results.renders.process import NotDrawnError
from flexspline.results.renders.stress_picture import (
    write_torque_stress,
    write_turning_torque_stress,
)

TITLES: Mapping[PartName, str] = {"flexspline": "Flexspline", "shaft": "Output shaft"}
ELLIPSE = "wave_generator"
PROCESSES = 2
"""That draw at once: where the processor draws, each uses about one core; VTK takes 0.3 GB in each."""
DRAWING = 5
"""Raise when a drawing changes, so that kept pictures are drawn anew."""
TURNING = 2
"""The same of the 3-D views."""


@dataclass(frozen=True)
class RunPictures:
    """What was drawn of a run.

    Attributes
    ----------
    paths : PNG files by name.
    views : the stress pictures as views that turn in a browser, by the pictures' names.
    missing : why, by the names of the pictures and views that could not be drawn.
    """

    paths: Mapping[str, Path]
    views: Mapping[str, bytes] = field(default_factory=dict)
    missing: Mapping[str, str] = field(default_factory=dict)

    @property
    def warnings(self) -> tuple[str, ...]:
        """One line for each reason."""
        by_reason: dict[str, list[str]] = {}
        for name, reason in self.missing.items():
            by_reason.setdefault(reason, []).append(name)
        return tuple(f"not drawn: {', '.join(n)}: {reason}" for reason, n in by_reason.items())


@dataclass(frozen=True)
class _Drawing:
    """A picture or a view: what it depends on beside its name, and how to make its bytes."""

    name: str
    inputs: Mapping[str, Any]
    make: Callable[[], bytes]


def write_pictures(
    context: AnalysisContext,
    result: RunResult,
    folder: Path,
    extended: ExtendedBacklash | None = None,
) -> RunPictures:
    """Draw (or take from the cache) every picture of a run into `folder`, and the 3-D views.

    Without "convergence" where every stiffness was solved on one mesh, and without those of fields that
    are missing. A picture of an earlier run that cannot be drawn now is removed: it may be another
    design's.
    """
    paths: dict[str, Path] = {}
    views: dict[str, bytes] = {}
    missing: dict[str, str] = {}

    def keep_picture(drawing: _Drawing, made: Callable[[], bytes]) -> None:
        path = folder / f"{drawing.name}.png"
        try:
            write_bytes(path, made())
            paths[drawing.name] = path
        except NotDrawnError as error:
            missing[drawing.name] = str(error)
            path.unlink(missing_ok=True)

    def keep_view(drawing: _Drawing, made: Callable[[], bytes]) -> None:
        try:
            views[drawing.name] = made()
        except NotDrawnError as error:
            missing[f"3-D view {drawing.name}"] = str(error)

    def begun(drawing: _Drawing, kind: str) -> Callable[[], bytes]:
        def make() -> bytes:
            context.progress.note(f"  {kind} {drawing.name}")
            return _drawn(context.cache, drawing)

        return threads.submit(make).result

    # the processes end first: a thread that waits for one then comes to its end
    with (
        context.progress.stage("pictures"),
        ThreadPoolExecutor(PROCESSES) as threads,
        DrawingPool(PROCESSES) as pool,
    ):
        renders = [(d, begun(d, "picture")) for d in _renders(context, result, pool)]
        charts = [(c, _drawn(context.cache, c)) for c in _charts(result, extended)]
        for render, made in renders:
            keep_picture(render, made)
        for chart, png in charts:
            paths[chart.name] = folder / f"{chart.name}.png"
            write_bytes(paths[chart.name], png)
        # only of pictures that there are: they stand where scripts do not run
        turning = [(d, begun(d, "3-D view")) for d in _views(context, result, pool, tuple(paths))]
        for view, made in turning:
            keep_view(view, made)
    return RunPictures(paths, views, missing)


def small(context: AnalysisContext, png: Path) -> bytes:
    """A rendered picture as WebP, a fifth of its PNG: for pages, which carry their pictures."""

    def write(path: Path) -> None:
        from PIL import Image

        with Image.open(png) as image:
            image.convert("RGB").save(path, "WEBP", quality=82, method=4)

    digest = hashlib.sha256(png.read_bytes()).hexdigest()
    return _drawn(context.cache, _Drawing("webp", {"sha256": digest}, partial(_here, write)))


def _drawn(cache: Cache, drawing: _Drawing) -> bytes:
    inputs = {"drawing": DRAWING, "name": drawing.name, **drawing.inputs}
    return cache.get("picture", inputs, drawing.make)[0]


def _here(write: Callable[..., None], *arguments: Any) -> bytes:
    """What `write(path, *arguments)` writes, in this process."""
    with tempfile.TemporaryDirectory(prefix="flexspline-picture-") as folder:
        path = Path(folder) / "picture.png"
        write(path, *arguments)
        return path.read_bytes()


def _stress_inputs(context: AnalysisContext, part: PartName) -> Mapping[str, Any]:
    return {**context.part(part).torsion_key, "torque_Nm": context.design.load.torque_Nm}


def _ellipse_inputs(context: AnalysisContext) -> Mapping[str, Any]:
    w0 = context.design.w0_mm
    return {**context.part("flexspline").torsion_key, "w0_mm": w0}


def _renders(context: AnalysisContext, result: RunResult, pool: DrawingPool) -> Iterable[_Drawing]:
    """The parts whose fields there are: meshes, stress under torque, the ellipse."""
    fields, load = result.fields, result.design.load
    solved = {part: f"{part}_torque" for part in TITLES if f"{part}_torque" in fields}
    for part, name in solved.items():
        make = partial(pool.draw, write_mesh_picture, fields[name].mesh, TITLES[part])
        yield _Drawing(f"{part}_mesh", context.part(part).torsion_key, make)
    for part, name in solved.items():
        shown = fields[name], TITLES[part], load.torque_Nm
        make = partial(pool.draw, write_torque_stress, *shown)
        yield _Drawing(name, _stress_inputs(context, part), make)
    if ELLIPSE in fields:
        ellipse = fields[ELLIPSE], result.design.w0_mm
        make = partial(pool.draw, write_ellipse_picture, *ellipse)
        yield _Drawing(ELLIPSE, _ellipse_inputs(context), make)


def _views(
    context: AnalysisContext, result: RunResult, pool: DrawingPool, names: Iterable[str]
) -> Iterable[_Drawing]:
    """Those of the stress pictures again, as views that turn."""
    fields, load = result.fields, result.design.load
    key: dict[str, Any] = {"turning": TURNING}
    part_of: dict[str, PartName] = {f"{part}_torque": part for part in TITLES}
    for name in names:
        if name == ELLIPSE:
            ellipse = name, fields[name], result.design.w0_mm
            make = partial(pool.draw, write_turning_ellipse, *ellipse)
            yield _Drawing(name, {**key, **_ellipse_inputs(context)}, make)
        elif name in part_of:
            part = part_of[name]
            shown = name, fields[name], TITLES[part], load.torque_Nm
            make = partial(pool.draw, write_turning_torque_stress, *shown)
            yield _Drawing(name, {**key, **_stress_inputs(context, part)}, make)


def _charts(result: RunResult, extended: ExtendedBacklash | None) -> Iterable[_Drawing]:
    """What matplotlib draws alone."""
    design, found, backlash = result.design, result.stiffnesses, result.backlash
    sums = {"backlash": asdict(backlash), "torque_Nm": design.load.torque_Nm}
    K_b, K_e = found.in_sum(design).K_Nm_per_rad, found.K_e.K_Nm_per_rad
    solved = {"K_b_Nm_per_rad": found.K_b, "K_e_Nm_per_rad": found.K_e}
    settling = {key: K for key, K in solved.items() if len(K.levels) > 1}

    def angle(torque: np.ndarray) -> np.ndarray:
        return np.asarray(angle_rad(design, torque, K_b, K_e)) * ARCSEC_PER_RAD

    added = None if extended is None else asdict(extended)
    budget = partial(_here, write_budget, backlash, extended)
    yield _Drawing("backlash_budget", {**sums, "extended": added}, budget)
    line = partial(_here, write_torque_angle, angle, design.load.torque_Nm, backlash)
    yield _Drawing("torque_angle", {**sums, "K": [K_b, K_e]}, line)
    if result.gear is not None:
        curve = asdict(result.gear)
        yield _Drawing(CURVE, {"curve": curve}, partial(_here, write_gear_angle, result.gear))
        yield _Drawing(LOADS, {"curve": curve}, partial(_here, write_gear_loads, result.gear))
    if settling:  # a single mesh shows no convergence
        convergence = partial(_here, write_convergence, settling)
        yield _Drawing("convergence", {k: asdict(v) for k, v in settling.items()}, convergence)
