"""Every chart of a run can be read, whatever gear it shows."""

from dataclasses import replace

import pytest
from hand_made_gear import K_B, K_E
from legibility import drawn_figures, faults
from unlike_gears import GEARS

from flexspline.fea.types import MeshLevel
from flexspline.results.figures.backlash_budget import write_budget
from flexspline.results.figures.convergence import write_convergence
from flexspline.results.figures.torque_angle import drawn_branch, write_torque_angle
from flexspline.results.style import new_figure


def settled(K, *dofs):
    """K with the given meshes, each two thirds nearer than the one before."""
    levels = tuple(
        MeshLevel(1.0, n // 6, n, K.K_Nm_per_rad * (1 + 0.02 / 3**i), K.K_Nm_per_rad, 3e-13)
        for i, n in enumerate(dofs)
    )
    return replace(K, levels=levels)


def scaled(K, factor):
    return replace(
        K,
        K_Nm_per_rad=factor * K.K_Nm_per_rad,
        lower_Nm_per_rad=factor * K.lower_Nm_per_rad,
        upper_Nm_per_rad=factor * K.upper_Nm_per_rad,
        levels=tuple(replace(m, K_Nm_per_rad=factor * m.K_Nm_per_rad) for m in K.levels),
    )


SETTLING = {
    "two and three meshes": (K_B, K_E),
    "one mesh and many": (settled(K_B, 8000), settled(K_E, *(300 * 2**i for i in range(11)))),
    "close meshes": (settled(K_B, 30000, 31000, 32000), settled(K_E, 100, 110, 5_000_000)),
    "huge": (scaled(K_B, 1e8), scaled(K_E, 3e9)),
    "tiny": (scaled(K_B, 1e-9), scaled(K_E, 1e-7)),
    "no error": (replace(K_B, lower_Nm_per_rad=31655.0, upper_Nm_per_rad=31655.0), K_E),
    "wide": (replace(K_B, lower_Nm_per_rad=100.0, upper_Nm_per_rad=9e5), K_E),
}  # fmt: skip


@pytest.mark.parametrize("name", GEARS)
@pytest.mark.parametrize("measured", [False, True], ids=["simulated", "extended"])
def test_budget(tmp_path, name, measured):
    gear = GEARS[name]
    if measured and gear.extended is None:
        pytest.skip("this gear has no measurement")
    with drawn_figures() as found:
        write_budget(tmp_path / "b.png", gear.backlash, gear.extended if measured else None)
    (figure,) = found
    assert faults(figure) == []


def test_figures_of_the_budget_stand_under_their_units(tmp_path):
    """The total's deviation is an angle, and no share."""
    gear = next(iter(GEARS.values()))
    with drawn_figures() as found:
        write_budget(tmp_path / "b.png", gear.backlash)
    texts = {t.get_text(): t.xy[0] if hasattr(t, "xy") else t.get_position()[0]
             for t in found[0].axes[0].texts}  # fmt: skip
    spread = next(text for text in texts if "±" in text)
    assert texts[spread] == texts["arcsec"]
    shares = [text for text in texts if texts[text] == texts["%"] and text not in ("", "%")]
    assert sum(map(int, shares)) == pytest.approx(100, abs=2)


@pytest.mark.parametrize("name", GEARS)
def test_torque_angle(tmp_path, name):
    gear = GEARS[name]
    with drawn_figures() as found:
        branch = drawn_branch(gear.angle_arcsec, gear.torque_Nm)
        write_torque_angle(tmp_path / "t.png", branch, gear.torque_Nm, gear.backlash)
    (figure,) = found
    assert faults(figure) == []


@pytest.mark.parametrize("name", SETTLING)
def test_convergence(tmp_path, name):
    K_b, K_e = SETTLING[name]
    with drawn_figures() as found:
        write_convergence(tmp_path / "c.png", {"K_b_Nm_per_rad": K_b, "K_e_Nm_per_rad": K_e})
    (figure,) = found
    assert faults(figure) == []


def words_on(axes):
    axes.text(0.5, 0.5, "one")
    axes.text(0.52, 0.5, "two")


def off_the_sheet(axes):
    axes.text(1.5, 0.5, "far out")


def line_through(axes):
    axes.text(0.5, 0.5, "crossed", va="center")
    axes.plot([0, 1], [0.5, 0.5])


def legend_on_bar(axes):
    axes.bar([0.5], [1.0], label="bar")
    axes.legend(loc="center")


def too_small(axes):
    axes.text(0.5, 0.5, "fine print", fontsize=4)


def on_dark(axes):
    axes.bar([0.5], [1.0], color="#123f66")
    axes.text(0.5, 0.5, "sunk")


@pytest.mark.parametrize(
    ("draw", "said"),
    [
        (words_on, "“one” lies over “two”"),
        (off_the_sheet, "“far out” leaves the sheet"),
        (line_through, "a line crosses “crossed”"),
        (legend_on_bar, "a legend covers a bar"),
        (too_small, "“fine print” is 4.0 pt"),
        (on_dark, "“sunk” lies on a dark bar"),
    ],
)
def test_the_check_finds(draw, said):
    figure = new_figure(4.0, 3.0)
    draw(figure.add_axes((0.2, 0.2, 0.6, 0.6), xlim=(0, 1), ylim=(0, 1)))
    assert said in faults(figure)


def test_the_check_leaves_a_plain_chart_alone():
    figure = new_figure(4.0, 3.0)
    axes = figure.add_axes((0.2, 0.2, 0.6, 0.6))
    axes.plot([0, 1], [0, 1], label="line")
    axes.legend(loc="upper left")
    axes.set_title("A title")
    axes.text(0.6, 0.3, "turned", rotation=40)
    axes.text(0.72, 0.3, "turned", rotation=40)  # their frames meet, the words do not
    assert faults(figure) == []
