"""The torque of a lobe load, and K by the work that it does."""

from __future__ import annotations

from flexspline.fea.types import NMM_PER_NM

LOBE_TORQUE_NMM = NMM_PER_NM
"""Applied torque T [N·mm]: 1 N·m."""


def stiffness_of_work(work_Nmm: float) -> float:
    """Return K = T²/(T·Θ) [N·m/rad]; the work T·Θ is twice the strain energy (Clapeyron)."""
    return LOBE_TORQUE_NMM**2 / work_Nmm / NMM_PER_NM


def work_of_stiffness(K_Nm_per_rad: float) -> float:
    """Return the work T·Θ [N·mm] of a stiffness [N·m/rad]."""
    return LOBE_TORQUE_NMM**2 / (K_Nm_per_rad * NMM_PER_NM)
