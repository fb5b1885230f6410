"""Terminals and files without our letters, streams that are closed, full or listened to no more."""

from __future__ import annotations

import ast
import json
import os
import pty
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest
from bases import CUP, GIVEN, head, plain
from shell import command, environment

from flexspline.geometry.load import design_from, load_design
from flexspline.geometry.template import template
from flexspline.results.plain_letters import STAND_INS
from flexspline.results.plain_letters import plain as plain_letters

ONE_AFTER_ANOTHER = """
import json, os, sys
from flexspline.results.entry import main

for words in json.loads(sys.argv[1]):
    sys.argv = ["flexspline", *(os.fsdecode(word.encode()) for word in words)]  # as the locale reads them
    try:
        main()
    except SystemExit as ended:
        if ended.code:
            sys.exit(f"{words}: {ended.code}")
    sys.stdout.write(chr(30))
"""
"""Commands in one process, which starts once; a record separator after what each says."""
C_LOCALE = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
NARROW = {
    "ascii": {"PYTHONIOENCODING": "ascii"},
    "cp1252": {"PYTHONIOENCODING": "cp1252"},
    "latin-1": {"PYTHONIOENCODING": "latin-1"},
    "C": C_LOCALE,
}


def run(
    folder: Path, env: dict[str, str], *words: object, **streams
) -> subprocess.CompletedProcess:
    """A command whose streams are bytes."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | streams
    return subprocess.run(
        command(*words), check=False, cwd=folder, env=environment(folder / "cache") | env, **pipes
    )


def test_no_stand_in_ends_a_string_and_all_are_plain() -> None:
    for stand_in in STAND_INS.values():
        assert stand_in.isascii()
        assert not set(stand_in) & set('"\\\n')


def test_letters_without_a_stand_in_lose_their_accents_or_are_escaped() -> None:
    assert plain_letters("Prüfstand 3\u202fé") == "Prufstand 3 e"
    assert plain_letters("齿") == r"\u9f7f"


NARROWEST = ("ascii", "C")
"""Of which another has more letters."""


@pytest.mark.parametrize(
    "env",
    [
        pytest.param(env, marks=[pytest.mark.long] * (name not in NARROWEST))
        for name, env in NARROW.items()
    ],
    ids=NARROW,
)
def test_a_first_design_goes_through_a_file(env: dict[str, str], tmp_path: Path) -> None:
    kinds = ("cup", "hat")
    for kind, text in zip(
        kinds, said(tmp_path, env, [["init", kind] for kind in kinds]), strict=True
    ):
        assert text.isascii()
        (tmp_path / "design.toml").write_bytes(text)
        whole = design_from(tomllib.loads(template(kind)))  # what a terminal with all letters shows
        assert load_design(tmp_path / "design.toml") == whole


def said(folder: Path, env: dict[str, str], commands: list[list[str]]) -> list[bytes]:
    """What each of the commands, which all succeed, writes to standard output."""
    done = subprocess.run(
        [sys.executable, "-c", ONE_AFTER_ANOTHER, json.dumps(commands)], capture_output=True,
        check=False, cwd=folder, env=environment(folder / "cache") | env,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert b"Traceback" not in done.stderr
    texts = done.stdout.split(b"\x1e")[:-1]
    assert len(texts) == len(commands)
    return texts


@pytest.mark.parametrize(
    "env",
    # the locale stays by default
    [pytest.param(NARROW[n], marks=[pytest.mark.long] * (n != "C")) for n in NARROW],
    ids=NARROW,
)
def test_every_quick_command(env: dict[str, str], tmp_path: Path) -> None:
    """Names of files and of the design beyond ASCII, too; what is written is UTF-8 all the same."""
    text = CUP.read_text(encoding="utf-8").replace("XB1-40 cup", "Zähne µ 齿")
    (tmp_path / "gerät.toml").write_text(text, encoding="utf-8")
    (tmp_path / "punkte-ü.csv").write_bytes(head("size-40-end-points"))
    (tmp_path / "torque.csv").write_text("torque_Nm\n0.1\n0.2\n", encoding="utf-8")
    backlash = ["backlash", "gerät.toml", *map(str, GIVEN)]
    figures = [["diagnose", "gerät.toml", "punkte-ü.csv", *map(str, GIVEN)]]
    commands = [
        ["--help"],
        ["backlash", "--help"],
        ["schema"],
        backlash,
        *(
            figures if env in (NARROW["C"], NARROW["latin-1"]) else []
        ),  # a locale; letters beyond ASCII
        [*backlash, "--json"],
    ]
    texts = said(tmp_path, env, commands)
    assert all(text and text.isascii() for text in texts)
    for text in texts[3:-1]:
        named = text.decode().splitlines()[-1].removeprefix("files in ")
        assert (tmp_path / ast.literal_eval(named)).is_dir()
    written = json.loads((tmp_path / "gerät.out" / "result.json").read_bytes().decode("utf-8"))
    assert written["design"] == "Zähne µ 齿"
    assert json.loads(texts[-1])["design"] == "Zähne µ 齿"
    refused = run(tmp_path, env, "predict", "gerät.toml", "fehlt-ü.csv", "--model", "fehlt.toml")
    assert refused.returncode == 2
    assert refused.stderr.count(b"\n") == 1


@pytest.mark.long
def test_export_from_a_c_locale(tmp_path: Path) -> None:
    """The CAD kernel and VTK write below a folder whose name the locale cannot read."""
    folder = tmp_path / "gerät"
    folder.mkdir()
    done = run(tmp_path, C_LOCALE, "export", plain(folder), "--out", folder / "öut")
    assert done.returncode == 0, done.stderr
    assert {p.suffix for p in (folder / "öut").iterdir()} >= {".step", ".stl", ".vtu"}


def test_a_terminal_keeps_the_letters_that_it_has(tmp_path: Path) -> None:
    """Latin-1 has the micro sign and the degree, and no Greek."""
    ours, theirs = pty.openpty()
    child = subprocess.Popen(
        command("init", "cup"), stdout=theirs, stderr=subprocess.DEVNULL, close_fds=True,
        env=environment(tmp_path) | {"PYTHONIOENCODING": "latin-1"},
    )  # fmt: skip
    os.close(theirs)
    shown = b""
    try:
        while piece := os.read(ours, 65536):
            shown += piece
    except OSError:  # how Linux says that the other end was closed
        pass
    finally:
        os.close(ours)
    assert child.wait() == 0
    text = shown.decode("latin-1")
    assert "µm" in text
    assert "alpha" in text


FULL = Path("/dev/full")


@pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    "words",
    [
        ("init",),
        ("backlash", CUP, *GIVEN, "--json"),
        ("--help",),
        *(
            pytest.param(words, marks=pytest.mark.long)
            for words in (("schema",), ("run", "--help"))
        ),
    ],
)
def test_a_full_disk_behind_stdout_is_one_line(words: tuple, tmp_path: Path) -> None:
    out = ("--out", tmp_path / "out") if words[0] == "backlash" else ()
    with FULL.open("wb") as full:
        done = run(tmp_path, {}, *words, *out, stdout=full)
    assert done.returncode == 1
    assert done.stderr == b"flexspline: standard output: No space left on device\n"


def test_a_reader_that_left(tmp_path: Path) -> None:
    ours, theirs = os.pipe()
    os.close(ours)
    done = run(tmp_path, {}, "init", stdout=theirs)
    os.close(theirs)
    assert done.returncode == 141  # 128 and SIGPIPE
    assert done.stderr == b""


def test_nobody_reads_the_progress(tmp_path: Path) -> None:
    """`2>&1 | head -1`: the files come all the same."""
    (tmp_path / "points.csv").write_bytes(head("size-40-end-points"))
    ours, theirs = os.pipe()
    os.close(ours)
    words = ("diagnose", CUP, "points.csv", *GIVEN, "--out", "out", "--json")
    done = run(tmp_path, {}, *words, stderr=theirs)
    os.close(theirs)
    assert done.returncode == 0
    assert json.loads(done.stdout)["verdict"]
    assert (tmp_path / "out" / "diagnosis.pdf").exists()


@pytest.mark.skipif(shutil.which("sh") is None, reason="needs a shell that closes streams")
@pytest.mark.parametrize(
    ("closed", "status"),
    [
        pytest.param("<&-", 0, marks=pytest.mark.long),
        (">&-", 1),
        ("2>&-", 0),
        ("<&- >&- 2>&-", 1),
    ],
)
def test_closed_streams(closed: str, status: int, tmp_path: Path) -> None:
    """Result files do not become the stream: they hold what they should."""
    line = [
        "sh",
        "-c",
        f'exec "$@" {closed}',
        "sh",
        *command("backlash", CUP, *GIVEN, "--out", "out"),
    ]
    done = subprocess.run(
        line, capture_output=True, check=False, cwd=tmp_path, env=environment(tmp_path / "cache")
    )
    assert done.returncode == status
    assert b"Traceback" not in done.stderr
    assert json.loads((tmp_path / "out" / "result.json").read_bytes())["K_series_Nm_per_rad"] > 0


def test_what_the_user_keeps_from_others(tmp_path: Path) -> None:
    line = [
        "sh",
        "-c",
        'umask 077; exec "$@"',
        "sh",
        *command("backlash", CUP, *GIVEN, "--out", "out"),
    ]
    subprocess.run(
        line, capture_output=True, check=True, cwd=tmp_path, env=environment(tmp_path / "cache")
    )
    assert (tmp_path / "out" / "result.json").stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("mark", [b"\xef\xbb\xbf", b""])
@pytest.mark.parametrize("line_end", [b"\r\n", b"\n"])
def test_designs_as_other_editors_save_them(mark: bytes, line_end: bytes, tmp_path: Path) -> None:
    """A mark at the start, Windows' line ends, no last line end."""
    raw = mark + CUP.read_bytes().strip().replace(b"\n", line_end)
    (tmp_path / "design.toml").write_bytes(raw)
    assert load_design(tmp_path / "design.toml") == load_design(CUP)


