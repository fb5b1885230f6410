"""Each rule for specimens: overrides, tolerances, sensitivities, verdicts, held-out specimens."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosed_file import diagnose_file
from example_files import EXAMPLES
from specimen_truth import EXAMPLE_FILE as DRAWN

from flexspline.geometry.keys import (
    lengths,
    value_at,
    with_values,
    without_holes,
)
from flexspline.geometry.load import design_from, load_design, read_toml
from flexspline.pipeline.cache import Cache
from flexspline.pipeline.diagnosis.diagnose import Diagnosis
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError
from flexspline.pipeline.diagnosis.measurement.record import Specimens
from flexspline.pipeline.diagnosis.prediction import prediction_of
from flexspline.pipeline.diagnosis.specimens.bench import Bench
from flexspline.pipeline.diagnosis.specimens.compliances import Compliances, compliances
from flexspline.pipeline.diagnosis.specimens.diagnose import diagnose_specimens
from flexspline.pipeline.diagnosis.specimens.tolerance import general_tolerance_mm
from flexspline.pipeline.diagnosis.structure import UnnamedForm
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress
from flexspline.results.diagnosis.summary import summary
from flexspline.results.diagnosis.tolerance_words import modulus_alone, only_because
from flexspline.results.diagnosis.words import free_words

EXAMPLE = EXAMPLES / "xb1-40.toml"
DESIGN = load_design(EXAMPLE)
LENGTH, WALL = "flexspline.length_mm", "flexspline.wall_thickness_mm"


@pytest.fixture(scope="module")
def bench(suite_cache: Path) -> Bench:
    context = AnalysisContext(DESIGN, Cache(suite_cache), Progress())
    given = Bench(context, 1.0, 1.0, False)
    return replace(
        given, K_b=1 / given.plain(DESIGN, "flexspline"), K_e=1 / given.plain(DESIGN, "shaft")
    )


@pytest.fixture(scope="module")
def fe(bench) -> Compliances:
    designs = [with_values(DESIGN, {k: float(v[i]) for k, v in DRAWN.items()}) for i in range(8)]
    return compliances(bench, designs, ("flexspline",) * 8)


def measured(K: np.ndarray, part: str | None = "flexspline", std: float | None = 0.01) -> Specimens:
    n = len(K)
    return Specimens(
        Path("made.csv"), tuple(f"S{i}" for i in range(n)), (part or "series",) * n, K,
        None if std is None else std * K, {k: v[:n] for k, v in DRAWN.items()}, np.arange(n) + 2,
        part is not None,
    )  # fmt: skip


def diagnosed(bench, K, **how):
    return diagnose_specimens(
        DESIGN, measured(K, **how), bench.K_b, bench.K_e, bench.context, False
    )


def looked_at(monkeypatch: pytest.MonkeyPatch, module: str, keys: set[str]) -> None:
    """No other dimensions are solved for there."""
    monkeypatch.setattr(
        f"flexspline.pipeline.diagnosis.specimens.{module}.lengths",
        lambda part: {k: v for k, v in lengths(part).items() if k in keys},
    )


def noisy(C: np.ndarray, seed: int) -> np.ndarray:
    return (1 + 0.01 * np.random.default_rng(seed).standard_normal(len(C))) / C


def test_general_tolerances() -> None:
    """ISO 2768-1, table 1, class m: 0.1 to 6 mm, 0.2 to 30, 0.3 to 120, 0.5 to 400; table 2 for radii."""
    sizes = [0.4, 3.0, 6.0, 6.1, 30.0, 38.4, 121.0]
    assert [general_tolerance_mm(s) for s in sizes] == [0.1, 0.1, 0.1, 0.2, 0.2, 0.3, 0.5]
    assert [general_tolerance_mm(s, radius=True) for s in (1.0, 4.0, 7.0)] == [0.2, 0.5, 1.0]


def test_keys_are_read_and_replaced() -> None:
    changed = with_values(
        DESIGN, {LENGTH: 33.0, "shaft.segment[1].length_mm": 25.0, "flexspline.bolt_count": 4.0}
    )
    assert changed.flexspline.length_mm == 33.0
    assert changed.shaft.segment[1].length_mm == 25.0
    assert changed.flexspline.bolt_count == 4
    assert (
        with_values(DESIGN, {"shaft.segment.1.length_mm": 25.0}).shaft.segment[1].length_mm == 25.0
    )
    assert value_at(changed, "shaft.segment[1].length_mm") == 25.0
    assert value_at(changed, "shaft.segment[7].length_mm") is None
    assert "flexspline.bolt_hole_diameter_mm" not in lengths(DESIGN.part("flexspline"))
    assert lengths(DESIGN.part("shaft"))["shaft.segment[0].outer_diameter_mm"] == 20.0
    assert not without_holes(DESIGN).flexspline.bolt_count


@pytest.mark.parametrize(
    ("column", "value", "says"),
    [("flexspline.lenght_mm", "30", "lenght_mm"), (WALL, "0.9", "wall_thickness_mm"),
     ("flexspline.wall.x", "1", "no such key"), ("shaft.segment[9].length_mm", "1", "no such key")],
)  # fmt: skip
def test_bad_overrides_name_file_line_and_reason(tmp_path, column, value, says) -> None:
    csv = tmp_path / "bad.csv"
    csv.write_text(
        f"# made\nspecimen,stiffness_Nm_per_rad,{LENGTH},{column}\n" if column != WALL
        else f"# made\nspecimen,stiffness_Nm_per_rad,{LENGTH},{WALL}\n"
    )  # fmt: skip
    with csv.open("a") as out:
        out.write(f"a,30000,30,{value}\nb,31000,31,{value}\nc,32000,32,{value}\n")
    with pytest.raises(MeasurementError) as caught:
        diagnose_file(DESIGN, csv, 3e4, 4e4)
    assert caught.value.line == 3
    assert says in str(caught.value)


def test_stiffness_of_a_long_tube_follows_its_formula(bench) -> None:
    """Tube 2πGR³t/L in series with the rest: 10 mm more add 10/(2πGR³t) (Bredt)."""
    longer = with_values(DESIGN, {LENGTH: 50.0})
    longest = with_values(DESIGN, {LENGTH: 60.0})
    added = bench.plain(longest, "flexspline") - bench.plain(longer, "flexspline")
    G, outer, inner = 206e3 / 2.6, 19.6, 19.2
    tube = 10 / (G * np.pi / 2 * (outer**4 - inner**4)) * 1e3  # mm N → N·m
    assert added == pytest.approx(tube, rel=0.02)  # two solves good to 0.1 % of five times as much


def test_given_stiffness_is_scaled(bench) -> None:
    half = replace(bench, K_b=bench.K_b / 2)
    longer = with_values(DESIGN, {LENGTH: 36.0})
    assert half.compliance(longer, "flexspline") == pytest.approx(
        2 * bench.compliance(longer, "flexspline")
    )


def test_sensitivity_is_fe_s_own(bench, fe) -> None:
    """The quadratic of ln C meets FE 0.15 mm off, beyond its steps, to 1.5 % of 18 to 30 %."""
    s = next(s for s in fe.sensitivities if s.key == WALL)
    assert s.tolerance_mm == 0.1
    for i in (0, 4, 6):
        there = with_values(fe.designs[i], {WALL: float(DRAWN[WALL][i]) - 0.15})
        change = np.log(bench.plain(there, "flexspline") / bench.plain(fe.designs[i], "flexspline"))
        assert s.log_change(-0.15)[i] == pytest.approx(change, abs=0.015)


def test_slopes_are_of_the_load_case_in_the_sum(bench) -> None:
    """A thicker ring hardly matters to an even load, and much to one at the lobes."""
    key, thickness = "flexspline.ring_thickness_mm", DESIGN.flexspline.ring_thickness_mm
    change = {}
    for case in ("uniform", "lobes"):
        here = DESIGN.changed({"solver.load_case": case})
        thicker = with_values(here, {key: 1.1 * thickness})
        change[case] = np.log(
            bench.as_in_sum(thicker, "flexspline") / bench.as_in_sum(here, "flexspline")
        )
        # as the compliance that is compared with rows changes, known to BENCH_LOBE_WIDTH at the lobes
        compared = np.log(
            bench.compliance(thicker, "flexspline") / bench.compliance(here, "flexspline")
        )
        assert change[case] == pytest.approx(compared, abs=0.005)
    assert change["lobes"] < 10 * change["uniform"] < 0


def test_young_s_modulus(bench, fe) -> None:
    outcome, analysis = diagnosed(bench, noisy(fe.flexspline / 0.85, 1))
    assert outcome.causes[0].id == "youngs_modulus"
    assert outcome.causes[0].magnitude == pytest.approx(
        -15, abs=3 * outcome.causes[0].magnitude_std
    )
    assert analysis.simulated == pytest.approx(1 / fe.flexspline)
    gain = outcome.gain
    assert gain.unit == "%"
    assert gain.rmse_before > 10
    assert gain.rmse_after < 2.5  # 1 % of noise in each held-out specimen, and the fit's own


def test_a_large_joint_is_named(bench, fe) -> None:
    outcome, _ = diagnosed(bench, noisy(fe.flexspline + 0.6 * fe.flexspline.mean(), 2))
    assert outcome.verdict == "named"
    cause = outcome.causes[0]
    assert cause.id == "series_compliance"
    assert cause.magnitude == pytest.approx(60, abs=3 * cause.magnitude_std)


def test_a_size_that_is_not_known_is_a_suspicion(bench, fe, monkeypatch) -> None:
    """The joint of the test above, were its size asked to be surer than it is."""
    K = noisy(fe.flexspline + 0.6 * fe.flexspline.mean(), 2)
    size = diagnosed(bench, K)[0].causes[0].deviations
    monkeypatch.setattr("flexspline.pipeline.diagnosis.decision.SIZE_KNOWN", size + 0.01)
    outcome, analysis = diagnosed(bench, K)
    assert outcome.verdict == "ambiguous"
    assert outcome.causes[0].id == "series_compliance"
    assert outcome.next_measurement.aim == "confirm"
    prediction = prediction_of(DESIGN, bench.K_b, bench.K_e)
    said = summary(Diagnosis(DESIGN, measured(K), prediction, outcome, specimens=analysis))
    assert "is suspected but not significant" in said


def test_lobes_and_a_joint_alike_are_ambiguous_and_the_next_specimen_is_computed(
    bench, fe, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of three dimensions, each looked at smaller and larger."""
    looked_at(monkeypatch, "next_measurement", {LENGTH, WALL, "flexspline.ring_width_mm"})
    outcome, _ = diagnosed(bench, noisy(fe.flexspline * (1 + fe.lobes_share), 3))
    assert outcome.verdict == "ambiguous"
    assert outcome.causes[0].id == "load_zone"
    assert "series_compliance" in outcome.causes[0].alternatives
    after = outcome.next_measurement
    assert after.vary.startswith("flexspline.")
    assert after.separation > 1


