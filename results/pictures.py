"""All pictures of a run, drawn once for the same content and kept."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from pipeline.backlash import angle_rad
from pipeline.cache import Cache
from pipeline.chain import RunResult
from pipeline.diagnosis.extended_backlash import ExtendedBacklash
from pipeline.parts import Workshop
from results.atomic import write_bytes

ARCSEC_PER_RAD = 180 / np.pi * 3600
TITLES = {"flexspline": "Flexspline", "shaft": "Output shaft"}
DRAWING = 3
"""Raise when a drawing changes, so that kept pictures are drawn anew."""
TURNING = 2
"""The same of the 3-D views."""


def write_pictures(
    shop: Workshop, result: RunResult, folder: Path, extended: ExtendedBacklash | None = None
) -> Mapping[str, Path]:
    """Draw (or take from the cache) every picture of a run into `folder`; name to path."""
    paths = {}
    for name, inputs, draw in _pictures(shop, result, extended):
        path = folder / f"{name}.png"
        with shop.progress.stage(f"picture {name}"):
            write_bytes(path, _drawn(shop.cache, name, inputs, draw))
        paths[name] = path
    return paths


def turning_views(shop: Workshop, result: RunResult) -> dict[str, bytes]:
    """The stress pictures as views that turn in a browser, by the pictures' names."""
    design, fields = result.design, result.fields
    torque_Nm, w0 = design.load.torque_Nm, design.gear.centre_distance_mm

    def stress(part: str) -> Callable[[Path], None]:
        def draw(path: Path) -> None:
            from results.renders.stress_picture import turning_torque_stress

            name = f"{part}_torque"
            path.write_bytes(turning_torque_stress(name, fields[name], TITLES[part], torque_Nm))

        return draw

    def ellipse(path: Path) -> None:
        from results.renders.ellipse_picture import turning_ellipse

        path.write_bytes(turning_ellipse("wave_generator", fields["wave_generator"], w0))

    draws = {f"{p}_torque": stress(p) for p in TITLES} | {"wave_generator": ellipse}
    found = {}
    for name, inputs, _ in _pictures(shop, result, None):
        if name in draws:
            with shop.progress.stage(f"3-D view {name}"):
                found[name] = _drawn(shop.cache, name, {"turning": TURNING, **inputs}, draws[name])
    return found


def small(shop: Workshop, png: Path) -> bytes:
    """A rendered picture as WebP, a fifth of its PNG: for pages, which carry their pictures."""

    def draw(path: Path) -> None:
        from PIL import Image

        with Image.open(png) as image:
            image.convert("RGB").save(path, "WEBP", quality=82, method=4)

    digest = hashlib.sha256(png.read_bytes()).hexdigest()
    return _drawn(shop.cache, "webp", {"sha256": digest}, draw)


def _drawn(
    cache: Cache, name: str, inputs: Mapping[str, Any], draw: Callable[[Path], None]
) -> bytes:
    def make() -> bytes:
        with tempfile.TemporaryDirectory(prefix="flexspline-picture-") as folder:
            path = Path(folder) / "picture.png"
            draw(path)
            return path.read_bytes()

    return cache.get("picture", {"drawing": DRAWING, "name": name, **inputs}, make)[0]


def _pictures(
    shop: Workshop, result: RunResult, extended: ExtendedBacklash | None
) -> list[tuple[str, Mapping[str, Any], Callable[[Path], None]]]:
    design, found, fields = result.design, result.stiffnesses, result.fields
    torque = {"torque_Nm": design.load.torque_Nm, "wall": design.flexspline.wall_thickness_mm}
    w0 = design.gear.centre_distance_mm
    sums = {"backlash": asdict(result.backlash), **torque}
    added = None if extended is None else asdict(extended)
    K_b, K_e = found.in_sum(design).K_Nm_per_rad, found.shaft.K_Nm_per_rad
    bounded = {"K_b_Nm_per_rad": found.flexspline, "K_e_Nm_per_rad": found.shaft}

    def part(name: str) -> Mapping[str, Any]:
        return shop.part(name).torsion_key

    def mesh(name: str) -> Callable[[Path], None]:
        def draw(path: Path) -> None:
            from results.renders.mesh_picture import write_mesh_picture

            write_mesh_picture(path, fields[f"{name}_torque"].mesh, TITLES[name])

        return draw

    def stress(name: str) -> Callable[[Path], None]:
        def draw(path: Path) -> None:
            from results.renders.stress_picture import write_torque_stress

            write_torque_stress(path, fields[f"{name}_torque"], TITLES[name], design.load.torque_Nm)

        return draw

    def ellipse(path: Path) -> None:
        from results.renders.ellipse_picture import write_ellipse_picture

        write_ellipse_picture(path, fields["wave_generator"], w0)

    def budget(path: Path) -> None:
        from results.figures.budget import write_budget

        write_budget(path, result.backlash, extended)

    def line(path: Path) -> None:
        from results.figures.torque_angle import write_torque_angle

        def angle(torque_Nm: np.ndarray) -> np.ndarray:
            return np.asarray(angle_rad(design, torque_Nm, K_b, K_e)) * ARCSEC_PER_RAD

        write_torque_angle(path, angle, design.load.torque_Nm, result.backlash)

    def convergence(path: Path) -> None:
        from results.figures.convergence import write_convergence

        write_convergence(path, bounded)

    return [
        ("flexspline_mesh", part("flexspline"), mesh("flexspline")),
        ("shaft_mesh", part("shaft"), mesh("shaft")),
        ("flexspline_torque", {**part("flexspline"), **torque}, stress("flexspline")),
        ("shaft_torque", {**part("shaft"), **torque}, stress("shaft")),
        ("wave_generator", {**part("flexspline"), "w0_mm": w0}, ellipse),
        ("backlash_budget", {**sums, "extended": added}, budget),
        ("torque_angle", {**sums, "K": [K_b, K_e]}, line),
        ("convergence", {k: asdict(v) for k, v in bounded.items()}, convergence),
    ]
