"""Captions of the diagnosis figures."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.end_points.envelope import COVERED_WORDS

DRAWN_APART = """
        If a channel has few values, the branches are drawn apart: rising torque to the left of its value,
        falling torque to the right."""
"""Of every figure of residuals over channels: its points stand where no row was recorded."""
LOOP_WIDTH = """
        The size of the friction is the full width of its loop at zero torque. If friction
        acts before the gap, its band is less high: a soft wind-up then widens the loop near zero only."""
"""Of the causes' figure, where friction is one of them."""
CAPTIONS = {
    "measured_and_predicted": """
        Top: the measured angle and the simulated line. Bottom: their difference. A difference inside the
        band is within the design's stated uncertainty; this uncertainty does not explain a pattern in the
        difference.""",
    "residual_simulation": f"""
        Residual of the simulation against every recorded channel. Stiffness and gap are calibrated by up
        to two standard deviations of the design's uncertainty. If no cause is missing, all points lie in
        the grey band and the lines lie on zero. Different lines for rising and falling torque indicate
        friction or a lag; lines for T > 0 and T < 0 that drift apart indicate a gap or a stiffness that
        changes.
        {DRAWN_APART}""",
    "causes": """
        Each part of the extended model alone. Pale: the measurement minus all other parts. Dark: the
        model. The pale points should scatter evenly about the dark ones. {friction}""",
    "units": """
        Share of each cause in each unit, with two standard deviations. 1 is the mean of all units or, if
        each unit was diagnosed alone, the largest value; 0 is no effect.""",
    "held_out": """
        Prediction error on rows not used in the fit. If the last bar reaches the dashed line, the
        extended model predicts as accurately as the instrument measures.""",
    "residual_model": f"""
        Residual of the best model: the points should fill the grey band evenly and the lines stay near
        zero. A panel with a tested channel shows the result of the test. {DRAWN_APART}""",
    "residual_unknown": f"""
        Residual of the best model, including unnamed structure. The structure that no cause explains lies
        in: {{where}}. The figure of the model's parts shows this structure. {DRAWN_APART}""",
    "envelope": f"""
        The angle between −T and +T of each unit. The band contains {COVERED_WORDS} units that agree
        with the design. The design's clearances and stiffness do not explain a unit beyond the band. Of
        several torques, each unit's row shows the one of its largest deviation.""",
    "positions": """
        Positions of the two ends of each unit. In the symmetric simulation every mid position is zero. Each
        unit's angle zero is unknown, so a different mid position alone proves nothing.""",
    "rivals": """
        Top: the odds of the explanations; explanations with bars of similar length cannot be distinguished,
        and those below 0.5 % are not drawn.
        Bottom, if shown: how well a further measurement would distinguish them.""",
    "stiffness": """
        Measured stiffness of each specimen as deviation from the simulation. If the identified cause is
        right, the diamonds lie on the measured points.""",
    "dimensions": """
        The same deviation against every dimension that varies. A slope shows the dimension on which
        the fault depends. An equal shift of all points comes from the material, or from a part that the
        simulation leaves out.""",
    "held_out_specimens": """
        Each specimen predicted from all others. If the last bar reaches the dashed line, the
        explanation predicts as accurately as the rig measures.""",
}


def caption(name: str, **words: str) -> str:
    """The caption on one line, with its places filled."""
    return " ".join(CAPTIONS[name].format(**words).split())
