"""A unique identity of a process: machine and boot, pid namespace, pid, start time.

A pid alone is not enough. The system gives it again; another container counts its own processes from 1
and may have the same host name and the same folders; another machine may mount them.
"""

from __future__ import annotations

import os
import re
import socket
import sys
import zlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

UNKNOWN = "x"
"""A part that the system does not tell."""
NONE = "0"
"""The pid namespace where systems have none: macOS, Windows."""
_STATE, _STARTTIME = 3, 22
"""Fields of /proc/PID/stat, counted from 1 (proc(5))."""
_TEXT = re.compile(r"([0-9a-f]{8}|x)-([0-9]+|x)-([0-9]+)-([0-9]+|x)")

Fate = Literal["alive", "gone", "unknown"]


@dataclass(frozen=True)
class ProcessId:
    """One process.

    Attributes
    ----------
    machine : of the boot on Linux, of the host's name elsewhere. space : pid namespace. born : when it
        started, in the system's own unit: clock ticks after the boot on Linux, hundredths of a second
        elsewhere. Parts that the system does not tell are ``x``.
    """

    machine: str
    space: str
    pid: int
    born: str

    def __str__(self) -> str:
        return f"{self.machine}-{self.space}-{self.pid}-{self.born}"

    @property
    def fate(self) -> Fate:
        """Return whether the process still runs; unknown where this one cannot see it."""
        current = this_process()
        if UNKNOWN in (self.machine, self.space, current.machine, current.space):
            return "unknown"
        if (self.machine, self.space) != (current.machine, current.space):
            return "unknown"
        if not _exists(self.pid):
            return "gone"
        born = started(self.pid)
        if born is None:
            return "gone"
        return "gone" if UNKNOWN not in (born, self.born) and born != self.born else "alive"


def this_process() -> ProcessId:
    """Return the id of the process that asks."""
    pid = os.getpid()
    return ProcessId(_machine(), _space(), pid, started(pid) or UNKNOWN)


def parsed(text: str) -> ProcessId | None:
    """Return a process from its text; what follows it is not looked at. None if the text is another."""
    match = _TEXT.match(text)
    return ProcessId(match[1], match[2], int(match[3]), match[4]) if match else None


@cache
def _machine() -> str:
    if sys.platform == "linux":
        try:
            identity = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii")
        except OSError:
            return UNKNOWN
    else:
        identity = socket.gethostname()
    return f"{zlib.crc32(identity.encode()):08x}"


def _space() -> str:
    if sys.platform != "linux":
        return NONE
    try:
        if os.readlink("/proc/self") != str(os.getpid()):
            return UNKNOWN  # /proc counts in another namespace than this process
        return re.sub(r"\D", "", os.readlink("/proc/self/ns/pid")) or UNKNOWN
    except OSError:
        return UNKNOWN


def _exists(pid: int) -> bool:
    if sys.platform != "linux":
        import psutil

        return bool(psutil.pid_exists(pid))
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:  # another user's
        return True
    return True


def started(pid: int) -> str | None:
    """Return when a process started; None if it has ended, or is a zombie.

    On Linux the kernel's own count: psutil adds the time of the boot, which moves with the clock.
    """
    if sys.platform == "linux":
        try:
            stat = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace")
        except (
            OSError
        ):  # /proc may hide other users' processes: with hidepid=2 as if there were none
            return UNKNOWN if _exists(pid) else None
        fields = stat.rpartition(")")[2].split()  # the name before may hold anything
        return None if fields[0] == "Z" else fields[_STARTTIME - _STATE]
    import psutil

    try:
        process = psutil.Process(pid)
        zombie = process.status() == psutil.STATUS_ZOMBIE
        return None if zombie else f"{process.create_time() * 100:.0f}"
    except psutil.NoSuchProcess:
        return None
    except psutil.Error:
        return UNKNOWN
