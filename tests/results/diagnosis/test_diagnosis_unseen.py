"""A record that cannot show an effect says so."""

from dataclasses import replace

import numpy as np
import pytest
from histories import sweep

from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.results.diagnosis.unseen import unseen_notes

WHOLE = sweep()


def said(history, band: float = 0.05) -> str:
    return "; ".join(unseen_notes(history, band))


def test_a_whole_record_with_every_channel_has_nothing_to_say() -> None:
    assert unseen_notes(WHOLE, 0.05) == []


def test_half_a_cycle_shows_neither_gap_nor_direction() -> None:
    assert "in one direction only" in said(replace(WHOLE, torque_Nm=np.abs(WHOLE.torque_Nm)))
    assert "in one direction only" in said(replace(WHOLE, torque_Nm=-np.abs(WHOLE.torque_Nm)))


def test_a_single_ramp_shows_no_friction() -> None:
    ramp = replace(WHOLE, torque_Nm=np.linspace(-2, 2, len(WHOLE)))
    assert said(ramp).startswith("torque changes in one direction only")


def test_ramps_at_one_rate_do_not_tell_friction_from_a_lag() -> None:
    ramps = sweep(cycles=4, rows=120, hold=0)
    assert "the same rate" in said(ramps)
    assert ramps.time_s is not None
    quicker = np.where(ramps.cycle < 2, 1.0, 2.0)
    steps = np.diff(ramps.time_s, prepend=ramps.time_s[0])
    assert said(replace(ramps, time_s=np.cumsum(steps / quicker))) == ""


def test_channels_that_were_not_recorded_are_named() -> None:
    bare = replace(WHOLE, time_s=None, temperature_C=None, input_angle_deg=None)
    for name in ("time", "temperature", "wave generator angle"):
        assert f"{name} was not recorded" in said(bare)


@pytest.mark.parametrize(
    ("alternatives", "said"),
    [
        ((), "only the form of the loop distinguishes friction from a lag"),
        (("rate_dependence",), "a lag gives"),
    ],
)
def test_at_one_rate_the_note_says_what_the_verdict_says(
    alternatives: tuple[str, ...], said: str
) -> None:
    found = NamedCause("friction_hysteresis", 0.99, alternatives, 5.0, 0.1, "arcsec", 20.0, 2.0)
    ramps = sweep(cycles=4, rows=120, hold=0)
    (line,) = (n for n in unseen_notes(ramps, 0.05, (found,)) if "the same rate" in n)
    assert said in line
