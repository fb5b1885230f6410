"""Von Mises stress of a part under the load torque."""

from __future__ import annotations

from pathlib import Path

from fea.types import SolidField
from results.renders.scene import shoot
from results.renders.sheet import INSET, MAIN, Sheet, write_sheet
from results.renders.shown import (
    Seen,
    below_view,
    cut_view,
    goes_beyond,
    peak_mark,
    stress_bar,
    stress_layers,
    stress_note,
)
from results.renders.surface import opening, skin
from results.renders.whole import whole_part


def write_torque_stress(path: Path, field: SolidField, part_name: str, torque_Nm: float) -> None:
    """Write the PNG: the part cut open, its reported peak marked.

    Parameters
    ----------
    field : the solution under `torque_Nm`.
    part_name : opens the title ("Flexspline", "Output shaft").
    """
    whole = whole_part(field.mesh, field.displacement, field.mises, "antisymmetric")
    cut = opening(field.mesh.sector_deg)
    main = Seen(whole.nodes, skin(whole, cut), cut_view(cut))
    inset = Seen(whole.nodes, skin(whole), below_view(cut))
    beyond = goes_beyond(field.peak, main.shown, whole.mises)
    write_sheet(
        path,
        shoot(stress_layers(main.points, whole.mises, main.shown, field.peak), main.view, MAIN),
        shoot(
            stress_layers(inset.points, whole.mises, inset.shown, field.peak, 1.6),
            inset.view,
            INSET,
        ),
        Sheet(
            title=f"{part_name}: stress under load torque",
            subtitle=f"von Mises stress, torque {torque_Nm:.4g} N·m; cut open, not deformed",
            inset_title="from below",
            note=stress_note(beyond),
            bar=stress_bar(field.peak, beyond),
            mark=peak_mark(field.peak, field.mesh.sector_deg, whole.nodes, main, inset),
        ),
    )
