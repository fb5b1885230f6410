"""The gear on the rig: a design file, its simulated line, and the gear as it truly is."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from
from flexspline.pipeline.backlash import ARCSEC_PER_RAD, backlash, gap_rad
from flexspline.pipeline.bearing_play import BearingPlayDomainError

EXAMPLES = Path(__file__).parents[2] / "examples"
STIFFNESS = {  # K_b, K_e [N·m/rad], of the size that finite elements give for these examples
    "xb1-40.toml": (31330.0, 43340.0),
    "hat-25.toml": (52000.0, 310000.0),
    "keyed-shaft.toml": (33100.0, 36500.0),
}
REACH = 3.0
"""Standard deviations at which the drawn gear is cut: a gear further off is a finding, not a clean one."""


@dataclass(frozen=True)
class Rig:
    """What the person at the rig knows: the design and its simulated stiffness.

    Attributes
    ----------
    compliance, compliance_std : arcsec per N·m.
    gap, gap_std : the whole angular gap, arcsec.
    """

    toml: str
    K_b: float
    K_e: float
    design: Design
    compliance: float
    compliance_std: float
    gap: float
    gap_std: float


@dataclass(frozen=True)
class Gear:
    """One unit as it truly is: compliance [arcsec/N·m], gap [arcsec], zero [arcsec]."""

    compliance: float
    gap: float
    zero: float


def rig(toml: str, K_b: float, K_e: float) -> Rig:
    """The simulated line of a design and how far it may be off, by `pipeline.backlash`."""
    design = design_from(tomllib.loads(toml))
    compliance = (1 / K_b + 1 / K_e) * ARCSEC_PER_RAD
    std = backlash(design, K_b, K_e).std_by_source_arcsec
    gap_std = float(np.hypot(std["flank_clearance"], std["radial_clearance"]))
    pct = design.uncertainty.youngs_modulus_pct
    gap = gap_rad(design) * ARCSEC_PER_RAD
    return Rig(toml, K_b, K_e, design, compliance, compliance * pct / 100, gap, gap_std)


def draw_rig(rng: np.random.Generator) -> Rig:
    """An example design with other clearances, other doubts about them, other stiffness."""
    name = str(rng.choice(list(STIFFNESS)))
    K_b, K_e = (k * rng.uniform(0.6, 1.6) for k in STIFFNESS[name])
    wide = rng.random() < 0.75
    flank, play = (rng.uniform(1.5, 5), rng.uniform(4, 15)) if wide else (0.6, rng.uniform(1, 4))
    toml = altered(
        (EXAMPLES / name).read_text(encoding="utf-8"),
        {
            ("gear", "flank_clearance_um"): round(flank, 2),
            ("bearing", "radial_clearance_um"): round(play, 2),
            ("uncertainty", "flank_clearance_um"): round(flank * rng.uniform(0.08, 0.33), 3),
            ("uncertainty", "radial_clearance_um"): round(play * rng.uniform(0.08, 0.25), 3),
        },
    )
    return rig(toml, round(K_b), round(K_e))


def draw_gear(rig: Rig, rng: np.random.Generator, zero_arcsec: float = 100.0) -> Gear:
    """A unit drawn from the design's `[uncertainty]`, with a zero of its own."""
    d, doubt = rig.design, rig.design.uncertainty
    E = 1 + doubt.youngs_modulus_pct / 100 * _normal(rng)
    while True:
        flank = d.gear.flank_clearance_um + doubt.flank_clearance_um * _normal(rng)
        play = d.bearing.radial_clearance_um + doubt.radial_clearance_um * _normal(rng)
        if flank < 0 or play < 0:
            continue
        gear = d.gear.model_copy(update={"flank_clearance_um": flank})
        bearing = d.bearing.model_copy(update={"radial_clearance_um": play})
        try:
            gap = gap_rad(d.model_copy(update={"gear": gear, "bearing": bearing}))
        except BearingPlayDomainError:
            continue
        return Gear(rig.compliance / E, gap * ARCSEC_PER_RAD, zero_arcsec * _normal(rng))


def altered(toml: str, values: dict[tuple[str, str], float]) -> str:
    """The design file's text with the value of (table, key) replaced, comments kept."""
    table, lines, left = "", [], dict(values)
    for line in toml.splitlines():
        if found := re.match(r"\[+([\w.]+)\]+", line):
            table = found[1]
        if found := re.match(r"(\w+)(\s*=\s*)[-+\d.eE]+", line):
            value = left.pop((table, found[1]), None)
            if value is not None:
                line = f"{found[1]}{found[2]}{value}{line[found.end() :]}"
        lines.append(line)
    if left:
        raise KeyError(f"not in the design file: {sorted(left)}")
    return "\n".join(lines) + "\n"


def _normal(rng: np.random.Generator) -> float:
    while abs(x := float(rng.normal())) > REACH:
        pass
    return x
