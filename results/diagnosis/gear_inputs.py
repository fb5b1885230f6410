"""Which input of the whole gear explains how a sweep differs from its curve: record and sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexspline.pipeline.diagnosis.whole_gear.fitted_input import FittedInput
    from flexspline.pipeline.diagnosis.whole_gear.identification import GearIdentification
    from flexspline.pipeline.diagnosis.whole_gear.pairs import FittedPair


def gear_inputs_record(found: GearIdentification) -> dict[str, Any]:
    """As in docs/contract.md; what was not found is absent."""
    record: dict[str, Any] = {
        "outcome": found.outcome,
        "remainder_arcsec": found.remainder_arcsec,
        "chi_square": found.chi_square,
        "places": found.places,
        "fitted": [
            {
                "key": one.key, "unit": one.unit, "nominal": one.nominal, "value": one.value,
                "value_std": one.std, "chi_square": one.chi_square,
            }
            for one in found.fitted
        ],
    }  # fmt: skip
    if found.outcome == "named":
        record |= {"named": found.fitted[0].key, "rivals": list(found.rivals)}
    if found.pairs:
        record["pairs"] = [
            {
                "inputs": [
                    {
                        "key": one.key,
                        "unit": one.unit,
                        "nominal": one.nominal,
                        "value": value,
                        "value_std": std,
                    }
                    for one, value, std in zip(pair.inputs, pair.values, pair.stds, strict=True)
                ],
                "chi_square": pair.chi_square,
            }
            for pair in found.pairs
        ]
    if found.left_arcsec is not None:
        record |= {"rmse_before": found.before_arcsec, "rmse_after": found.left_arcsec}
    if found.apart is not None:
        record["told_apart_at_Nm"] = found.apart.torque_Nm
        record["told_apart_by_arcsec"] = found.apart.difference_arcsec
    return record


def gear_inputs_notes(found: GearIdentification) -> tuple[str, ...]:
    """One sentence a finding."""
    if found.outcome == "consistent":
        return (
            f"the gear's curve fits the middle of the loop: {found.remainder_arcsec:.2g} arcsec rms at "
            f"{found.places} torques, no more than its readings scatter",
        )
    if found.outcome == "unknown":
        return (
            f"no single input and no pair of inputs of the gear explains the {found.remainder_arcsec:.3g} "
            f"arcsec rms between its curve and the readings at {found.places} torques"
            + "".join(_nearest(found)),
        )
    if found.outcome == "pair":
        first, *more = found.pairs
        said = [
            "no single input of the gear explains the difference from its curve; two together do: "
            f"{_both(first)}{_gain(found)}"
        ]
        if more:
            said.append(
                f"other pairs fit as well: {'; or '.join(_both(pair) for pair in more)}; measure one "
                "of these inputs directly"
            )
        return tuple(said)
    best = found.fitted[0]
    said = [
        f"{_value(best)} explains the difference from the gear's curve, with all other inputs as drawn"
        f"{_gain(found)}"
    ]
    if found.rivals:
        others = ", ".join(_value(one) for one in found.fitted if one.key in found.rivals)
        said.append(f"others fit as well as {best.key}: {others}; {_next(found)}")
    return tuple(said)


def _nearest(found: GearIdentification) -> Iterator[str]:
    """Of the inputs that move the curve, if any does."""
    for best in found.fitted[:1]:
        yield (
            f"; the nearest is {best.key} = {best.value:.3g} {best.unit}: the curve still deviates from the "
            f"readings by {_deviations_off(best, found.places):.2g} standard deviations (root mean square)"
        )


def _deviations_off(one: FittedInput, places: int) -> float:
    """Root mean square over the torques, one of which the input is fitted to; 1 is what scatter leaves."""
    return math.sqrt(one.chi_square / (places - 1))


def _both(pair: FittedPair) -> str:
    return " and ".join(
        f"{one.key} = {value:.4g} ± {std:.2g} {one.unit} (nominal {one.nominal:.4g})"
        for one, value, std in zip(pair.inputs, pair.values, pair.stds, strict=True)
    )


def _value(one: FittedInput) -> str:
    limit = ", the limit of what is possible" if one.at_limit else ""
    return (
        f"{one.key} = {one.value:.4g} ± {one.std:.2g} {one.unit} (nominal {one.nominal:.4g}{limit})"
    )


def _gain(found: GearIdentification) -> str:
    if found.left_arcsec is None:
        return f", {found.remainder_arcsec:.3g} arcsec rms"
    return (
        f": {found.before_arcsec:.3g} arcsec rms before, {found.left_arcsec:.2g} after, on cycles that were "
        "not fitted"
    )


def _next(found: GearIdentification) -> str:
    if found.apart is None:
        return (
            "no torque up to twice the largest, and within the rated torque, distinguishes them, so measure "
            "one of them directly"
        )
    return (
        f"at {found.apart.torque_Nm:.3g} N·m they differ by {found.apart.difference_arcsec:.2g} arcsec, "
        "so measure there"
    )
