"""Immediate handling of Ctrl-C and SIGTERM.

Python tells the main thread of a signal only when its call into a library returns, and other threads end at
their next stage: seconds. The system tells a file descriptor at once, and a thread reads it.
"""

from __future__ import annotations

import signal
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

AT_ONCE_S = 0.3
"""A command that ends sooner says only that it was interrupted."""
ENDS = frozenset((signal.SIGINT, signal.SIGTERM))


@contextmanager
def answered_at_once() -> Iterator[None]:
    """One line on stderr where a command that is asked to end takes longer than a moment."""
    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    ended = threading.Event()
    listener = threading.Thread(target=_listen, args=(receiver, ended), daemon=True)
    before = signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
    listener.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        ended.set()
        sender.close()
        listener.join()
        receiver.close()


def _listen(receiver: socket.socket, ended: threading.Event) -> None:
    while numbers := receiver.recv(16):
        if ENDS.isdisjoint(numbers):
            continue
        if not ended.wait(AT_ONCE_S):
            with suppress(OSError):  # the reader has gone
                print(
                    "flexspline: stopping after the current step",
                    file=sys.stderr,
                    flush=True,
                )
        return
