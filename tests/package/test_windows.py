"""What Windows lacks is looked for before it is used.

In a process of its own every module is loaded first as it is, so that libraries have what they take on this
system, then again without the names that Windows does not have; then what they guard is done.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WITHOUT = """
import asyncio, importlib, os, pathlib, signal, subprocess, sys

ROOMS = ("geometry", "fea", "pipeline", "results")
NAMES = [
    ".".join(("flexspline", *p.with_suffix("").parts))
    for room in ROOMS for p in sorted(pathlib.Path(room).rglob("*.py")) if p.name != "__init__.py"
]
OS = ("nice", "killpg", "getpgid", "setpgid", "setsid", "fork", "forkpty", "getuid", "geteuid", "getgid",
      "uname", "sysconf", "statvfs", "fstatvfs", "mkfifo", "getloadavg", "fchmod", "fchown", "chown",
      "chroot", "sched_getaffinity")
SIGNAL = ("SIGKILL", "SIGHUP", "SIGPIPE", "SIGALRM", "SIGCHLD", "SIGQUIT", "SIGUSR1", "SIGSTOP", "alarm",
          "setitimer", "pthread_sigmask", "siginterrupt")

def as_on_windows():
    for name in (*NAMES, "psutil"):
        importlib.import_module(name)
    for name in [n for n in sys.modules if n.partition(".")[0] == "flexspline"]:
        del sys.modules[name]
    for module, names in ((os, OS), (signal, SIGNAL)):
        for name in names:
            if hasattr(module, name):
                delattr(module, name)
    for name in ("resource", "fcntl", "pwd", "grp", "termios", "tty", "pty", "syslog"):
        sys.modules[name] = None

as_on_windows()
"""
IMPORTS = """
for name in NAMES:
    importlib.import_module(name)
"""
LOW_PRIORITY = """
from multiprocessing import Pipe
from flexspline.results.studio.worker import serve
ours, theirs = Pipe()
ours.close()
serve(theirs, 10)
"""
STOPPED_JOB = """
import time
import psutil
from flexspline.results.studio.jobs import StudioJob
START = "import subprocess, sys; subprocess.run([sys.executable, '-c', 'import time; time.sleep(600)'])"

async def stop():
    async def say(line): pass
    job = StudioJob("solid", say)
    job.process = await asyncio.create_subprocess_exec(sys.executable, "-c", START)
    tree = psutil.Process(job.process.pid)
    while not (started := tree.children()):
        await asyncio.sleep(0.05)
    job.stop()
    await asyncio.wait_for(job.process.wait(), 30)
    gone, alive = psutil.wait_procs(started, 30)
    assert not alive
    job.close()

asyncio.run(stop())
"""
SERVED = """
import threading
from flexspline.results.studio.serve import serve, starting_design

def none(self, *_):
    raise NotImplementedError
asyncio.SelectorEventLoop.add_signal_handler = none
import multiprocessing.popen_fork, types
# how the library itself ends a process on this system
multiprocessing.popen_fork.signal = types.SimpleNamespace(SIGKILL=9, SIGTERM=15)
write = sys.stdout.write

def seen(text):
    if "http://" in text:  # it serves; its workers begin
        threading.Timer(2.0, os.kill, (os.getpid(), signal.SIGINT)).start()  # Ctrl-C
    return write(text)

sys.stdout.write = seen
serve(starting_design(None), "127.0.0.1", 0, browser=False)
"""
MEMORY = """
from flexspline.fea.solid.memory import available_bytes
assert available_bytes() > 0
"""


@pytest.mark.parametrize(
    ("done", "said"),
    [
        # in one process, which takes three seconds to load everything twice
        pytest.param(IMPORTS + MEMORY + LOW_PRIORITY + STOPPED_JOB, "", id="modules, memory, jobs"),
        pytest.param(SERVED, "flexspline studio: http://127.0.0.1", id="served page"),
    ],
)
def test_it_works_without(done: str, said: str) -> None:
    out = subprocess.run(
        [sys.executable, "-c", WITHOUT + done + "print('to the end')"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert out.returncode == 0, out.stderr
    assert out.stdout.endswith("to the end\n")
    assert said in out.stdout
    assert "Traceback" not in out.stderr
