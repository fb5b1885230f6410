"""What the page shows of a finished job, in the words and figures of the reports."""

from __future__ import annotations

import json
from typing import Any

from flexspline.geometry.design import Design
from flexspline.results.diagnosis.channels import channel_words
from flexspline.results.diagnosis.words import title_of
from flexspline.results.numbers import figures_text
from flexspline.results.sentences import capital
from flexspline.results.studio.answer import message
from flexspline.results.studio.jobs import JobKind

Summary = dict[str, Any]


def job_summary(kind: JobKind, design: Design, printed: str) -> Summary:
    """From what the command printed with --json."""
    if kind == "step":
        return {}
    record = json.loads(printed)
    if kind == "diagnose":
        return {"diagnosis": _diagnosis(record)}
    solver = record["solver"]["parts"]
    return {
        "answer": message(design, record),
        "solved": [
            f"{part}: {s['elements']} elements, {s['symmetry']}" for part, s in solver.items()
        ],
        "wall_s": record["solver"]["wall_s"],
    }


def _diagnosis(record: Summary) -> Summary:
    after, gain = record.get("next_measurement"), record.get("gain")
    return {
        "verdict": record["heading"],
        "summary": capital(record["summary"]),
        "causes": [_cause(c) for c in record["causes"]],
        "unexplained": [
            f"{capital(channel_words(u['channel']))}: {u['what']}, {figures_text(u['rms'], 2)} "
            f"{u['unit']} rms"
            for u in record["unexplained"]
        ],
        "gain": None if gain is None else _gain(gain),
        "next": None if after is None else [capital(channel_words(after["vary"])), after["why"]],
        "notes": [capital(n) for n in record["notes"]],
    }


def _cause(entry: Summary) -> Summary:
    return {
        "title": capital(entry["title"]),
        "magnitude": entry["size"],
        "sure": entry["confidence"],
        "others": ", ".join(map(title_of, entry["alternatives"])),
    }


def _gain(gain: Summary) -> str:
    before, after = figures_text(gain["rmse_before"]), figures_text(gain["rmse_after"])
    floor = figures_text(gain["noise_floor"])
    return (
        f"Error on {gain['held_out']}, not used for fitting: {before} {gain['unit']} rms before, "
        f"{after} with the identified causes; the noise of these readings is {floor}."
    )
