"""What a study's database raises, in plain words."""

from __future__ import annotations

from pathlib import Path

import pytest
from optuna.samplers import RandomSampler
from sqlalchemy import create_engine, text

from flexspline.pipeline.study.database import open_trial_store
from flexspline.pipeline.study.storage_faults import TrialStoreError, storage_faults


def test_a_damaged_file_is_not_to_be_tried_again(tmp_path: Path) -> None:
    path = tmp_path / "study.db"
    path.write_bytes(b"no database, but longer than a header of one hundred bytes " * 4)
    with (
        pytest.raises(TrialStoreError) as caught,
        storage_faults(None),
        create_engine(f"sqlite:///{path}").connect() as there,  # may read the file at once
    ):
        there.execute(text("select 1 from studies"))
    assert "is damaged: move it away" in str(caught.value)
    assert "resume" not in str(caught.value)


@pytest.mark.parametrize("again", [False, True])
def test_what_was_deleted_is_not_said_to_be_kept(tmp_path: Path, again: bool) -> None:
    """The folder goes while a study runs; another process may have started over in it."""
    folder = tmp_path / "out"
    folder.mkdir()
    url = f"sqlite:///{folder / 'study.db'}"
    store = open_trial_store(url, "a", ["minimize"], RandomSampler(seed=1))
    folder.rename(tmp_path / "deleted")  # its file stays open, as one deleted would
    if again:
        folder.mkdir()
        (folder / "study.db").write_bytes(b"another study's")
    store.storage.engine.dispose()  # no old connection reads on
    with pytest.raises(TrialStoreError) as caught:
        store.note("one", 1)
    assert "was deleted" in str(caught.value)
    assert "start over" in str(caught.value)
    assert "kept" not in str(caught.value)
