"""Von Mises stress of a part under the load torque."""

from __future__ import annotations

from pathlib import Path

from flexspline.fea.solid.whole import WholePart, whole_part
from flexspline.fea.types import SolidField
from flexspline.results.renders.picture_elements import (
    Seen,
    below_view,
    cut_view,
    goes_beyond,
    peak_mark,
    stress_bar,
    stress_layers,
    stress_note,
)
from flexspline.results.renders.remembered import remembered
from flexspline.results.renders.scene import shoot
from flexspline.results.renders.sheet import INSET, MAIN, Sheet, write_sheet
from flexspline.results.renders.surface import opening, skin
from flexspline.results.renders.turntable import Drawn, turning


def write_torque_stress(path: Path, field: SolidField, part_name: str, torque_Nm: float) -> None:
    """Write the PNG: the part cut open, its reported peak marked.

    Parameters
    ----------
    field : the solution under `torque_Nm`.
    part_name : opens the title ("Flexspline", "Output shaft").
    """
    whole, main, inset = _seen(field)
    write_sheet(
        path,
        shoot(stress_layers(main.points, whole.mises, main.shown, field.peak), main.view, MAIN),
        shoot(
            stress_layers(inset.points, whole.mises, inset.shown, field.peak, 1.6),
            inset.view,
            INSET,
        ),
        _sheet(field, whole, main, inset, part_name, torque_Nm),
    )


def turning_torque_stress(field: SolidField, part_name: str, torque_Nm: float) -> bytes:
    """The same as a view that turns in a browser (`results.renders.turntable`)."""
    whole, main, inset = _seen(field)
    drawn = Drawn(whole.nodes, whole.mises, main.shown, main.view, field.peak)
    return turning(drawn, _sheet(field, whole, main, inset, part_name, torque_Nm))


def write_turning_torque_stress(
    path: Path, field: SolidField, part_name: str, torque_Nm: float
) -> None:
    """Write that view."""
    path.write_bytes(turning_torque_stress(field, part_name, torque_Nm))


@remembered(1)
def _seen(field: SolidField) -> tuple[WholePart, Seen, Seen]:
    whole = whole_part(field.mesh, field.displacement, field.mises, "antisymmetric")
    cut = opening(field.mesh.sector_deg)
    return (
        whole,
        Seen(whole.nodes, skin(whole, cut), cut_view(cut)),
        Seen(whole.nodes, skin(whole), below_view(cut)),
    )


@remembered(1)
def _sheet(
    field: SolidField, whole: WholePart, main: Seen, inset: Seen, part_name: str, torque_Nm: float
) -> Sheet:
    beyond = goes_beyond(field.peak, main.shown, whole.mises)
    return Sheet(
        title=f"{part_name}: stress under load torque",
        subtitle=f"von Mises stress, torque {torque_Nm:.4g} N·m; cut open, not deformed",
        inset_title="from below",
        note=stress_note(field.peak, beyond),
        bar=stress_bar(field.peak, beyond),
        mark=peak_mark(field.peak, field.mesh.sector_deg, whole.nodes, main, inset),
    )
