"""Jobs of a browser tab: `flexspline` commands, each in a process that can be stopped.

A job has a folder of its own under the system's temporary folder. Names in it are fixed here; nothing
that a browser sends becomes a path.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
import tempfile
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from flexspline.geometry.design import Design
from flexspline.geometry.template import design_text

JobKind = Literal["solid", "report", "step", "diagnose"]
SERVED = {".pdf": "application/pdf", ".html": "text/html", ".step": "model/step",
          ".png": "image/png", ".toml": "application/toml", ".json": "application/json"}  # fmt: skip
"""What a tab may fetch of a job's folder, by ending."""
GRACE_S = 3.0
"""From the wish to stop (Ctrl-C) to the end by force."""
FORCE = getattr(signal, "SIGKILL", signal.SIGTERM)
"""Ends any process; Windows has one way to end a process, and no Ctrl-C for others."""
_DESIGN, _MEASURED, _OUT = "design.toml", "measured.csv", "out"


@dataclass
class StudioJob:
    """One running command; `say` gets its lines of progress.

    Attributes
    ----------
    process : the command, once it has begun.
    folder : where it works, made by `run`.
    """

    kind: JobKind
    say: Callable[[str], Awaitable[None]]
    process: asyncio.subprocess.Process | None = None
    folder: tempfile.TemporaryDirectory[str] | None = None
    _stopped: bool = False

    async def run(self, design: Design, measured: bytes = b"") -> Done:
        """Start the command, pass its progress on, and wait for its end.

        Raises
        ------
        OSError : its folder cannot be written, or the command cannot be started.
        """
        self.folder = tempfile.TemporaryDirectory(prefix="flexspline-studio-")
        at = Path(self.folder.name)
        if self.kind == "solid" and all(part.is_revolved for part in design.parts):
            # "auto" would solve it as a body of revolution again
            solid = design.solver.model_copy(update={"model": "solid"})
            design = design.model_copy(update={"solver": solid})
        (at / _DESIGN).write_text(design_text(design), encoding="utf-8")
        (at / _MEASURED).write_bytes(measured)
        self.process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", *_COMMANDS[self.kind],
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
            stdin=asyncio.subprocess.DEVNULL, cwd=at, start_new_session=True,
            limit=1 << 20,
        )  # fmt: skip
        if self._stopped:  # while it was being started
            self.stop()
        assert self.process.stdout is not None
        lines, printed = await asyncio.gather(self._listen(), self.process.stdout.read())
        status = await self.process.wait()
        if self._stopped:
            return Done("stopped", "stopped")
        if status != 0:
            return Done("failed", lines[-1].removeprefix("flexspline: ") if lines else "no answer")
        return Done("done", printed.decode("utf-8", "replace"), self.files())

    async def _listen(self) -> list[str]:
        """The lines on stderr, the folder's own name taken out."""
        assert self.folder is not None
        assert self.process is not None
        assert self.process.stderr is not None
        lines: list[str] = []
        async for raw in self.process.stderr:
            line = raw.decode("utf-8", "replace").rstrip()
            line = line.replace(f"{self.folder.name}{os.sep}", "").replace(f"{_DESIGN}: ", "")
            lines.append(line)
            await self.say(line)
        return lines

    def stop(self) -> None:
        """Interrupt the command and whatever it started; by force if it does not listen."""
        self._stopped = True
        if self.process is None or self.process.returncode is not None:
            return
        self._signal(signal.SIGINT)
        asyncio.get_running_loop().call_later(GRACE_S, self._signal, FORCE)

    def _signal(self, number: signal.Signals) -> None:
        if self.process is not None and self.process.returncode is None:
            if hasattr(os, "killpg"):
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self.process.pid, number)
            else:
                _terminate_tree(self.process.pid)

    def files(self) -> list[str]:
        """Names that a tab may fetch, figures in the order in which they were made."""
        if self.folder is None:
            return []
        made = sorted((Path(self.folder.name) / _OUT).glob("*"), key=lambda p: p.stat().st_mtime_ns)
        return [p.name for p in made if p.suffix in SERVED and p.is_file()]

    def read(self, name: str) -> bytes | None:
        """A file's bytes, if its name is one of `files`."""
        if self.folder is None or name not in self.files():
            return None
        return (Path(self.folder.name) / _OUT / name).read_bytes()

    def close(self) -> None:
        """Stop, and take the folder away."""
        self.stop()
        if self.folder is not None:
            self.folder.cleanup()


def _terminate_tree(pid: int) -> None:
    """End a process and all that it started, where there are no process groups (Windows)."""
    import psutil

    with contextlib.suppress(psutil.NoSuchProcess):
        process = psutil.Process(pid)
        for one in (*process.children(recursive=True), process):
            with contextlib.suppress(psutil.NoSuchProcess):
                one.terminate()


@dataclass(frozen=True)
class Done:
    """How a job ended, what it printed or why it failed, and its files."""

    state: Literal["done", "failed", "stopped"]
    text: str
    files: list[str] = field(default_factory=list)


_CLI = "flexspline.results.entry"
_COMMANDS: dict[JobKind, tuple[str, ...]] = {
    "solid": (_CLI, "stiffness", _DESIGN, "--out", _OUT, "--json"),
    "report": (_CLI, "run", _DESIGN, "--out", _OUT, "--json"),
    "step": ("flexspline.results.studio.step", _DESIGN, _OUT),
    "diagnose": (_CLI, "diagnose", _DESIGN, _MEASURED, "--out", _OUT, "--json"),
}
