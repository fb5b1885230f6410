"""The whole gear's part of the table of quantities (`quantities.py`)."""

from __future__ import annotations

from flexspline.geometry.rated import LOST_MOTION_TORQUE
from flexspline.results.quantity import STIFFNESS_UNIT, Quantity

GEAR_QUANTITIES: tuple[Quantity, ...] = (
    *(
        Quantity(
            f"{key}_Nm_per_rad",
            STIFFNESS_UNIT,
            f"{key} of the whole gear, {name}",
            f"K_{key[1]}",
            rounded=True,
            short_name=name,
            group="gear",
        )
        for key, name in (
            ("K1", "from 0 to T1"),
            ("K2", "from T1 to T2"),
            ("K3", "from T2 to rated torque"),
        )
    ),
    *(
        Quantity(key, "N·m", name, symbol, group="gear torque")
        for key, name, symbol in (
            ("T1_Nm", "Torque T1", "T_1"),
            ("T2_Nm", "Torque T2", "T_2"),
            ("rated_torque_Nm", "Rated torque", "T_N"),
        )
    ),
    Quantity(
        "lost_motion_arcsec",
        "arcsec",
        f"Lost motion, between ± {LOST_MOTION_TORQUE}",
        "θ_lm",
        decimals=1,
        short_name=f"lost motion, ± {LOST_MOTION_TORQUE}",
        group="gear",
    ),
    Quantity(
        "lost_motion_torque_Nm",
        "N·m",
        "Torque of the lost motion, each way",
        "T_lm",
        digits=3,
        group="gear",
    ),
    Quantity(
        "free_angle_arcsec",
        "arcsec",
        "Free angle (clearance both ways), not in K1",
        "θ_0",
        decimals=1,
        group="gear",
    ),
    Quantity(
        "teeth_in_contact",
        "",
        "Teeth in contact at rated torque",
        "z_c",
        kind="count",
        short_name="teeth in contact, rated torque",
        group="gear",
    ),
    Quantity(
        "preload_tooth_force_N",
        "N",
        "Largest tooth force without torque, where both flanks press",
        "F_0",
        digits=2,
    ),
    Quantity(
        "buckling_torque_Nm",
        "N·m",
        "Buckling torque of the flexspline's tube, estimate",
        "T_b",
        digits=2,
        group="gear",
    ),
    Quantity(
        "ratcheting_torque_Nm",
        "N·m",
        "Ratcheting torque, upper limit by loss of engagement",
        "T_r",
        digits=2,
        group="gear",
    ),
    *(
        Quantity(
            f"compliance_shares.{part}",
            "",
            f"Share of the {part} in the compliance at rated torque",
            decimals=3,
        )
        for part in ("flexspline", "shaft", "teeth", "bearing")
    ),
)
