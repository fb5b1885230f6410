"""Exit statuses of the `flexspline` command; from 128 on as in shells: 128 plus the signal's number."""

from __future__ import annotations

FAILED = 1
"""Of a computation that failed, or a disk that is full; Python's own of an error that nobody caught."""
REFUSED = 2
"""Of input that is wrong, and of a command that is used wrongly."""
INTERRUPTED = 130
"""By Ctrl-C: 128 + SIGINT, 2."""
NOBODY_READS = 141
"""Where the reader of a pipe has gone (``| head -1``), as of a tool that SIGPIPE ended. Nothing is said."""
TERMINATED = 143
"""By `kill`, or a job scheduler: 128 + SIGTERM, 15."""
