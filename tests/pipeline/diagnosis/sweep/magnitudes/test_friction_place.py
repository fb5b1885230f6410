"""Friction that takes torque before a soft wind-up makes its loop wider where the gear is softer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES

from flexspline.geometry.load import load_design
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.sweep.evidence.fit import fit_regressors
from flexspline.pipeline.diagnosis.sweep.evidence.gaussian_evidence import gaussian_evidence
from flexspline.pipeline.diagnosis.sweep.magnitudes.friction_place import (
    hardening_std,
    width_share_std,
)

ROWS, PER_CYCLE, COMPLIANCE, LARGEST_Nm = 640, 160, 11.343, 10.0
HARDENING, FRICTION = "stiffness_hardening", "friction_hysteresis"


def slipping_springs(torque: np.ndarray, limit: float) -> np.ndarray:
    """Torque of two springs, once and half the torque's change, that slip at half of the limit each."""
    total = np.zeros(len(torque))
    for share in (1.0, 0.5):
        held = 0.0
        for k, change in enumerate(np.diff(torque, prepend=torque[0])):
            held = float(np.clip(held + share * change, -limit / 2, limit / 2))
            total[k] += held
    return total


def twist(torque: np.ndarray, friction_Nm: float) -> np.ndarray:
    """A soft wind-up of the torque that friction leaves, stiff above a third of the largest [arcsec]."""
    left = torque - slipping_springs(torque, friction_Nm)
    return COMPLIANCE * (left + 0.15 * LARGEST_Nm * np.tanh(left / (0.3 * LARGEST_Nm)))


def triangle() -> np.ndarray:
    i = np.arange(ROWS)
    return LARGEST_Nm * (1 - 4 * np.abs(((i + 0.5) / PER_CYCLE + 0.25) % 1 - 0.5))


def diagnosed(friction_Nm: float, folder: Path, one_sided: bool = False) -> Diagnosis:
    i = np.arange(ROWS)
    torque = np.abs(triangle()) if one_sided else triangle()
    angle = twist(torque, friction_Nm)
    angle += 36.1 * np.sign(torque) + np.random.default_rng(3).normal(0, 0.4, ROWS)
    path = folder / "rig.csv"
    body = "".join(f"{3 * k},{t:.4f},{a:.3f}\n" for k, t, a in zip(i, torque, angle, strict=True))
    path.write_text("time_s,torque_Nm,angle_arcsec\n" + body)
    return diagnose_file(load_design(EXAMPLES / "xb1-40.toml"), path, 31329.0, 43339.0)


@pytest.fixture(scope="module")
def both_sides(tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    return diagnosed(0.6, tmp_path_factory.mktemp("both"))


def test_the_deviation_is_what_the_other_place_moves_the_size_by(both_sides: Diagnosis) -> None:
    found = both_sides
    assert found.sweep is not None
    fit = found.sweep.explained.identified.fit
    assert fit.evidence.columns.ahead is None
    evidence, torque = fit.evidence, fit.rig.history.torque_Nm
    # the wind-up's slope from its own fitted twist, row by row along the torque
    order = np.argsort(torque)
    sorted_torque, first = np.unique(torque[order], return_index=True)
    slope = np.gradient(fit.added(HARDENING)[order][first], sorted_torque)
    softer = np.interp(torque, sorted_torque, slope) / fit.measured_rig().compliance
    other = evidence.target + fit.added(FRICTION) * softer
    again = gaussian_evidence(evidence.columns, other, evidence.kept, evidence.noise)
    moved = fit_regressors(again, fit.posterior.terms).magnitudes()[HARDENING]
    moved -= fit.magnitudes()[HARDENING]
    assert moved != 0
    # to first order, the slope by differences
    assert hardening_std(fit) == pytest.approx(abs(moved) / 2**0.5, rel=0.2)
    (cause,) = (c for c in found.causes if c.id == HARDENING)
    assert cause.magnitude_std > hardening_std(fit)


def test_where_torque_stays_on_one_side_the_width_at_zero_is_as_open(
    both_sides: Diagnosis, tmp_path: Path
) -> None:
    """Loops between 0 and the largest torque close at T = 0; the record shows none that crosses it."""
    torque, friction_Nm = triangle(), 0.6
    angle, last = twist(torque, friction_Nm), slice(-PER_CYCLE, None)
    falls = np.diff(torque[last], prepend=torque[-PER_CYCLE - 1]) < 0
    at_zero = []
    for way in (falls, ~falls):
        order = np.argsort(torque[last][way])
        at_zero.append(np.interp(0.0, torque[last][way][order], angle[last][way][order]))
    truth = at_zero[0] - at_zero[1]
    for one_sided in (False, True):
        found = diagnosed(friction_Nm, tmp_path, one_sided) if one_sided else both_sides
        (cause,) = (c for c in found.causes if c.id == FRICTION)
        assert found.sweep is not None
        fit = found.sweep.explained.identified.fit
        open_share = width_share_std(fit)
        ratio = fit.magnitudes()[HARDENING]
        assert open_share == (pytest.approx((ratio - 1) / 2**0.5) if one_sided else 0.0)
        assert abs(cause.magnitude - truth) < 2.5 * cause.magnitude_std
        # the doubt of place outweighs all others on one side, and is no part of it on both
        least, most = (1.0, 1.1) if one_sided else (0.0, 0.05)
        doubt = cause.magnitude_std / cause.magnitude
        assert least * open_share <= doubt <= max(most * open_share, 0.05)


def test_without_friction_there_is_none(tmp_path: Path) -> None:
    found = diagnosed(0.0, tmp_path)
    assert found.sweep is not None
    fit = found.sweep.explained.identified.fit
    assert HARDENING in fit.elements()
    assert FRICTION not in fit.elements()
    assert hardening_std(fit) == 0.0
