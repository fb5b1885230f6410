"""Entry point of the command: it imports little, so that an early Ctrl-C is handled too.

A request to end (SIGTERM: a job scheduler, a container that stops) is answered as Ctrl-C is.
"""

from __future__ import annotations

import gc
import os
import signal
import sys

from flexspline.results.exit_status import INTERRUPTED, TERMINATED

THREADS = {"OPENBLAS_NUM_THREADS": "1", "KMP_BLOCKTIME": "0"}
"""For a command and what it starts, where the user has set nothing. Matrices of BLAS are small, and its
threads wait for each other in a loop that keeps a core busy; MKL's, of large sparse matrices, would do so for
0.2 s after each. `flexspline stiffness examples/xb1-40.toml` takes 6.6 s of processor time, 7.6 without."""
CHARTS = {"MPLBACKEND": "agg"}
"""For the same, whatever the user has set: matplotlib draws into files here, and refuses to load where the
variable names a backend that is not installed, as Jupyter's does for the commands that it starts."""
NEW_OBJECTS = 20_000
"""From one search for circular garbage to the next (Python: 700), as objects here are many and live long. It
saves 3 % of `flexspline run examples/xb1-40.toml` and takes no more memory."""


def main() -> None:
    """Entry point of the console script."""
    signals: list[int] = []
    for name, value in THREADS.items():  # before the libraries are loaded, which read it once
        os.environ.setdefault(name, value)
    os.environ.update(CHARTS)
    gc.set_threshold(NEW_OBJECTS)

    def end(number: int, frame: object) -> None:
        signals.append(number)
        raise KeyboardInterrupt

    try:
        signal.signal(signal.SIGTERM, end)
        from flexspline.results.stopping import answered_at_once
        from flexspline.results.streams import readable_streams

        with readable_streams(), answered_at_once():
            from flexspline.results.cli import app
            from flexspline.results.scratch import own_scratch

            with own_scratch():
                app()
    except KeyboardInterrupt:
        print("flexspline: interrupted", file=sys.stderr)
        raise SystemExit(TERMINATED if signals else INTERRUPTED) from None
    except SystemExit as ended:
        if signals and ended.code == INTERRUPTED:
            raise SystemExit(TERMINATED) from None
        raise
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be told about
        gc.freeze()  # the system takes all memory back at once; a last search through it takes 0.1 s and more


if __name__ == "__main__":
    main()
