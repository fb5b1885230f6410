"""K_b when the torque enters at the two lobes, from one mesh whose error scale torsion has found."""

from __future__ import annotations

from fea.solid.cases import Model, lobes
from fea.solid.stress import energy_error
from fea.types import MeshLevel, Stiffness


def lobe_stiffness(model: Model, supported: bool, error_scale: float, symmetry: str) -> Stiffness:
    """K_b = T²/(2·strain energy) with its bounds.

    A given load stores too little energy on a mesh, so K_h is an upper bound here too; the recovery
    estimate times `error_scale` (see `fea.solid.stiffness`) is taken off it.
    """
    solved = lobes(model, supported)
    error = energy_error(model.mesh, solved.displacement, model.material).relative * error_scale
    upper = solved.K_energy
    level = MeshLevel(
        edge_length_mm=0.0,
        elements=len(model.mesh.cells),
        dofs=solved.dofs,
        K_Nm_per_rad=solved.K_energy,
        K_reaction_Nm_per_rad=solved.K_reaction,
        residual=solved.residual,
    )
    return Stiffness(
        K_Nm_per_rad=upper / (1 + error),
        lower_Nm_per_rad=upper / (1 + 2 * error),
        upper_Nm_per_rad=upper,
        model="solid",
        symmetry=symmetry,
        method=f"recovery estimate on the torsion mesh, unfolded, scaled by {error_scale:.2f}",
        levels=(level,),
        error_scale=error_scale,
    )
