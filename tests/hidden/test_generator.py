"""The generator keeps the definitions of docs/contract.md: each magnitude on a law with a known answer."""

from __future__ import annotations

import numpy as np
import pytest

from hidden.ahead import Bearing, Bristles, MaxwellSlip, loop_width, output
from hidden.bench import Bench
from hidden.cases import CAUSES, diluted, draw_case
from hidden.clearance import lagged, per_cycle
from hidden.effect import Hidden, nothing
from hidden.elastic import chord_asymmetry, hardening_ratio
from hidden.foreign import KINDS
from hidden.friction import FAMILIES, closed_loop_width, slipping
from hidden.gear import altered, draw_gear, draw_rig
from hidden.micro_slip import Joint
from hidden.noise import Noise, draw_noise, sample, spread
from hidden.program import Plan, draw_program
from hidden.rig_faults import RIG_FAULTS
from hidden.slow import amounts, kelvin_chain, per_decade, per_hour, shift_per_rate
from hidden.truth import standing


def program(plan: Plan = Plan(), seed: int = 0, peak: float = 10.0):  # noqa: B008
    return draw_program(plan, peak, np.random.default_rng(seed))


def test_width_of_a_play_is_twice_its_limit() -> None:
    # a slider of limit r lags by r either way: −r unloading, +r loading, width 2r
    width = closed_loop_width(lambda q: slipping(q, np.array([0.07]))[:, 0])
    assert width == pytest.approx(0.14, abs=1e-12)  # exact for straight legs; rounding


@pytest.mark.parametrize("family", FAMILIES)
def test_friction_lags_and_its_loop_closes(family) -> None:
    respond, law = family(np.random.default_rng(3))
    assert closed_loop_width(respond) > 0, law
    leg = np.linspace(0, 1, 301)[1:]
    loop = np.concatenate([leg, 1 - leg, -leg, leg - 1])
    out = respond(np.concatenate([[0.0], np.tile(loop, 4)]))
    third, fourth = out[-2 * len(loop) : -len(loop)], out[-len(loop) :]
    assert np.abs(third - fourth).max() < 1e-3 * np.ptp(out)  # transient e-folds ≥ 10 times a loop


def test_friction_does_not_know_the_rate() -> None:
    respond, _ = FAMILIES[0](np.random.default_rng(4))
    fine = np.concatenate([np.linspace(0, 1, 801), np.linspace(1, -1, 1601)])
    coarse = np.concatenate([np.linspace(0, 1, 81), np.linspace(1, -1, 161)])
    # second-order steps of a fiftieth of the law's length: about 1e-3
    assert respond(coarse)[-1] == pytest.approx(respond(fine)[-1], abs=5e-3)


def test_hardening_ratio_of_segments() -> None:
    # K1 = 1/2 up to 0.4, K = 1 beyond: chords 0.5 and 1
    ratio = hardening_ratio(lambda q: q + np.minimum(q, 0.4))
    assert ratio == pytest.approx(2.0, rel=1e-12)


def test_asymmetry_of_two_springs() -> None:
    # twists 1/1.1 and 1/0.9: stiffness 1.1 and 0.9 about 1, 20 %
    assert chord_asymmetry(1 / 1.1, 1 / 0.9) == pytest.approx(20.0, rel=1e-12)


def test_logarithmic_creep_is_its_slope() -> None:
    # 0.03·log10(1 + t/t0) grows 3 % a decade, short of it by log10 of (1 + 10 t0/h)/(1 + t0/h)
    kernel = per_decade(lambda t: 0.03 * np.log10(1 + t / 1e-4), 100.0)
    assert kernel == pytest.approx(3.0, rel=1e-5)


def test_kelvin_chain_follows_a_logarithm() -> None:
    taus = np.geomspace(0.1, 3e3, 22)
    t = np.geomspace(1, 1e3, 50)
    weights = kelvin_chain(lambda x: np.log10(1 + x), taus, 1e3)
    # elements 1.6 times apart per e-fold follow a logarithm to half a percent of its rise
    assert (1 - np.exp(-t[:, None] / taus)) @ weights == pytest.approx(np.log10(1 + t), abs=0.015)
    assert (weights >= 0).all()


def test_lag_behind_a_ramp_is_its_time() -> None:
    time = np.sort(np.random.default_rng(0).uniform(0, 100, 400))
    behind = time - lagged(time, time, 2.0)
    assert behind[time > 50] == pytest.approx(2.0, abs=1e-9)  # e^-25 of the start is left


def test_rates_of_drift_wear_and_shift() -> None:
    assert per_hour(np.array([1.0, 2, 4]), np.array([0.0, 100, 1800])) == pytest.approx(6.0)
    assert per_cycle(np.array([2.0, 3, 10]), np.array([0.0, 1, 4])) == pytest.approx(2.0)
    rates = np.array([0.0, 1, 5])
    assert shift_per_rate(rates, 0.3 * rates) == pytest.approx(0.3)