def test_a_current_folder_that_is_gone(tmp_path: Path) -> None:
    (tmp_path / "gone").mkdir()
    line = 'cd gone && rmdir ../gone && exec "$@"'
    for words, status in (
        (("init",), 0),
        (("backlash", CUP, *GIVEN, "--out", tmp_path / "out"), 0),
        (("backlash", CUP, *GIVEN, "--out", "out"), 2),
    ):
        (tmp_path / "gone").mkdir(exist_ok=True)
        done = subprocess.run(
            ["sh", "-c", line, "sh", *command(*words)],
            capture_output=True, check=False, cwd=tmp_path, env=environment(tmp_path / "cache"),
        )  # fmt: skip
        assert done.returncode == status, done.stderr
        assert b"Traceback" not in done.stderr


@pytest.mark.parametrize(
    "after_s", [0.3, *(pytest.param(s, marks=pytest.mark.long) for s in (0.6, 0.9))]
)
def test_ctrl_c_is_one_line_at_most(after_s: float, tmp_path: Path) -> None:
    """Later than Python's own start, which nobody can catch."""
    child = subprocess.Popen(
        command("backlash", CUP, *GIVEN, "--out", "out"), cwd=tmp_path,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(tmp_path / "cache"),
    )  # fmt: skip
    time.sleep(after_s)
    child.send_signal(signal.SIGINT)
    _, said = child.communicate()
    if "Traceback" in said.decode() and b"results" not in said:
        pytest.skip("the machine is slow: Python itself was starting")
    assert b"Traceback" not in said
    assert child.returncode in (0, 130, -signal.SIGINT)
    assert said.count(b"\n") <= 1
    assert not list(tmp_path.rglob("*.part"))


LIBRARY_SPEAKS = """
import os, sys
from flexspline.results import cli, entry

def app():
    os.write(1, b"a library speaks\\n")  # as C does, past sys.stdout
    print("answer")

cli.app = app
entry.main()
print("after")
"""


def test_what_a_library_prints_is_no_part_of_the_answer(tmp_path: Path) -> None:
    words = [sys.executable, "-c", LIBRARY_SPEAKS]
    done = subprocess.run(
        words, capture_output=True, text=True, check=True, env=environment(tmp_path / "cache")
    )
    assert done.stdout == "answer\nafter\n"
    assert "a library speaks" in done.stderr
