"""A design and round results for it, written by hand; no solver is asked."""

from dataclasses import replace

from hand_made_curve import gear_curve

from flexspline.fea.types import MeshLevel, Stiffness, StressPeak
from flexspline.geometry.design import Design
from flexspline.pipeline.backlash import Backlash
from flexspline.pipeline.stiffnesses import Stiffnesses
from flexspline.results.report.content import ReportContent

STEEL = {"name": "34CrNiMo6", "youngs_modulus_GPa": 206.0, "poissons_ratio": 0.3}


def design(name="Hand-made cup", material="34CrNiMo6"):
    flexspline = {
        "kind": "cup", "inner_diameter_mm": 38.4, "wall_thickness_mm": 0.4,
        "ring_thickness_mm": 0.55, "length_mm": 30.0, "ring_width_mm": 8.0,
        "diaphragm_thickness_mm": 0.6, "boss_diameter_mm": 18.0, "boss_thickness_mm": 3.0,
    }  # fmt: skip
    segment = {"length_mm": 24.0, "outer_diameter_mm": 17.0}
    steel = {**STEEL, "name": material, "fatigue_limit_MPa": 500.0}
    gear = {
        "module_mm": 0.2, "teeth_flexspline": 200, "teeth_circular_spline": 202,
        "pressure_angle_deg": 20.0, "flank_clearance_um": 3.0,
    }  # fmt: skip
    return Design.model_validate(
        {
            "name": name,
            "flexspline": flexspline,
            "shaft": {"grip_length_mm": 10.0, "segment": [segment]},
            "material": {"flexspline": steel},
            "gear": gear,
            "bearing": {"radial_clearance_um": 12.0},
            "load": {"torque_Nm": 0.5},
        }
    )


def _levels(K, *sizes):
    return tuple(MeshLevel(1.0, n, 6 * n, K * (1 + 5 / n), K, 3e-13) for n in sizes)


K_B = Stiffness(
    31655.0, 31607.0, 31703.0, False, "solid", "1/12 of the part", "estimate of the error",
    _levels(31655.0, 1400, 4465),
)  # fmt: skip
K_E = Stiffness(
    35290.0, 35263.0, 35317.0, True, "axisymmetric", "body of revolution", "bounds from both sides",
    _levels(35290.0, 300, 900, 2600),
)  # fmt: skip
K_LOBES = replace(K_B, K_Nm_per_rad=24310.0, lower_Nm_per_rad=24250.0, upper_Nm_per_rad=24370.0)
BACKLASH = Backlash(
    shaft_arcsec=5.84,
    flexspline_arcsec=6.52,
    flank_clearance_arcsec=32.93,
    bearing_play_arcsec=39.31,
    total_arcsec=84.60,
    std_arcsec=12.92,
    std_by_source_arcsec={
        "youngs_modulus": 0.25, "flank_clearance": 10.98, "radial_clearance": 6.81,
    },
    play_beyond_limit=0.0,
    model_form_arcsec=5.8,
)  # fmt: skip


def content(**changes):
    """Report content; keyword arguments replace its fields, or those of its stiffnesses."""
    base = ReportContent(
        design=design(),
        version="0.1.0",
        stiffnesses=Stiffnesses({"K_b": K_B, "K_b_lobes": K_LOBES, "K_e": K_E}),
        backlash=BACKLASH,
        flexspline_peak=StressPeak(3.218, (9.0, 0.0, 0.6), "the boss's edge", 0.4, True, 2.9),
        wave_generator_peak=StressPeak(
            451.3, (19.2, 0.0, 21.6), "the seat's edges", 0.4, False, 400.0
        ),
        versions={"numpy": "2.0.0"},
        gear=gear_curve(23.2, 474.0, 108.0),
        stage_seconds={"mesh of the flexspline": 5.31},
    )
    solved = ("half_seat_peak", "full_seat_peak", "ring", "missing")
    of_stiffnesses = {name: changes.pop(name) for name in solved if name in changes}
    found = replace(changes.pop("stiffnesses", base.stiffnesses), **of_stiffnesses)
    return replace(base, stiffnesses=found, **changes)