def test_amounts_are_the_best_that_are_not_negative() -> None:
    columns = np.eye(3)[:, :2]
    assert amounts(columns, np.array([2.0, -1.0, 5.0])) == pytest.approx([2.0, 0.0], abs=1e-8)


@pytest.mark.parametrize("by_sample", [False, True])
def test_noise_has_the_covariance_it_claims(by_sample: bool) -> None:
    p = program(Plan(rows=(300, 301), cycles=(2, 2)))
    noise = Noise(
        0.5, 0.8, p.quickest / 20 if not by_sample else 4.0, by_sample, 1e-9, 0.0, 1e-9, 0.0
    )
    rng = np.random.default_rng(1)
    draws = np.array([sample(noise, p, rng)[0] for _ in range(4000)])
    claimed = spread(noise, p, 0.0, 0.0).covariance()
    found = draws.T @ draws / len(draws)
    # a sample covariance of n draws is off by sqrt((c_ii c_jj + c_ij²)/n) ≤ 0.02; 5.5 deviations
    assert np.abs(found - claimed).max() < 5.5 * np.sqrt(2 / 4000) * claimed.max()


def test_whitening_gives_the_dense_mahalanobis_length() -> None:
    p = program(Plan(rows=(300, 301), cycles=(2, 2)), seed=2)
    of = spread(Noise(0.3, 0.6, 2.0, False, 0.5, 0.0, 0.02, 0.0), p, 11.0, 70.0)
    x = np.random.default_rng(3).normal(size=(len(p.rows), 2))
    white = of.whitened(x)
    assert white.T @ white == pytest.approx(x.T @ np.linalg.solve(of.covariance(), x), rel=1e-8)


def test_outliers_are_isolated_and_far() -> None:
    p = program(Plan(rows=(3000, 3001)))
    noise = Noise(0.5, 0.0, 1.0, True, 1e-9, 0.005, 1e-9, 0.0)
    angle, out, _ = sample(noise, p, np.random.default_rng(5))
    assert 5 <= out.sum() <= 15
    assert np.diff(np.flatnonzero(out)).min() > 3
    assert np.abs(angle[out]).min() > (8 - 4) * 0.5  # 8 deviations, less 4 of the noise under it


def test_what_is_left_beside_the_truth_is_the_noise() -> None:
    """About the drawn gear and its effects the mean square of the residual is the claimed variance."""
    ratio = []
    for k in range(12):
        for unit in draw_case(11, k).units:
            width = 5 * np.hypot(unit.noise.torque, unit.noise.crossing)
            clear = np.minimum(np.abs(unit.torque), np.abs(unit.true_torque)) > width
            clear &= ~unit.outlier
            half = np.sign(unit.torque) / 2
            line = unit.gear.zero + unit.gear.compliance * unit.torque + unit.gear.gap * half
            rest = (unit.angle - line - sum(unit.effects))[clear]
            claimed = unit.spread.independent + unit.spread.coloured**2
            ratio.append(np.mean(rest**2) / claimed[clear].mean())
    # a coloured record has some 30 independent samples: 25 % each, 7 % on the mean of 12
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.14)
    assert max(ratio) < 2.5  # 6 deviations of the worst record: no effect is left out


@pytest.mark.parametrize(
    "number", [*range(4), *(pytest.param(n, marks=pytest.mark.long) for n in range(4, 8))]
)
def test_clean_records_stay_within_calibration(number: int) -> None:
    """K and gap as drawn cost less than 3 deviations each: no clean record is off by a finding."""
    case = draw_case(14, number, "clean")
    for unit in case.units:
        assert abs(unit.gear.gap - case.rig.gap) < 4 * case.rig.gap_std
        assert abs(unit.gear.compliance / case.rig.compliance - 1) < 0.065
        assert unit.effects == ()


def test_drawn_gears_have_the_stated_uncertainty() -> None:
    rng = np.random.default_rng(6)
    rig = draw_rig(rng)
    gears = [draw_gear(rig, rng) for _ in range(2000)]
    gap, compliance = (np.std([getattr(g, a) for g in gears]) for a in ("gap", "compliance"))
    # 2000 draws: 1.6 %; cutting at 3 deviations takes 1.3 %; the play's curvature a few more
    assert gap == pytest.approx(rig.gap_std, rel=0.08)
    assert compliance == pytest.approx(rig.compliance_std, rel=0.06)


def test_design_keeps_its_other_lines() -> None:
    text = "[a]\nx = 1.0  # why\n[b]\nx = 2.0\n"
    assert altered(text, {("b", "x"): 5}) == "[a]\nx = 1.0  # why\n[b]\nx = 5\n"
    with pytest.raises(KeyError):
        altered(text, {("c", "x"): 1})