def test_a_wall_within_its_tolerance_is_no_finding(bench, fe) -> None:
    walls = [with_values(d, {WALL: d.flexspline.wall_thickness_mm - 0.06}) for d in fe.designs]
    K = noisy(np.array([bench.compliance(d, "flexspline") for d in walls]), 4)
    outcome, analysis = diagnosed(bench, K)
    assert outcome.verdict == "consistent"
    assert [t.sensitivity.key for t in analysis.chosen.terms] == [WALL]
    assert analysis.chosen.causes == ()
    # such a wall changes K by 15 %, seven of the modulus' stated deviations
    measurement = measured(K)
    said = summary(
        Diagnosis(
            DESIGN, measurement, prediction_of(DESIGN, bench.K_b, bench.K_e), outcome,
            specimens=analysis,
        )
    )  # fmt: skip
    assert (
        f"only because {WALL} may be off by ± 0.1 mm (general tolerance ISO 2768-m, assumed" in said
    )
    assert "with every dimension as drawn Young's modulus would have to differ by" in modulus_alone(
        analysis
    )
    assert free_words(outcome) == "modulus and one dimension within its tolerance fitted"


def test_a_modulus_within_its_uncertainty_is_no_finding(bench, fe) -> None:
    outcome, analysis = diagnosed(bench, noisy(fe.flexspline / 0.975, 5))
    assert outcome.verdict == "consistent"
    assert only_because(analysis) == modulus_alone(analysis) == ""
    assert not outcome.causes


