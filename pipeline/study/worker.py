"""The worker process of a local study: it reads calls from a pipe and returns their results.

Nothing listens, so nobody but the process that started it can give it work: calls come on its standard
input, answers go to its standard output, each a frame of eight bytes of length and that many of pickle.
What else would be printed goes to standard error.
"""

from __future__ import annotations

import os
import pickle
import queue
import struct
import threading
import traceback
from collections.abc import Callable
from typing import BinaryIO

READY = b"ready"
"""The first frame that a worker sends."""
_LENGTH = struct.Struct("<Q")


def serve() -> None:
    """Answer calls until standard input ends, one at a time."""
    calls, answers = _pipes()
    waiting: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(calls, waiting.put), daemon=True).start()
    write_frame(answers, READY)
    while True:
        write_frame(answers, answer(waiting.get()))


def answer(call: bytes) -> bytes:
    """Carry out a pickled (function, arguments); return (True, its result) or (False, its error), pickled."""
    try:
        function, arguments = pickle.loads(call)
        return pickle.dumps((True, function(*arguments)))
    except Exception as fault:
        trace = traceback.format_exc()
        try:
            fault.add_note(trace)
            reply = pickle.dumps((False, fault))
            pickle.loads(reply)  # an error that asks for more than a message cannot be made again
        except Exception:
            reply = pickle.dumps((False, RuntimeError(trace)))
        return reply


def write_frame(stream: BinaryIO, data: bytes) -> None:
    """Send a frame at once."""
    stream.write(_LENGTH.pack(len(data)) + data)
    stream.flush()


def read_frame(stream: BinaryIO) -> bytes | None:
    """Return the next frame; None where the stream ends."""
    head = stream.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        return None
    (length,) = _LENGTH.unpack(head)
    data = stream.read(length)
    return data if len(data) == length else None


def _listen(calls: BinaryIO, put: Callable[[bytes], None]) -> None:
    """Take calls while there are any; without whoever started us nobody wants the answer at hand."""
    while (call := read_frame(calls)) is not None:
        put(call)
    os._exit(0)


def _pipes() -> tuple[BinaryIO, BinaryIO]:
    """Standard input and output, taken out of the reach of libraries and of our own children."""
    calls, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    return calls, answers
