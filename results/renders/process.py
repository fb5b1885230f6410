"""Drawing in a separate process: if a graphics driver crashes, the program continues.

The process is started for the first picture and draws the next ones too, so that VTK is loaded once.
A run has two such processes. The arguments are passed in a file (`pipeline.packing`); questions and
answers are lines of JSON.
"""

from __future__ import annotations

import contextlib
import json
import re
import signal
import subprocess
import sys
import tempfile
from collections import deque
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from threading import Lock, Timer
from typing import Any

from flexspline.fea.child_python import child_command
from flexspline.geometry.errors import ComputationError, one_line, why_of
from flexspline.pipeline.packing import packed, unpacked
from flexspline.results.renders.opengl import ADVICE
from flexspline.results.streams import private_stdout

SLOWEST_S = 300.0
"""The largest part of the examples takes 5 s where the processor draws; a driver that hangs, for ever."""
STOPPED = "drawing was stopped"
KILLED = "SIGKILL"
"""No driver ends a process so."""
_VTK_LOG = re.compile(r"^(\x1b\[[0-9;]*m)*[\d-]+ [\d:.]+ \([^)]*\) \[[^]]*\]|\x1b\[[0-9;]*m")
"""Colours, time and thread before VTK's words: with them no two reasons are alike."""


class NotDrawnError(ComputationError):
    """A picture that could not be drawn, and why."""


class DrawingProcess:
    """Calls functions that write a picture; a context that ends the process.

    A function on which the process ended, or that took longer than `slowest_s`, is not called again:
    `gave_up` has the reasons by its name, and may be shared with other processes.
    """

    def __init__(self, slowest_s: float = SLOWEST_S, gave_up: dict[str, str] | None = None) -> None:
        self.slowest_s = slowest_s
        self._process: subprocess.Popen[str] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._gave_up = {} if gave_up is None else gave_up
        self._too_slow = False
        self._closed = False
        self._lock = Lock()

    def __enter__(self) -> DrawingProcess:
        return self

    def __exit__(self, *_: object) -> None:
        with self._lock:  # by another thread, perhaps just now
            self._closed = True
            self._end()
        if self._folder is not None:
            self._folder.cleanup()

    def draw(self, write: Callable[..., None], *arguments: Any) -> bytes:
        """What `write(path, *arguments)`, a function of a module, writes there.

        Raises
        ------
        NotDrawnError : it raised, it took too long, the process ended, or its files cannot be written.
        """
        name = f"{write.__module__}:{write.__qualname__}"
        if name in self._gave_up:
            raise NotDrawnError(self._gave_up[name])
        try:
            return self._drawn(name, arguments)
        except OSError as fault:  # a full disk, say
            raise NotDrawnError(why_of(fault, "the folder for temporary files: ")) from fault

    def _drawn(self, name: str, arguments: tuple[Any, ...]) -> bytes:
        content = packed(arguments)
        with self._lock:  # an end that comes meanwhile removes the folder afterwards
            if self._closed:
                raise NotDrawnError(STOPPED)
            if self._folder is None:
                self._folder = tempfile.TemporaryDirectory(
                    prefix="flexspline-picture-", ignore_cleanup_errors=True
                )
            packed_in, made = (
                Path(self._folder.name) / n for n in ("arguments.npz", "picture.png")
            )
            made.unlink(missing_ok=True)
            packed_in.write_bytes(content)
        question = {"function": name, "arguments": str(packed_in), "made": str(made)}
        answer = self._exchange(json.dumps(question))
        if answer is None and self._closed:
            raise NotDrawnError(STOPPED)
        if answer is None:
            self._gave_up[name] = self._last_words()
            raise NotDrawnError(self._gave_up[name])
        if reason := json.loads(answer)["reason"]:
            raise NotDrawnError(reason)
        return made.read_bytes()

    def _exchange(self, question: str) -> str | None:
        """The answer, None where the process ended first."""
        with self._lock:
            if self._closed:
                return None
            process = self._running()
        assert process.stdin is not None
        assert process.stdout is not None
        limit = Timer(self.slowest_s, self._stop)
        limit.start()
        try:
            process.stdin.write(question + "\n")
            process.stdin.flush()
            return process.stdout.readline() or None
        except OSError:  # it was gone before it read
            return None
        finally:
            limit.cancel()

    def _stop(self) -> None:
        """The process took too long."""
        if self._process is not None:
            self._too_slow = True
            self._process.kill()

    def _running(self) -> subprocess.Popen[str]:
        if self._process is None:
            assert self._folder is not None
            with (Path(self._folder.name) / "stderr.txt").open("wb") as stderr:
                self._process = subprocess.Popen(
                    child_command(__name__, "serve"),
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=stderr, text=True,
                )  # fmt: skip
        return self._process

    def _last_words(self) -> str:
        """Why the process is no more."""
        assert self._process is not None
        assert self._folder is not None
        status = self._process.wait()
        self._end()
        if self._too_slow:
            self._too_slow = False
            return f"the drawing process made no picture within {self.slowest_s:g} s"
        how = f"exit status {status}"
        with contextlib.suppress(ValueError):
            how = signal.Signals(-status).name
        written = (Path(self._folder.name) / "stderr.txt").read_text("utf-8", "replace").split("\n")
        last = next(
            (
                f", {one_line(w, 120)}"
                for s in reversed(written)
                if (w := _VTK_LOG.sub("", s).strip())
            ),
            "",
        )
        ended = f"the drawing process ended ({how}{last})"
        if how == KILLED:
            return f"{ended}: probably the system had no memory left; free memory or draw on another machine"
        return f"{ended}: probably a graphics driver is missing or broken; {ADVICE}"

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):  # of a pipe that nobody reads any more
                if pipe is not None:
                    pipe.close()


def serve() -> None:
    """The process: draw what each line asks for, until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C: an end without a traceback
    answers = private_stdout("utf-8")  # the answers alone
    for line in sys.stdin:
        question = json.loads(line)
        print(json.dumps({"reason": _drawn(**question)}), file=answers, flush=True)


_known: deque[tuple[bytes, tuple[Any, ...]]] = deque(maxlen=2)
"""What was drawn last, packed and unpacked: a field, and its picture as WebP, before its 3-D view."""


def _arguments(content: bytes) -> tuple[Any, ...]:
    """The same objects as before for the same content (`results.renders.remembered`)."""
    for packed_before, arguments in _known:
        if packed_before == content:
            return arguments
    _known.append((content, unpacked(content)))
    return _known[-1][1]


def _drawn(function: str, arguments: str, made: str) -> str:
    """Draw; why it failed, or ""."""
    module, _, name = function.partition(":")
    try:
        write = getattr(import_module(module), name)
        write(Path(made), *_arguments(Path(arguments).read_bytes()))
    except ComputationError as error:
        return one_line(str(error))
    except Exception as error:  # whatever a library raises costs its own picture
        return one_line(f"{type(error).__name__}: {error}")
    return ""
