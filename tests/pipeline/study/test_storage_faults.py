"""What a study's database raises, in plain words."""

from __future__ import annotations

from pathlib import Path

import pytest
from sqlalchemy import create_engine, text

from flexspline.pipeline.study.storage_faults import TrialStoreError, storage_faults


def test_a_damaged_file_is_not_to_be_tried_again(tmp_path: Path) -> None:
    path = tmp_path / "study.db"
    path.write_bytes(b"no database, but longer than a header of one hundred bytes " * 4)
    with (
        pytest.raises(TrialStoreError) as caught,
        storage_faults(),
        create_engine(f"sqlite:///{path}").connect() as there,  # may read the file at once
    ):
        there.execute(text("select 1 from studies"))
    assert "is damaged: move it away" in str(caught.value)
    assert "resume" not in str(caught.value)
