"""A wrong study file is refused with one line: key, value, what works."""

from pathlib import Path
from typing import get_args

import pytest
from example_files import EXAMPLES
from study_bench import GRID, study_of

from flexspline.geometry.errors import DesignFileError
from flexspline.pipeline.study.database import StorageError
from flexspline.pipeline.study.figures import SIZES
from flexspline.pipeline.study.load import load_study
from flexspline.pipeline.study.schema import WORDS, Method
from flexspline.pipeline.study.study import StudyError


@pytest.mark.parametrize(
    ("old", "new", "key", "said"),
    [
        ('method = "grid"', 'method = "gird"', "run.method", '"grid", "sobol"'),
        ('method = "grid"', 'methode = "grid"', "run.methode", "did you mean method?"),
        ('method = "grid"', "workers = 0", "run.workers", "from 1 to 256"),
        ('method = "grid"', "evaluations = 1.5", "run.evaluations", "a whole number"),
        ('"K_b_Nm_per_rad"', '"K_b_Nm"', 'objective."K_b_Nm"', "did you mean K_b_Nm_per_rad?"),
        ('"maximize"', '"maximum"', 'objective.K_b_Nm_per_rad', '"minimize" or "maximize"'),
        ("wall_thickness_mm", "wall_thicknes_mm", "wall_thicknes_mm", "wall_thickness_mm?"),
        ("wall_thickness_mm", "wall_mm", "wall_mm", "wall_thickness_mm?"),
        ("min = 0.3", "min = 0.6", "wall_thickness_mm", "below max = 0.5"),
        ("min = 0.3", "min = -0.3", "wall_thickness_mm", "from 0.001 to 10000"),
        ("min = 0.3, ", "", "wall_thickness_mm", "min = …, max = …"),
        ("values = [25.0, 30.0]", "values = []", "length_mm", "1 to 10000 numbers"),
        ("values = [25.0, 30.0]", "value = [25.0]", "value", "did you mean values?"),
        ('[objective]\n"K_b_Nm_per_rad" = "maximize"\n[run]', "[run]\nverify = 1", "run.verify", "0"),
        ("xb1-40.toml", "no.toml", "design", "no such file"),
        ("[vary]", "[varied]", "varied", "did you mean vary?"),
        ('method = "grid"', "colour = 1", "run.colour", "[run] takes method, evaluations"),
        ('method = "grid"', 'seed = "1"', "run.seed", "not text; write 1 without quotation marks"),
        ('"flexspline.length_mm"', '"shaft.segment.0.length_mm"', "segment.0", "shaft.segment[0].length_mm?"),
    ],
)  # fmt: skip
def test_refused(old: str, new: str, key: str, said: str) -> None:
    assert old in GRID
    with pytest.raises(StudyError) as caught:
        study_of(GRID.replace(old, new))
    line = str(caught.value)
    assert key in line
    assert said in line
    assert "\n" not in line


def test_a_database_that_cannot_be_opened_is_named_without_its_password() -> None:
    line = str(StorageError("postgresql://me:secret@host:5432/studies", "no route to host"))
    assert "postgresql://me:***@host:5432/studies" in line
    assert "secret" not in line


def test_the_page_names_every_key_and_method() -> None:
    text = (EXAMPLES.parent / "docs" / "studies.md").read_text(encoding="utf-8")
    for key in WORDS:
        table, _, rest = key.partition(".")
        name = key if table == "run" else rest.rpartition(".")[2].strip("*") or table
        assert name in text, key
    for method in get_args(Method):
        assert f'`"{method}"`' in text
    for key in SIZES:
        assert f"`{key}`" in text


def test_an_empty_file_is_said_to_be_empty(tmp_path: Path) -> None:
    (tmp_path / "study.toml").touch()
    with pytest.raises(DesignFileError, match=r"the file is empty$"):
        load_study(tmp_path / "study.toml")