@pytest.mark.parametrize(
    "cause",
    [*list(CAUSES)[::2], *(pytest.param(c, marks=pytest.mark.long) for c in list(CAUSES)[1::2])],
)
def test_a_single_stands_out_and_shows_in_the_file(cause: str) -> None:
    case = next(c for k in range(10) if (c := draw_case(12, k, "single", cause)).decidable)
    assert case.truth[0][0] == cause
    assert case.standing[0] >= 6
    assert np.isfinite(case.truth[0][1])
    assert any(np.abs(u.effects[0]).max() > u.noise.white / 3 for u in case.units)
    lines = [x for x in case.csv.splitlines() if not x.startswith("#")]
    assert {x.count(",") for x in lines} == {lines[0].count(",")}


@pytest.mark.parametrize(
    "kind",
    [
        *list(KINDS)[::2],
        *RIG_FAULTS,
        *(pytest.param(kind, marks=pytest.mark.long) for kind in list(KINDS)[1::2]),
    ],
)
def test_a_foreign_effect_is_not_absorbed(kind: str) -> None:
    case = draw_case(13, 0, "foreign", kind)
    assert standing(list(case.units), case.rig, (f"foreign:{kind}",)).of_two(0) >= 10
    assert case.truth == ()


def test_the_same_seed_gives_the_same_file() -> None:
    assert draw_case(3, 1).csv == draw_case(3, 1).csv
    assert draw_case(3, 1).csv != draw_case(3, 2).csv


def test_programmes_keep_their_promises() -> None:
    for seed in range(40):
        p = program(seed=seed)
        assert (np.diff(p.time) > 0).all()
        assert (np.diff(p.time[p.rows]) > 0).all()
        assert p.peak == pytest.approx(10.0)
        assert 250 <= len(p.rows) <= 3000
        noise = draw_noise(100.0, p, np.random.default_rng(seed))
        assert noise.by_sample or noise.memory <= p.quickest / 15


def test_friction_ahead_of_the_gap_is_a_play_and_moves_the_crossing() -> None:
    """Rigid until it slips: elasticity feels T − F, F = ± share; the gap is crossed at T = ± share."""
    share, gap = 0.1, 0.5
    up = np.linspace(-1, 1, 401)
    load = np.concatenate([np.linspace(0, 1, 201)[1:], up[::-1], up])
    x = output(MaxwellSlip(np.array([1e-6]), np.ones(1)), share, load, gap)
    falling, rising = x[200:601], x[601:]
    assert (
        falling[up[::-1] > -share + 1e-9].min() >= gap / 2 - 2e-6
    )  # slip takes 1e-6 of the wind-up
    assert rising[up < share - 1e-9].max() <= -gap / 2 + 2e-6
    assert rising[up > 0.5] == pytest.approx(up[up > 0.5] - share + gap / 2, abs=1e-5)


@pytest.mark.parametrize("bearing", [Bristles(0.005), MaxwellSlip(np.array([0.01]), np.ones(1))])
def test_width_of_friction_ahead_of_the_gap(bearing: Bearing) -> None:
    # far from its reach the bearing holds all its friction: twist 2·share at wind-up 1
    assert loop_width(bearing, 0.06) == pytest.approx(0.12, rel=1e-4)


@pytest.mark.parametrize(("chi", "capacity"), [(-0.7, 1.5), (-0.1, 1.5), (-0.5, 5.0)])
def test_a_joint_starts_at_its_first_stiffness_and_loses_energy_as_a_power(
    chi: float, capacity: float
) -> None:
    """T^(χ + 3) where few elements slip; source: Segalman, J. Appl. Mech. 72, 752 (2005), eq. 24."""
    assert Joint(chi, capacity).move(1e-6) == pytest.approx(1e-6, rel=1e-3)

    def loss(amplitude: float) -> float:
        leg = np.linspace(0, 1, 61)[1:]
        loop = amplitude * np.tile(np.concatenate([leg, 1 - leg, -leg, leg - 1]), 2)
        joint = Joint(chi, capacity)
        x = np.array([joint.move(q) for q in loop])
        return float(np.trapezoid(loop[-241:], x[-241:]))

    # at 5 and 10 % of the torque; the slip itself softens the joint, which adds up to 0.25 to the exponent
    assert np.log2(loss(0.1) / loss(0.05)) == pytest.approx(chi + 3 + 0.1, abs=0.15)


def test_a_share_of_the_twist_counts_the_spring_beside_it() -> None:
    """What swings by 12 % of the gear's compliance swings by 8 % of that and a spring's of half of it."""
    bench = Bench(Plan(), np.random.default_rng(1))
    own = bench.gears[0].compliance
    spring = Hidden("series_compliance", 50.0, "", lambda p, g: 0.5 * own * p.torque)
    swing = Hidden("position_stiffness", 12.0, "", nothing)
    highest, lowest = 1.5 * own + 0.12 * own, 1.5 * own - 0.12 * own
    seen = 100 * (highest - lowest) / (highest + lowest)
    assert diluted(swing, spring, bench).magnitude == pytest.approx(seen)
    assert diluted(spring, swing, bench) is spring