def test_one_odd_specimen_is_unknown(bench, fe) -> None:
    K = noisy(fe.flexspline, 6)
    K[3] *= 0.8
    outcome, _ = diagnosed(bench, K)
    assert outcome.verdict == "unknown"
    assert outcome.unexplained[0].channel == "specimen"
    assert outcome.unexplained[0].structure == (UnnamedForm("one_specimen", 4),)


def test_a_drift_over_the_order_is_unknown(bench, fe) -> None:
    outcome, _ = diagnosed(bench, noisy(fe.flexspline, 7) * (1 + 0.1 * np.linspace(-1, 1, 8)))
    assert outcome.verdict == "unknown"
    (left,) = outcome.unexplained
    assert (left.channel, left.unit) == ("specimen_order", "%")
    assert left.rms == pytest.approx(
        6.5, rel=0.2
    )  # a line from −10 to 10 % has 10/√3, of 8 places 6.5


def test_two_specimens_are_too_few(bench, fe) -> None:
    outcome, analysis = diagnosed(bench, 0.7 / fe.flexspline[:2])
    assert outcome.verdict == "insufficient"
    assert analysis is None


def test_missing_part_is_decided_and_said(bench, fe, monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at(monkeypatch, "sensitivity", {WALL})
    _, alone = diagnosed(bench, 1 / fe.flexspline, part=None)
    assert set(alone.part) == {"flexspline"}
    series = 1 / (fe.flexspline + 1 / bench.K_e)
    _, both = diagnosed(bench, series, part=None)
    assert set(both.part) == {"series"}
    assert both.part_guessed_by == "stiffness"


def test_unstated_noise_is_found_from_scatter(bench, fe) -> None:
    outcome, analysis = diagnosed(bench, noisy(fe.flexspline, 8), std=None)
    assert outcome.verdict == "consistent"
    # eight specimens, grid steps of half: within a factor of two and a half of 1 %
    assert 0.004 < analysis.noise.mean() < 0.025


def test_relative_sensitivity_holds_with_bolt_holes(tmp_path) -> None:
    """Solved once with six holes: K's ratio between two drawings differs from the hole-free model's by
    less than 1 %, so a sensitivity's error is a small part of one specimen's 1 % of noise."""
    context = AnalysisContext(DESIGN, Cache(tmp_path), Progress())
    other = with_values(DESIGN, {WALL: 0.5, LENGTH: 34.0})
    full, plain = Bench(context, 1.0, 1.0, True), Bench(context, 1.0, 1.0, False)
    assert full.compliance(other, "flexspline") == pytest.approx(
        plain.compliance(other, "flexspline"), rel=0.01
    )


def test_shaft_has_its_own_keys_and_material(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = read_toml(EXAMPLE)
    tables["material"]["shaft"] = {
        "name": "42CrMo4",
        "youngs_modulus_GPa": 210.0,
        "poissons_ratio": 0.3,
    }
    design = design_from(tables)
    context = AnalysisContext(design, Cache(tmp_path), Progress())
    bench = Bench(context, 3e4, 4.3e4, False)
    key = "shaft.segment[1].outer_diameter_mm"
    looked_at(monkeypatch, "sensitivity", {key, "shaft.segment[0].outer_diameter_mm"})
    values = np.array([15.0, 17, 20])  # no fewer are diagnosed
    drawn = [
        with_values(design, {key: float(v), "shaft.segment[0].outer_diameter_mm": 22.0})
        for v in values
    ]
    C = np.array([bench.compliance(d, "shaft") for d in drawn])
    specimens = Specimens(
        Path("made.csv"), tuple("abc"), ("shaft",) * 3, 0.82 * noisy(C, 9), np.full(3, 400.0),
        {key: values, "shaft.segment[0].outer_diameter_mm": np.full(3, 22.0)}, np.arange(3) + 2,
    )  # fmt: skip
    outcome, analysis = diagnose_specimens(design, specimens, 3e4, 4.3e4, context, False)
    mine = {c.id for c in outcome.causes} | {a for c in outcome.causes for a in c.alternatives}
    assert "youngs_modulus" in mine
    assert "load_zone" not in mine
    assert analysis is not None


def test_sensitivities_of_many_specimens_follow_from_some(
    bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nine specimens, six solved, for a plane of three numbers: the others' slopes are within a tenth
    of FE's."""
    monkeypatch.setattr("flexspline.pipeline.diagnosis.specimens.sensitivity.MOST_SOLVED", 6)
    rng = np.random.default_rng(11)
    walls, long = rng.uniform(0.36, 0.52, 9).round(3), rng.uniform(24, 40, 9).round(2)
    designs = [with_values(DESIGN, {WALL: w, LENGTH: z}) for w, z in zip(walls, long, strict=True)]
    many = compliances(bench, designs, ("flexspline",) * 9, keys={WALL}, zones=False).sensitivities[
        0
    ]
    alone = compliances(bench, designs[1:4], ("flexspline",) * 3, keys={WALL}, zones=False)
    assert many.slope[1:4] == pytest.approx(alone.sensitivities[0].slope, rel=0.1)


def test_example_file() -> None:
    """Its walls were made 0.14 mm too thin. K_b and K_e of the example design by FE to three digits."""
    csv = EXAMPLES / "measured" / "xb1-40-specimens.csv"
    diagnosis = diagnose_file(DESIGN, csv, 3.14e4, 4.33e4)
    assert diagnosis.outcome.verdict == "named"
    cause = diagnosis.outcome.causes[0]
    assert cause.id == f"geometry:{WALL}"
    assert cause.magnitude == pytest.approx(-0.14, abs=3 * cause.magnitude_std)
    assert diagnosis.outcome.gain.rmse_after < diagnosis.outcome.gain.rmse_calibrated / 2
