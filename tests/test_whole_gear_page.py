"""docs/whole-gear.md against the program: some rows at every run, the whole page in the long one."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
sys.path.insert(0, str(DOCS))

import make_whole_gear as maker  # noqa: E402
import whole_gear_figures as figures  # noqa: E402
import whole_gear_ratcheting as ratcheting  # noqa: E402
import whole_gear_wall as wall  # noqa: E402

from flexspline.fea.gear.engagement import TORQUE_SHARE  # noqa: E402
from flexspline.geometry.sized import WALL_SHARE  # noqa: E402

TEXT = maker.PAGE.read_text(encoding="utf-8")
ROUNDING = 0.006
"""Of a ratio printed with two decimals, and of another machine's linear algebra."""


def rows_below(name: str) -> list[list[str]]:
    """Cells of a table of the page."""
    block = TEXT.split(maker.MARK.format(name))[1].lstrip("\n").split("\n\n")[0]
    return [[c.strip() for c in line.strip("|").split("|")] for line in block.splitlines()[2:]]


@pytest.mark.parametrize(
    "ratio", ["30", *(pytest.param(r, marks=pytest.mark.long) for r in ("50", ">50"))]
)
def test_size_25_of_the_catalogue_is_what_the_page_says(ratio: str) -> None:
    """Every size is the same gear but for its torques: one stands for all."""
    printed = next(r for r in rows_below("rows") if r[1] == "25" and r[2] == ratio)
    model, shaft = figures.sized(25, 100 if ratio == ">50" else int(ratio))
    given = {"30": (1.0, 1.3, 2.1), "50": (2.5, 3.4, 4.4), ">50": (3.1, 5.0, 5.7)}[ratio]  # 1e4
    for compliance, cells in ((0.0, printed[3:6]), (shaft, printed[7:10])):
        found = figures.slopes(figures.Chain(model, compliance, 0.0), (14.0, 48.0, 96.0))
        for K, catalogue, cell in zip(found, given, cells, strict=True):
            assert K / (1e4 * catalogue) == pytest.approx(float(cell), abs=ROUNDING)


def test_what_is_said_of_ratcheting_holds() -> None:
    """Each of 73 rows, and the words and the command's note that rest on them."""
    rows = rows_below("ratcheting rows")
    assert len(rows) == 73
    over = {(row[0], row[1]): float(row[4]) for row in rows}
    assert 4.5 < min(over.values()) < 5.5  # "a fifth (ratio 160)"
    assert 44 < max(over.values()) < 55  # "a fiftieth (ratio 30)"
    by = {row[0]: row for row in rows_below("ratcheting")}
    for ratio, row in by.items():
        # "within 2 to 7 % at each ratio, within a fifth over all"
        assert float(row[7]) <= (0.2 if ratio == "all" else 0.07)
    assert by["all"][4:6] == ["2.2", "1.5 to 3.1"]
    changed = [float(x) for row in rows_below("ratcheting sensitivity") for x in row[1:]]
    assert min(changed) > 0.5  # "no assumption carries it": that takes a fifth to a fiftieth


def test_a_row_of_ratcheting_is_what_the_page_says() -> None:
    (printed,) = (r for r in rows_below("ratcheting rows") if r[:2] == ["25", "30"])
    design = figures.sized_design(25, 30)
    model = figures.gear_model(design, design.part("flexspline"))
    found = ratcheting.limit(model, figures.rated_torque(design)[0])
    assert found == pytest.approx(float(printed[3]), rel=TORQUE_SHARE)


def test_every_row_of_the_catalogues_is_there() -> None:
    """23 with three K each and 4 with two, as the data files have them."""
    rows = rows_below("rows")
    assert len(rows) == 27
    assert sum(row[0] == "RT1-H" for row in rows) == 4
    met = sum(abs(float(row[9]) - 1) <= maker.AIM_K3 for row in rows)
    assert rows_below("aims")[0][2] == f"{met} of 27"


