"""The validation page: every verification test hands in its case, one command writes them down.

What a machine may lack: a test marked `opengl` is skipped, with the reason, where VTK cannot draw, one
marked `cad` where the CAD kernel cannot be loaded.

And what the whole suite shares: one cache, one finished run of an example.
"""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from checkout import INSTALLED

# isort: split
from cad_kernel import why_no_cad
from finished_run import FinishedDiagnosis, FinishedRun, finished_diagnosis, finished_run
from opengl import why_no_pictures
from shell import FEW_PAGE_FAULTS, ONE_THREAD
from validation_page import TOPICS, Row, has_case, markdown

from flexspline.geometry.kernel import CadKernelError

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation.md"
WRITERS = ("--write-validation", "--write-reliability")
ROWS = pytest.StashKey[list[Row]]()
OUTCOME = pytest.StashKey[str]()
SLOWEST = (
    "test_cli", "test_specimens", "test_lobes_by_torsion", "test_superposition", "test_studio_work",
    "test_separate_units", "test_swept", "test_document_commands", "test_cuts_alone",
    "test_enclosed_part", "test_scaled_bend", "test_legibility_diagnosis", "test_study_command",
    "test_studio_design", "test_first_mesh", "test_studio_reading", "test_layered",
    "test_estimate_honesty", "test_streams", "test_studio_widths", "test_gear_command",
    "test_studio_process", "test_without_opengl", "test_enclosed_holes", "test_diagnose_command",
    "test_gear_inputs", "test_wrong_model_said", "test_cyclic", "test_no_network", "test_slope_hints",
    "test_rate_independence", "test_every_cause",
)  # fmt: skip
"""Files that take seven seconds of a processor or more, begun first so that no worker is left alone with one
at the end. The first makes the run that others read, which begin when it has ended, as waiting is a worker's
time; the second the solves that the hidden specimens read; the third those of `test_cuts_alone`."""

OF_ONE_HELPER = ("test_estimate_honesty", "test_solid_against_axisymmetric")
"""Files that read the same solutions, kept in their process: they go to one worker. Others go by file."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--write-validation",
        action="store_true",
        help=f"write {PAGE.name} from what the tests find",
    )


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """Where pytest-xdist is there, the whole suite runs three files at a time unless `-n` says otherwise.

    A page is written by the process that ran the tests: one, whatever `-n` says. Three workers keep two
    cores busy, as tests of a server or a page wait for it. They take a thread each: those of the linear
    algebra libraries would wait for each other in a loop that keeps a core busy. A run of the example cup on
    a loaded machine, processor time: 52 s with two, 43 s with one. And they keep compiled modules, whatever
    the environment says: of this checkout each of hundreds of processes would compile all that it imports.
    """
    if not config.pluginmanager.hasplugin("xdist") or hasattr(config, "workerinput"):
        return
    option = config.option
    if any(config.getoption(name, default=False) for name in WRITERS):
        option.numprocesses = 0
    elif option.numprocesses is None and config.args_source is config.ArgsSource.TESTPATHS:
        option.numprocesses, option.dist = 3, "loadfile"
        option.loadscopereorder = False  # `SLOWEST` says the order
        for name, value in (ONE_THREAD | FEW_PAGE_FAULTS).items():  # which the workers inherit
            os.environ.setdefault(name, value)
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_report_header() -> str | None:
    return None if INSTALLED else "flexspline is not installed: the checkout's own is tested"


def pytest_configure(config: pytest.Config) -> None:
    os.environ.pop("COLUMNS", None)  # of pytest-xdist: answers would be folded
    if (
        signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    ):  # a shell's `&`; children would inherit it
        signal.signal(signal.SIGINT, signal.default_int_handler)
    config.stash[ROWS] = []
    if config.getoption("--write-validation"):
        config.option.markexpr = ""  # the long ones too: the page is whole or not written


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """By file, but for `OF_ONE_HELPER`; None: as `--dist` says."""
    from xdist.scheduler import LoadFileScheduling

    class ByFileOrHelper(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            return OF_ONE_HELPER[0] if Path(file).stem in OF_ONE_HELPER else file

    return ByFileOrHelper(config, log) if config.option.dist == "loadfile" else None


class TurnedDir(pytest.Dir):
    """A folder of tests that each worker begins to import at another place: of a fresh clone the first to
    import a file rewrites its asserts and keeps it compiled, and the others, which come later, read that."""

    def collect(self) -> list[pytest.Item | pytest.Collector]:
        found = list(super().collect())
        number = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
        first = len(found) * number // int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
        return found[first:] + found[:first]


def pytest_collect_directory(path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    package = (path / "__init__.py").is_file()  # pytest makes those
    return None if package else TurnedDir.from_parent(parent, path=path)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The slowest files first, the others in the same order on every worker.

    pytest would import the checkout as a package, because the program's `__init__.py` is at its top. That
    puts the folder around it first on `sys.path`: a package `numpy` there would then hide the library.
    """
    place = {name: i for i, name in enumerate(SLOWEST)}
    items.sort(key=lambda item: (place.get(item.path.stem, len(place)), item.path.parts))
    for node in items[0].listchain() if items else ():
        if isinstance(node, pytest.Package) and node.path == ROOT:
            node.setup = lambda: None  # type: ignore[method-assign]


