"""FE makes the truth, the diagnosis must find it: right cause first, nothing named where nothing is.

Each set of specimens is tabulated by FE once; a diagnosis then takes 0.1 s.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from specimen_truth import AS_IN_THE_EXAMPLE, KEYS, MODULUS_STD, OFF_MM, Kind, batch, hidden

from flexspline.pipeline.cache import Cache
from flexspline.pipeline.diagnosis.measurement.record import Specimens
from flexspline.pipeline.diagnosis.outcome import NamedCause
from flexspline.pipeline.diagnosis.specimens.bench import Bench, row_designs
from flexspline.pipeline.diagnosis.specimens.compliances import compliances
from flexspline.pipeline.diagnosis.specimens.diagnose import explain
from flexspline.pipeline.diagnosis.specimens.evidence import SpecimenData
from flexspline.pipeline.parts import AnalysisContext
from flexspline.pipeline.progress import Progress

KINDS: tuple[Kind, ...] = ("clean", "softer", "joint", "lobes", "wall", "diaphragm")
ALL_ALIKE = {"joint", "lobes"}
"""The lobes add nearly the same compliance to every specimen whose ring is the same, as a joint does:
only the size tells them apart, so each must at least be named as the other's rival."""


@dataclass(frozen=True)
class Asked:
    """A set of specimens, how many answers of each kind of truth (of "clean" three times as many), and the
    dimensions that may be found wrong, None for all."""

    name: str
    seed: int
    each: int
    kinds: tuple[Kind, ...] = KINDS
    keys: tuple[str, ...] | None = None


@dataclass(frozen=True)
class Answer:
    kind: Kind
    cause: str | None
    size: float
    verdict: str
    found: tuple[NamedCause, ...]

    @property
    def right_first(self) -> bool:
        return (self.found[0].id if self.found else None) == self.cause


def answers(folder: Path, sets: list[Asked], rng: np.random.Generator) -> Iterator[Answer]:
    for asked in sets:
        name, seed = asked.name, asked.seed
        made = batch(name, seed)
        context = AnalysisContext(made.design, Cache(folder), Progress())
        plain = Bench(context, 1.0, 1.0, False)
        K_b, K_e = (1 / plain.plain(made.design, p) for p in ("flexspline", "shaft"))
        bench = Bench(context, K_b, K_e, False)
        first = hidden(name, seed, "clean", rng).specimens
        fe = compliances(bench, row_designs(made.design, first), first.part, asked.keys)
        for kind in asked.kinds:
            for _ in range(asked.each * (3 if kind == "clean" else 1)):
                h = hidden(name, seed, kind, rng)
                _, explained = explain(bench, data_of(fe, h.specimens), h.specimens, made.design)
                found = explained.decision
                yield Answer(kind, h.cause, h.size, found.verdict, found.causes)


def data_of(fe, specimens: Specimens) -> SpecimenData:
    K, std = specimens.stiffness_Nm_per_rad, specimens.stiffness_std_Nm_per_rad
    return SpecimenData(fe, -np.log(K), None if std is None else std / K, 0.005, MODULUS_STD)


def judged(found: list[Answer], capsys: pytest.CaptureFixture) -> None:
    by_kind = {k: [a for a in found if a.kind == k] for k in KINDS}
    wrong = [a for k in KINDS if k != "clean" for a in by_kind[k]]
    share = {k: float(np.mean([a.right_first for a in v])) for k, v in by_kind.items()}
    right = [a for a in wrong if a.right_first]
    error = np.array([a.found[0].magnitude - a.size for a in right])
    std = np.array([a.found[0].magnitude_std for a in right])
    relative = np.abs(error / np.array([a.size for a in right]))
    one, two = float(np.mean(np.abs(error) < std)), float(np.mean(np.abs(error) < 2 * std))
    with capsys.disabled():
        print(f"\nright first by kind: { {k: round(v, 3) for k, v in share.items()} }")
        print(
            f"magnitude: median error {np.median(relative):.3f}; within one std {one:.2f}, two {two:.2f}"
        )
        print("first cause where wrong:", Counter(
            (a.kind, a.found[0].id if a.found else a.verdict) for a in wrong if not a.right_first
        ))  # fmt: skip
    # shares that a user could rely on; measured: docs/end-points-and-specimens.md
    assert share["clean"] >= 0.95
    assert np.mean([a.right_first for a in wrong]) >= 0.90
    # twins are told apart by size alone; if not first, then said to be possible
    for a in wrong:
        if a.kind in ALL_ALIKE and not a.right_first and a.found:
            assert a.cause in {x for c in a.found for x in c.alternatives}
    # 1 % noise on eight stiffnesses: a tenth is the most that sizes may be off in the median
    assert np.median(relative) < 0.1
    # 68 and 95 % in expectation, two deviations of a share of so many answers below; 90 % and more of few
    assert 0.68 - 2 * np.sqrt(0.68 * 0.32 / len(right)) <= one <= max(0.90, 1 - 1 / len(right))
    assert two >= 0.95 - 2 * np.sqrt(0.95 * 0.05 / len(right))


CUPS = Asked("xb1-40", AS_IN_THE_EXAMPLE, 3)
"""What FE says of them is in the suite's cache."""
FEWER = replace(CUPS, each=1)
"""Each kind of truth once, nothing wrong three times: one wrong answer is a fifth or third of them, more than
is allowed."""
HATS = Asked("hat-25", 3, 1, ("clean", "softer", "wall"), (f"flexspline.{KEYS['wall']}",))
"""Only the wall is looked at."""


@pytest.mark.parametrize(
    "sets",
    [
        pytest.param([FEWER], id="cups"),
        pytest.param([CUPS], id="more cups", marks=pytest.mark.long),
        pytest.param([CUPS, HATS], id="cups and hats", marks=pytest.mark.long),
    ],
)
def test_right_cause_first(
    sets: list[Asked], suite_cache: Path, capsys: pytest.CaptureFixture
) -> None:
    judged(list(answers(suite_cache, sets, np.random.default_rng(20))), capsys)


@pytest.mark.long
def test_right_cause_first_with_fresh_seeds(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    seed = int(os.environ.get("HIDDEN_SEED", np.random.default_rng().integers(2**31)))
    with capsys.disabled():
        print(f"\nHIDDEN_SEED={seed}")
    rng = np.random.default_rng(seed)
    sets = [Asked(n, int(rng.integers(2**31)), 20) for n in ("xb1-40", "xb1-40", "hat-25")]
    judged(list(answers(tmp_path, sets, rng)), capsys)


def test_what_is_hidden_is_beyond_the_tolerance() -> None:
    """ISO 2768-m: 0.1 mm up to 6 mm, 0.3 mm up to 120 mm."""
    limits = {"wall": 0.1, "diaphragm": 0.1, "length": 0.3}
    for kind, offs in OFF_MM.items():
        assert min(map(abs, offs)) > limits[kind]
