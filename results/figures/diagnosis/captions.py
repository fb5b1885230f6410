"""What each figure shows, and what to see in it."""

from __future__ import annotations

from flexspline.pipeline.diagnosis.end_points.envelope import COVERED_WORDS

DRAWN_APART = """
        Where a channel has few values the branches are drawn apart: rising torque left of its value, falling
        torque right of it."""
"""Of every figure of residuals over channels: its points stand where no row was recorded."""
LOOP_WIDTH = """
        The size of the friction is the full width of its loop at zero torque. That is not the height of
        its band: a soft wind-up behind friction ahead of the gap widens the loop there alone."""
"""Of the causes' figure, where friction is one of them."""
CAPTIONS = {
    "measured_and_predicted": """
        Above, the measured angle on the simulated line; below, their difference. A difference inside
        the band is what the design's own uncertainty allows; a pattern in it is not.""",
    "residual_simulation": f"""
        Residual of the simulation, its stiffness and gap calibrated by up to two standard deviations of
        the design's uncertainty, against every recorded channel. With no cause missing, all points lie in
        the grey band and the lines on zero. Lines apart for rising and falling torque mean friction or
        lag; lines that drift apart for T > 0 and T < 0 mean a gap or a stiffness that changes.
        {DRAWN_APART}""",
    "causes": """
        Each part of the extended model alone. Pale: the measurement less all other parts. Dark: the
        model. The pale points should scatter evenly about the dark ones. {friction}""",
    "units": """
        How much of each cause each unit shows, with two standard deviations: 1 is the mean of all
        units or, where each was diagnosed by itself, the largest; 0 is nothing.""",
    "held_out": """
        Prediction error on rows not used in the fit. Where the last bar reaches the dashed line, the
        extended model predicts as well as the instrument reads.""",
    "residual_model": f"""
        Residual of the best model: the points should fill the grey band evenly and the lines stay near
        zero. A panel whose channel is tested says what the test finds. {DRAWN_APART}""",
    "residual_unknown": f"""
        Residual of the best model, unnamed structure included. The structure that no cause
        explains lies in: {{where}}; the figure of the model's parts shows its course. {DRAWN_APART}""",
    "envelope": f"""
        The angle between −T and +T of each unit. The band holds {COVERED_WORDS} units that are as the
        design says; the design's clearances and stiffness do not explain a unit
        beyond it.""",
    "positions": """
        Where the two ends of each unit lie. The symmetric simulation puts every middle on zero; the
        zero of an angle reading is free, so a middle elsewhere proves nothing alone.""",
    "rivals": """
        Above, how the odds are shared among the explanations; bars of similar length cannot be
        distinguished. Below, where shown, by how much a further measurement would separate
        them.""",
    "stiffness": """
        Measured stiffness of each specimen as deviation from the simulation. With the cause found,
        the diamonds lie on the measured points.""",
    "dimensions": """
        The same deviation against every dimension that varies. A slope says on what the fault
        depends; a shift of all points alike is the material's, or a part that the simulation leaves
        out.""",
    "held_out_specimens": """
        Each specimen predicted from all others. Where the last bar reaches the dashed line, the
        explanation predicts as well as the rig measures.""",
}


def caption(name: str, **words: str) -> str:
    """The caption on one line, with its places filled."""
    return " ".join(CAPTIONS[name].format(**words).split())
