"""Exit statuses of the `flexspline` command; from 128 on as in shells: 128 plus the signal's number."""

from __future__ import annotations

FAILED = 1
"""The computation failed, or the disk is full. Python uses the same status for an uncaught error."""
REFUSED = 2
"""The input is wrong, or the command is used wrongly."""
INTERRUPTED = 130
"""Ended by Ctrl-C: 128 + SIGINT, 2."""
NOBODY_READS = 141
"""The reader of the pipe has ended (``| head -1``): the same status as of a tool that SIGPIPE ended. No
message."""
TERMINATED = 143
"""Ended by `kill` or by a job scheduler: 128 + SIGTERM, 15."""
