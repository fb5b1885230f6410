"""Ten gears that have little in common, for whatever must look well with any of them."""

from dataclasses import dataclass, field

from hand_made_gear import design

from flexspline.geometry.design import Design
from flexspline.pipeline.backlash import Backlash, angle_rad, backlash
from flexspline.pipeline.diagnosis.model.extended_backlash import ExtendedBacklash

STATED = {"youngs_modulus_pct": 2.0, "flank_clearance_um": 1.0, "radial_clearance_um": 2.5}


@dataclass(frozen=True)
class Gear:
    """A design with the stiffness of its parts [N·m/rad], and what a measurement added [arcsec]."""

    K_b: float = 31655.0
    K_e: float = 35290.0
    torque_Nm: float = 0.5
    flank_um: float = 3.0
    play_um: float = 12.0
    uncertainty: dict = field(default_factory=lambda: dict(STATED))
    name: str = "Hand-made cup"
    added: dict = field(default_factory=dict)

    @property
    def design(self) -> Design:
        base = design(name=self.name, material=self.name).model_dump(exclude_unset=True)
        base["gear"]["flank_clearance_um"] = self.flank_um
        base["bearing"] = {
            "radial_clearance_um": self.play_um,
            "bearing_play_model": "small_displacement",
        }
        base["load"]["torque_Nm"] = self.torque_Nm
        return Design.model_validate(base | {"uncertainty": self.uncertainty})

    @property
    def backlash(self) -> Backlash:
        return backlash(self.design, self.K_b, self.K_e)

    @property
    def extended(self) -> ExtendedBacklash | None:
        if not self.added:
            return None
        return ExtendedBacklash(self.backlash, 3.1, self.added)

    def angle_arcsec(self, torque_Nm):
        return angle_rad(self.design, torque_Nm, self.K_b, self.K_e) * 206264.8


GEARS = {
    "cup": Gear(),
    # wind-up: shaft 12.0, flexspline 112.8 of 158.9 arcsec
    "hat": Gear(9875.0, 92800.0, torque_Nm=2.7, flank_um=2.0, play_um=3.23, uncertainty={}),
    "long names": Gear(
        name="A design whose name goes on and on, " * 5,
        added={"stiffness_hardening_of_the_flexspline_and_its_seat": 4.0, "rate_dependence": 1.5},
    ),
    "huge": Gear(K_b=40.0, K_e=55.0, torque_Nm=5000.0),  # some ten million arcsec
    "tiny": Gear(K_b=3e7, K_e=4e7, torque_Nm=1e-4, flank_um=1e-3, play_um=2e-3),
    "one term": Gear(K_b=3e7, K_e=4e7, play_um=400.0, flank_um=0.0),
    "first term": Gear(K_b=3e7, K_e=900.0, play_um=0.5, flank_um=0.1),
    "negative terms": Gear(added={"friction_hysteresis": -40.0, "creep": -120.0, "wear": 55.0}),
    "equal terms": Gear(K_b=6250.0, K_e=6250.0, flank_um=3.0, play_um=8.77),
    "no uncertainty": Gear(uncertainty={}),
    "one source": Gear(uncertainty={"flank_clearance_um": 1.0}),
    "doubtful": Gear(uncertainty={"flank_clearance_um": 60.0, "radial_clearance_um": 30.0}),
    "other letters": Gear(name="Wellgetriebe Größe 40 – Ω, π and ″", added={"série": 2.0}),
}
