"""Local workers hear nobody but the process that started them, and end with it."""

import os
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path
from typing import Any

import psutil
import pytest

from flexspline.geometry.errors import ComputationError
from flexspline.pipeline.study.cluster import worker_pool
from flexspline.pipeline.study.local_workers import LocalWorkers, WorkerStartError


class TwoWords(Exception):
    """Pickles, and cannot be made again from its one message."""

    def __init__(self, one: str, two: str) -> None:
        super().__init__(f"{one} {two}")


def two_words() -> None:
    raise TwoWords("no", "luck")


def no_luck() -> None:
    raise ComputationError("no luck")


def talks() -> int:
    print("what a library prints", flush=True)
    os.system("echo what its child prints")
    return sys.stdin.fileno() + 42


def unnamed() -> object:
    return lambda: 0


def doors(process: psutil.Process) -> list[object]:
    """Where a process can be reached from outside: ports it listens at, sockets with a path."""
    return [
        c for c in _sockets(process)
        if c.status == psutil.CONN_LISTEN or (isinstance(c.laddr, str) and c.laddr)
    ]  # fmt: skip


def _sockets(process: psutil.Process) -> list[Any]:
    """psutil before 6 has the older name alone."""
    find = getattr(process, "net_connections", None) or process.connections
    return list(find("all"))


def test_nothing_listens_while_a_study_runs() -> None:
    """So no other user of the machine reaches a scheduler, a worker or a dashboard."""
    before = doors(psutil.Process())
    with worker_pool(2, "") as pool:
        pids = {pool.submit(os.getpid).result(timeout=60) for _ in range(4)}
        pending = [pool.submit(time.sleep, 1) for _ in range(2)]
        family = psutil.Process().children(recursive=True)
        assert pids <= {p.pid for p in family}
        assert os.getpid() not in pids
        found = [d for p in family for d in doors(p)]
        found += [d for d in doors(psutil.Process()) if d not in before]
        for f in pending:
            f.result(timeout=60)
    assert found == []


def test_a_door_would_be_seen(tmp_path: Path) -> None:
    """What the test above looks for, in a process that does listen."""
    code = (
        "import http.server as h; s = h.HTTPServer(('127.0.0.1', 0), h.SimpleHTTPRequestHandler); "
    )
    code += "print(s.server_port, flush=True); s.serve_forever()"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        cwd=tmp_path,
    ) as server:  # fmt: skip
        assert server.stdout is not None
        port = int(server.stdout.readline())
        assert doors(psutil.Process(server.pid))
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=10) as page:
            assert page.status == 200
        server.kill()


def test_errors_come_back() -> None:
    with LocalWorkers(1) as workers:
        with pytest.raises(ComputationError, match="no luck") as caught:
            workers.submit(no_luck).result(timeout=60)
        assert str(caught.value) == "no luck"
        assert "in no_luck" in caught.value.__notes__[0]  # where in the worker
        with pytest.raises(RuntimeError, match="TwoWords: no luck"):
            workers.submit(two_words).result(timeout=60)
        with pytest.raises(Exception, match="lambda"):
            workers.submit(unnamed).result(timeout=60)
        assert workers.submit(abs, -3).result(timeout=60) == 3


def test_what_is_printed_in_a_worker_is_no_answer() -> None:
    with LocalWorkers(1) as workers:
        assert workers.submit(talks).result(timeout=60) == 42


def test_workers_that_cannot_start_end_the_study(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not one design after the other."""
    ends = [sys.executable, "-c", "raise SystemExit(7)"]
    monkeypatch.setattr(
        "flexspline.pipeline.study.local_workers.child_command", lambda *called: ends
    )
    with LocalWorkers(1) as workers, pytest.raises(WorkerStartError, match="with status 7"):
        workers.submit(abs, -3).result(timeout=60)


def test_leaving_ends_them_at_once() -> None:
    with LocalWorkers(1) as workers:
        pid = workers.submit(os.getpid).result(timeout=60)
        at_work, waiting = workers.submit(time.sleep, 600), workers.submit(abs, -3)
        while not at_work.running():
            time.sleep(0.01)
    assert not psutil.pid_exists(pid)
    assert waiting.cancelled()
    assert at_work.exception(timeout=10) is not None


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_they_end_with_the_process_that_started_them(how: signal.Signals) -> None:
    code = (
        "import os, time; from flexspline.pipeline.study.local_workers import LocalWorkers\n"
        "with LocalWorkers(1) as workers:\n"
        "    print(workers.submit(os.getpid).result(), flush=True)\n"
        "    workers.submit(time.sleep, 600).result()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    ) as owner:  # fmt: skip
        assert owner.stdout is not None
        worker = psutil.Process(int(owner.stdout.readline()))
        owner.send_signal(how)
        _, alive = psutil.wait_procs([worker], timeout=20)
        assert alive == []
        said = owner.communicate(timeout=20)[1]
    # the owner's own KeyboardInterrupt at most: a worker sees no Ctrl-C
    assert said.count("Traceback") == (how == signal.SIGINT)


def test_a_terminal_s_interrupt_does_not_reach_them() -> None:
    with LocalWorkers(1) as workers:
        pid = workers.submit(os.getpid).result(timeout=60)
        assert os.getpgid(pid) != os.getpgid(0)
