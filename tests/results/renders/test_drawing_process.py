"""A crash, an error or a standstill while drawing costs that picture and nothing else."""

import os
import re
import time
from pathlib import Path

import failing_drawings
import numpy as np
import psutil
import pytest
from hand_made_tube import tube
from opengl import machine_without

from flexspline.results.renders.mesh_picture import write_mesh_picture
from flexspline.results.renders.opengl import ADVICE
from flexspline.results.renders.process import STOPPED, DrawingProcess, NotDrawnError


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2] / "helpers"))


def test_what_is_written_comes_back_and_arrays_keep_their_bits() -> None:
    values = np.array([0.1, -0.0, np.inf, 5e-324])
    with DrawingProcess() as process:
        assert process.draw(failing_drawings.good, "a hat") == b"drawn: a hat"
        assert process.draw(failing_drawings.array, values) == values.tobytes()


def test_a_view_is_drawn_of_the_arrays_of_its_picture() -> None:
    """And of no others: what was found for them serves again (`results.renders.remembered`)."""
    values = np.arange(3.0)
    with DrawingProcess() as process:
        first = process.draw(failing_drawings.whose, values)
        process.draw(failing_drawings.good, "the picture, smaller")
        assert process.draw(failing_drawings.whose, values) == first
        assert process.draw(failing_drawings.whose, values + 1) != first


def test_a_crash_is_one_line_and_other_pictures_still_come(tmp_path: Path) -> None:
    noted = tmp_path / "calls"
    with DrawingProcess() as process:
        for _ in range(2):
            with pytest.raises(NotDrawnError, match="SIGSEGV") as failure:
                process.draw(failing_drawings.crashing, str(noted))
            assert "\n" not in str(failure.value)
            assert process.draw(failing_drawings.good, "after") == b"drawn: after"
    assert noted.read_text() == "called\n"  # what crashed once is not tried again


def test_a_process_that_the_system_killed_is_no_fault_of_a_driver() -> None:
    with (
        DrawingProcess() as process,
        pytest.raises(NotDrawnError, match=r"SIGKILL.*memory") as failure,
    ):
        process.draw(failing_drawings.killed)
    assert "driver" not in str(failure.value)
    assert ADVICE not in str(failure.value)


def test_an_error_names_itself_and_ends_nothing() -> None:
    with DrawingProcess() as process:
        with pytest.raises(NotDrawnError, match=r"KeyError: .scalars.*another mesh") as failure:
            process.draw(failing_drawings.raising)
        assert "\n" not in str(failure.value)
        assert process.draw(failing_drawings.good, "after") == b"drawn: after"


def test_a_full_disk_is_a_line(monkeypatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device", "/tmp/arguments.npz")

    with DrawingProcess() as process:
        monkeypatch.setattr(Path, "write_bytes", full)
        with pytest.raises(NotDrawnError, match="No space left"):
            process.draw(failing_drawings.good, "a hat")


def test_a_file_that_comes_while_the_folder_goes_is_no_error(monkeypatch) -> None:
    """A thread that was about to draw when a command failed: the command's own reason is told, not this."""

    removed = []

    def filled(path: object, **_: object) -> None:
        removed.append(path)
        raise OSError(39, "Directory not empty", str(path))

    process = DrawingProcess()
    process.draw(failing_drawings.good, "a hat")
    with monkeypatch.context() as late:
        late.setattr(os, "rmdir", filled)
        process.__exit__()
    assert removed  # it came to that
    with pytest.raises(NotDrawnError, match=STOPPED):
        process.draw(failing_drawings.good, "a hat")


def test_a_picture_that_takes_too_long_is_given_up() -> None:
    began = time.monotonic()
    with DrawingProcess(slowest_s=1.0) as process, pytest.raises(NotDrawnError, match="within 1 s"):
        process.draw(failing_drawings.hanging)
    assert time.monotonic() - began < 60  # not the hour that the drawing would take


def test_the_process_and_its_files_are_gone_in_the_end(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    others = set(psutil.Process().children())
    with DrawingProcess() as process:
        process.draw(failing_drawings.good, "once")
        (child,) = set(psutil.Process().children()) - others
        assert list(tmp_path.iterdir())
    assert not child.is_running()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("drawn_before", [0, 1])
def test_what_is_asked_for_after_the_end_leaves_no_files(
    drawn_before: int, tmp_path, monkeypatch
) -> None:
    """A thread whose command has failed asks once more: a megabyte was left in each such command's wake."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with DrawingProcess() as process:
        for _ in range(drawn_before):
            process.draw(failing_drawings.good, "once")
    with pytest.raises(NotDrawnError, match="stopped"):
        process.draw(failing_drawings.good, "late")
    assert not list(tmp_path.iterdir())


def test_a_folder_with_modules_of_the_users_own_changes_nothing(tmp_path, monkeypatch) -> None:
    (tmp_path / "numpy.py").write_text("raise SystemExit('not this one')")
    monkeypatch.chdir(tmp_path)
    with DrawingProcess() as process:
        assert process.draw(failing_drawings.good, "here") == b"drawn: here"


def test_without_opengl_libraries_the_package_is_named(tmp_path, monkeypatch) -> None:
    for key, value in machine_without(tmp_path).items():
        monkeypatch.setenv(key, value)
    monkeypatch.delenv("DISPLAY", raising=False)
    with DrawingProcess() as process, pytest.raises(NotDrawnError, match="libegl1"):
        process.draw(write_mesh_picture, tube(30.0, 2), "Flexspline")


@pytest.mark.skipif(os.name != "posix", reason="an X server that does not answer is Unix's")
def test_a_real_crash_of_vtk_is_one_line(monkeypatch) -> None:
    """Told to draw on an X server that is not there, VTK ends its process."""
    monkeypatch.setenv("DISPLAY", ":4321")
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkXOpenGLRenderWindow")
    with DrawingProcess() as process, pytest.raises(NotDrawnError) as failure:
        process.draw(write_mesh_picture, tube(30.0, 2), "Flexspline")
    said = str(failure.value)
    assert "\n" not in said
    assert ADVICE in said
    # the same words at any time and place, so that many pictures make one warning
    assert not re.search(r"x1b|\d{4}-\d\d-\d\d|\[ *[0-9A-F]{8,}\]", said)
