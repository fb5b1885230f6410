"""Which input of the whole gear explains how a sweep differs from its curve: record and sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexspline.pipeline.diagnosis.whole_gear.fitted_input import FittedInput
    from flexspline.pipeline.diagnosis.whole_gear.identification import GearIdentification
    from flexspline.pipeline.diagnosis.whole_gear.inputs import GearInput
    from flexspline.pipeline.diagnosis.whole_gear.pairs import FittedPair


def gear_inputs_record(identification: GearIdentification) -> dict[str, Any]:
    """The keys of docs/contract.md; a value that was not determined is absent."""
    record: dict[str, Any] = {
        "outcome": identification.outcome,
        "remainder_arcsec": identification.remainder_arcsec,
        "chi_square": identification.chi_square,
        "places": identification.places,
        "fitted": [
            {**_input_record(one, one.value, one.std), "chi_square": one.chi_square}
            for one in identification.fitted
        ],
    }
    if identification.outcome == "named":
        record |= {"named": identification.fitted[0].key, "rivals": list(identification.rivals)}
    if identification.pairs:
        record["pairs"] = [
            {
                "inputs": [
                    _input_record(one, value, std)
                    for one, value, std in zip(pair.inputs, pair.values, pair.stds, strict=True)
                ],
                "chi_square": pair.chi_square,
            }
            for pair in identification.pairs
        ]
    if identification.left_arcsec is not None:
        record |= {
            "rmse_before": identification.before_arcsec,
            "rmse_after": identification.left_arcsec,
        }
    if identification.apart is not None:
        record["told_apart_at_Nm"] = identification.apart.torque_Nm
        record["told_apart_by_arcsec"] = identification.apart.difference_arcsec
    return record


def _input_record(one: FittedInput | GearInput, value: float, std: float) -> dict[str, Any]:
    return {
        "key": one.key, "unit": one.unit, "nominal": one.nominal, "value": value, "value_std": std,
    }  # fmt: skip


def gear_inputs_notes(identification: GearIdentification) -> tuple[str, ...]:
    """One sentence a finding."""
    if identification.outcome == "consistent":
        return (
            "the gear's curve fits the middle of the loop: the difference is "
            f"{identification.remainder_arcsec:.2g} arcsec rms at {identification.places} torques, not more "
            "than the scatter of the readings",
        )
    if identification.outcome == "unknown":
        return (
            "no single input and no pair of inputs of the gear explains the difference of "
            f"{identification.remainder_arcsec:.3g} arcsec rms between its curve and the readings at "
            f"{identification.places} torques" + "".join(_nearest(identification)),
        )
    if identification.outcome == "pair":
        first, *more = identification.pairs
        sentences = [
            "no single input of the gear explains the difference from its curve; two inputs together do: "
            f"{_both(first)}{_gain(identification)}"
        ]
        if more:
            sentences.append(
                f"other pairs fit equally well: {'; or '.join(_both(pair) for pair in more)}; measure one "
                "of these inputs directly"
            )
        return tuple(sentences)
    best = identification.fitted[0]
    sentences = [
        f"{_value(best)} explains the difference from the gear's curve, with all other inputs as drawn"
        f"{_gain(identification)}"
    ]
    if identification.rivals:
        others = ", ".join(
            _value(one) for one in identification.fitted if one.key in identification.rivals
        )
        sentences.append(
            f"other inputs fit as well as {best.key}: {others}; {_next(identification)}"
        )
    return tuple(sentences)


def _nearest(identification: GearIdentification) -> Iterator[str]:
    """Of the inputs that move the curve, if any does."""
    for best in identification.fitted[:1]:
        yield (
            f"; the best fit is {best.key} = {best.value:.3g} {best.unit}; with it the curve still deviates "
            f"from the readings by {_deviations_off(best, identification.places):.2g} standard deviations "
            "(root mean square)"
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


def _gain(identification: GearIdentification) -> str:
    if identification.left_arcsec is None:
        return f", {identification.remainder_arcsec:.3g} arcsec rms"
    return (
        f": {identification.before_arcsec:.3g} arcsec rms before, {identification.left_arcsec:.2g} after, on "
        "cycles that were not fitted"
    )


def _next(identification: GearIdentification) -> str:
    if identification.apart is None:
        return (
            "no torque up to twice the largest measured torque, and within the rated torque, distinguishes "
            "them; measure one of these inputs directly"
        )
    return (
        f"at {identification.apart.torque_Nm:.3g} N·m they differ by "
        f"{identification.apart.difference_arcsec:.2g} arcsec, so measure at this torque"
    )