def pytest_collection_finish() -> None:
    """What the collector of garbage need not look at again: half a million objects, 4 % of the suite. What
    tests leave it looks at every million objects in place of every 70 000: 1 % more."""
    gc.freeze()
    gc.set_threshold(10_000, 10, 10)


@contextmanager
def skipped_without_cad() -> Iterator[None]:
    """A test that comes to the CAD kernel where that cannot be loaded is skipped: many do, inside."""
    try:
        yield
    except CadKernelError:
        if not (reason := why_no_cad()):
            raise
        pytest.skip(reason)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Iterator[None]:
    for marker, why in (("opengl", why_no_pictures), ("cad", why_no_cad)):
        if item.get_closest_marker(marker) and (reason := why()):
            pytest.skip(reason)
    with skipped_without_cad():
        return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    with skipped_without_cad():
        return (yield)


@pytest.fixture(scope="session")
def suite_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of this run of the suite, the same on every worker (the recipe of pytest-xdist's manual)."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "suite"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture(scope="session", autouse=True)
def suite_cache(suite_folder: Path) -> Path:
    """The commands' cache where a test sets no other; new each time, as its keys do not hold the program."""
    os.environ["FLEXSPLINE_CACHE"] = str(suite_folder / "cache")
    return suite_folder / "cache"


@pytest.fixture(scope="session")
def finished_cup(suite_folder: Path, suite_cache: Path) -> FinishedRun:
    """`flexspline run examples/xb1-40.toml`: what the suite's cache holds of this cup from then on."""
    return finished_run("xb1-40", suite_folder, suite_cache)


@pytest.fixture(scope="session")
def finished_sweep(suite_folder: Path, suite_cache: Path) -> FinishedDiagnosis:
    """`flexspline diagnose` of the example's sweep with all its charts and reports."""
    return finished_diagnosis(suite_folder, suite_cache)


@pytest.fixture
def no_diagnosis_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """`diagnose` in this process ends with its record and model: no charts, no reports."""
    for drawn, nothing in (("draw_figures", ()), ("reports_of", {})):
        monkeypatch.setattr(
            f"flexspline.results.diagnosis.files.{drawn}", lambda *_, n=nothing, **__: n
        )


@pytest.fixture
def record(request: pytest.FixtureRequest) -> Callable[..., None]:
    """`record(case, source, expected, got, unit="", digits=4)`: a row of the validation page.

    Without --write-validation it fails a test whose case the page has not.
    """
    writing = request.config.getoption("--write-validation")

    def add(case: str, source: str, *figures, **more) -> None:
        row = Row(request.path.stem, case, source, *figures, **more)
        request.config.stash[ROWS].append(row)
        known = writing or has_case(PAGE.read_text(encoding="utf-8"), row)
        assert known, f"{PAGE.name} lacks “{case}”: pytest tests/verification --write-validation"

    return add


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    config = session.config
    if not config.getoption("--write-validation"):
        return
    rows = config.stash[ROWS]
    modules = {row.module for row in rows}
    missing = [m for group in TOPICS.values() for m in group if m not in modules]
    if exitstatus or missing:
        reason = f"no case from {', '.join(missing)}" if missing else "tests failed"
        config.stash[OUTCOME] = f"{PAGE.name} not written: {reason}"
        session.exitstatus = exitstatus or 1
        return
    PAGE.write_text(markdown(rows), encoding="utf-8")
    config.stash[OUTCOME] = f"{PAGE.name} written: {len(rows)} cases"


def pytest_terminal_summary(terminalreporter) -> None:
    if (said := terminalreporter.config.stash.get(OUTCOME, None)) is not None:
        terminalreporter.write_line(said)
