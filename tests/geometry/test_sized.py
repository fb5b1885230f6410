"""A design for a catalogue's size: it loads, is as large as the catalogue says, and marks what it assumes."""

from __future__ import annotations

import re
import tomllib

import pytest
from typer.testing import CliRunner

from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from
from flexspline.geometry.sanity import warnings
from flexspline.geometry.shapes import KINDS
from flexspline.geometry.sized import sized_template, sized_values
from flexspline.geometry.template import template
from flexspline.results.cli import app


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("size", "ratio"), [(8, 30), (14, 50), (25, 100), (58, 160), (100, 320)])
def test_every_size_loads_without_a_warning(kind: str, size: float, ratio: int) -> None:
    text = sized_template(kind, size, ratio)
    for each in (text, re.sub(r"(?m)^# (?=\[|\w+ = )", "", text)):  # with its optional keys, too
        design = design_from(tomllib.loads(each))
        gear = design.gear
        ratio_found = gear.teeth_flexspline / (gear.teeth_circular_spline - gear.teeth_flexspline)
        assert ratio_found == ratio
        assert gear.module_mm * gear.teeth_flexspline / 2 == pytest.approx(1.27 * size, rel=1e-3)
        assert warnings(design) == ()


def test_the_pitch_radii_of_a_catalogue() -> None:
    """Schaeffler TPI 275: 17.78, 21.59, 25.40, 31.75 mm at sizes 14, 17, 20, 25."""
    for size, radius in ((14, 17.78), (17, 21.59), (20, 25.40), (25, 31.75)):
        gear = design_from(tomllib.loads(sized_template("cup", size, 100))).gear
        assert gear.module_mm * gear.teeth_flexspline / 2 == pytest.approx(radius, rel=1e-3)


def test_every_assumed_value_says_so_where_it_stands() -> None:
    text = sized_template("cup", 25, 100)
    _, why = sized_values("cup", 25, 100)
    marked = [line for line in text.splitlines() if "; assumed: " in line]
    assert len(marked) == len(why)
    lengths = re.findall(r"(?m)^\w+_mm = (?!0\.0 ).*$", text)
    assert lengths
    assert all("; assumed: " in line for line in lengths if not line.startswith("edge_length"))


@pytest.mark.parametrize(
    ("kind", "size", "ratio", "says"),
    [
        ("cup", 1.0, 100, "--size = 1.0: must be from 3 to 200"),
        ("cup", 25.0, 10, "--ratio = 10: must be from 30 to 320"),
        ("cup", 25.0, 0, "--ratio = 0: must be from 30 to 320"),
        ("pancake", 25.0, 100, 'must be "cup" or "hat"'),
    ],
)
def test_what_no_catalogue_has_is_refused(kind: str, size: float, ratio: int, says: str) -> None:
    with pytest.raises(DesignError, match=re.escape(says)):
        sized_template(kind, size, ratio)


def test_a_stated_rated_torque_is_the_design_s() -> None:
    """Size 25, ratio 100 of TPI 275: 87 N·m; 4 % of it is 3.48."""
    design = design_from(tomllib.loads(sized_template("cup", 25, 100, 87.0)))
    assert design.gear.rated_torque_Nm == 87.0
    assert design.load.torque_Nm == pytest.approx(3.48)
    assert design_from(tomllib.loads(sized_template("cup", 25, 100))).gear.rated_torque_Nm is None


def test_the_range_of_rated_torque_that_is_told_works() -> None:
    for wrong, end in ((1e-6, 0), (1e9, 1), (float("nan"), 0)):
        with pytest.raises(DesignError, match=r"--rated = .* must be from .* N·m") as fault:
            sized_template("cup", 17, 30, wrong)
        told = re.findall(r"from (\S+) to (\S+) N·m", str(fault.value))[0][end]
        design = design_from(tomllib.loads(sized_template("cup", 17, 30, float(told))))
        assert design.gear.rated_torque_Nm == float(told)


@pytest.mark.parametrize(("rated", "said"), [(31.0, 0), (95.0, 0), (97.0, 1), (2000.0, 1)])
def test_a_rated_torque_beyond_catalogues_is_told(rated: float, said: int) -> None:
    """Size 17: 21.59 mm; size 20, the strongest, has 52 N·m at 25.4 mm, so 3 · 32 N·m here (TPI 275)."""
    design = design_from(tomllib.loads(sized_template("cup", 17, 100, rated)))
    lines = [line for line in warnings(design) if "gear.rated_torque_Nm" in line]
    assert len(lines) == said
    assert all("some 32.2 N·m (Schaeffler TPI 275" in line for line in lines)


def test_init_says_it() -> None:
    words = ["init", "cup", "--size", "17", "--rated", "2000"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0
    assert "warning: gear.rated_torque_Nm = 2000 is 62" in done.stderr
    assert CliRunner().invoke(app, [*words[:-1], "31"]).stderr == ""


def test_a_file_whose_stress_exceeds_its_fatigue_limit_says_so() -> None:
    """On the wave generator, by `flexspline stiffness`: hats 718 MPa at ratio 100 and 479 at 150; cups 448 at
    100; the first hat 681 and the first cup 436; the limit is 500."""
    beyond = "above the fatigue limit"
    for kind, ratio, exceeds in (("hat", 100, True), ("hat", 150, False), ("cup", 100, False)):
        assert (beyond in sized_template(kind, 25, ratio)) is exceeds
    assert "above the fatigue limit" in template("hat")
    assert "above the fatigue limit" not in template("cup")
