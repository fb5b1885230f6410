"""Where the command begins and ends: little is loaded here, so that an early Ctrl-C is answered too.

A request to end (SIGTERM: a job scheduler, a container that stops) is answered as Ctrl-C is.
"""

from __future__ import annotations

import signal
import sys

INTERRUPTED = 130
TERMINATED = 143
"""Exit statuses, as shells have them: 128 and the signal's number."""


def main() -> None:
    """Entry point of the console script."""
    asked: list[int] = []

    def end(number: int, frame: object) -> None:
        asked.append(number)
        raise KeyboardInterrupt

    try:
        signal.signal(signal.SIGTERM, end)
        from flexspline.results.streams import readable_streams

        with readable_streams():
            from flexspline.results.cli import app
            from flexspline.results.scratch import own_scratch

            with own_scratch():
                app()
    except KeyboardInterrupt:
        print("flexspline: interrupted", file=sys.stderr)
        raise SystemExit(TERMINATED if asked else INTERRUPTED) from None
    except SystemExit as ended:
        if asked and ended.code == INTERRUPTED:
            raise SystemExit(TERMINATED) from None
        raise
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be told about


if __name__ == "__main__":
    main()