def test_the_words_beside_the_tables_hold() -> None:
    """Where the text draws a conclusion from a table."""
    by = {row[0]: [float(x) for x in row[2:]] for row in rows_below("classes")}
    assert all(1.8 < K < 2.4 for K in by["30"][:3])  # "about twice too stiff"
    others = {(row[1], row[2]): float(row[5]) for row in rows_below("rows") if row[2] != "30"}
    off = {key: K3 for key, K3 in others.items() if abs(K3 - 1) > 0.3}
    assert {size for size, _ in off} == {"14"}  # "the three rows of size 14 are 1.33 to 1.37"
    assert (min(off.values()), max(off.values())) == (1.33, 1.37)
    thin = {row[0]: row[1:] for row in rows_below("ratio 30")}[
        "ring and race × 0.5, pressure angle 30"
    ]
    size_25 = next(r for r in rows_below("rows") if r[1:3] == ["25", "30"])
    over = [float(k) * float(x) for k, x in zip(size_25[3:6], thin, strict=True)]
    assert over == pytest.approx([0.99, 1.64, 1.27], abs=0.02)
    terms = {(row[0], row[1].split(",")[0]): row[2:] for row in rows_below("terms")}
    for name in ("xb1-40", "hat-25"):
        of_sum, of_model = map(float, terms[name, "flexspline"])
        assert 4.4 < of_model / of_sum < 8  # "by a factor of 4.5 to 8"
        of_sum, of_model = map(float, terms[name, "bearing play"])
        assert 0.35 <= round(1 - of_model / of_sum, 2) <= 0.6  # "35 and 60 % less"
        flank = [float(x) for x in terms[name, "flank clearance"]]
        assert flank[0] == pytest.approx(flank[1], abs=0.2)  # "agree"
    shares = {row[0]: row[-1] for row in rows_below("published cup")}
    low, high = ([float(x) for x in re.findall(r"\d+", shares[T])] for T in ("20", "40"))
    assert low[0] < 73 < high[0]  # "near the published ones at 20 N·m"
    assert low[1] == pytest.approx(25, abs=3)


def test_a_page_without_its_tables_is_refused() -> None:
    with pytest.raises(ValueError, match="0 tables"):
        maker.written("nothing", {"rows": "| |"})
    again = maker.written(
        TEXT, {"aims": "\n".join(f"| {' | '.join(r)} |" for r in rows_below("aims"))}
    )
    assert again == TEXT


def assert_as_printed(made: str) -> None:
    """A page made again has the printed page's words, and its figures to the last digit or 1 %."""
    figures_of = [re.findall(r"\d+(?:\.\d+)?", text) for text in (made, TEXT)]
    words_of = [re.sub(r"\d+(?:\.\d+)?", "#", text) for text in (made, TEXT)]
    assert words_of[0] == words_of[1]
    for found, printed in zip(*figures_of, strict=True):
        decimals = len(printed.partition(".")[2])
        last_digit = 1.1 * 10.0**-decimals  # it may turn on another machine
        assert float(found) == pytest.approx(float(printed), rel=0.01, abs=last_digit)


def test_the_tables_beside_the_three_dimensional_model_are_of_its_record() -> None:
    assert_as_printed(maker.written(TEXT, maker.three_dimensional()))


@pytest.mark.long
def test_the_whole_page_is_what_the_program_finds() -> None:
    assert_as_printed(maker.written(TEXT, maker.tables()))


def test_the_wall_of_the_catalogue_is_what_the_first_design_takes() -> None:
    """Each of 15 sizes asks for 0.0117 to 0.0127 of the pitch radius; all rows are found again."""
    assert wall.catalogue_table().splitlines() == [
        "| " + " | ".join(row) + " |" for row in rows_below("wall")
    ]
    asked = [float(row[3]) for row in rows_below("wall")]
    assert len(asked) == 15
    assert min(asked) == 0.0117
    assert max(asked) == 0.0127
    assert min(asked) < WALL_SHARE < max(asked)
    assert wall.calculix_table().splitlines() == [
        "| " + " | ".join(row) + " |" for row in rows_below("tube")
    ]
