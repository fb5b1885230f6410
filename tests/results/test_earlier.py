"""A smaller answer into the folder of a fuller one: no figure is lost."""

import json
from pathlib import Path

from example_files import EXAMPLES
from in_process import Ended, flexspline

EXAMPLE = EXAMPLES / "xb1-40.toml"
FULLER = {"design": "XB1-40 cup", "K_b_lobes_Nm_per_rad": 1.0, "gear": {}, "stage_s": {}, "x": 0}


def backlash(folder: Path, K_b: float) -> Ended:
    ended = flexspline(
        "backlash", EXAMPLE, "--Kb", K_b, "--Ke", 45000, "--out", folder, folder=folder
    )
    assert ended.status == 0
    return ended


def written(folder: Path, name: str) -> dict:
    return json.loads((folder / name).read_text(encoding="utf-8"))


def put(folder: Path, record: dict) -> None:
    (folder / "result.json").write_text(json.dumps(record), encoding="utf-8")


def test_the_fuller_answer_is_kept_and_said(tmp_path: Path) -> None:
    put(tmp_path, FULLER)
    ended = backlash(tmp_path, 31300)
    assert written(tmp_path, "result.previous.json") == FULLER
    assert "backlash_arcsec" in written(tmp_path, "result.json")
    (note,) = ended.said
    assert note.startswith("note: ")
    assert "result.previous.json" in note
    assert "K_b_lobes_Nm_per_rad" in note


def test_a_third_command_does_not_push_the_fullest_out(tmp_path: Path) -> None:
    put(tmp_path, FULLER)
    backlash(tmp_path, 31300)
    put(tmp_path, {k: FULLER[k] for k in ("design", "K_b_lobes_Nm_per_rad")})
    assert backlash(tmp_path, 31300).said == []
    assert written(tmp_path, "result.previous.json") == FULLER


def test_an_answer_with_all_figures_replaces_both(tmp_path: Path) -> None:
    backlash(tmp_path, 31300)
    was = written(tmp_path, "result.json")
    (tmp_path / "result.previous.json").write_text(json.dumps(was), encoding="utf-8")
    assert backlash(tmp_path, 20000).said == []
    assert written(tmp_path, "result.json") != was
    assert not (tmp_path / "result.previous.json").exists()


def test_what_is_no_record_is_replaced(tmp_path: Path) -> None:
    for text in ("[1, 2]", "{half of a rec", ""):
        (tmp_path / "result.json").write_text(text, encoding="utf-8")
        assert backlash(tmp_path, 31300).said == []
        assert "backlash_arcsec" in written(tmp_path, "result.json")
