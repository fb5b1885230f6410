"""Where the command begins and ends: little is loaded here, so that an early Ctrl-C is answered too."""

from __future__ import annotations

import signal
import sys

INTERRUPTED = 130
"""Exit status, as shells have it: 128 and the signal's number."""


def main() -> None:
    """Entry point of the console script."""
    try:
        from flexspline.results.streams import readable_streams

        with readable_streams():
            from flexspline.results.cli import app
            from flexspline.results.scratch import own_scratch

            with own_scratch():
                app()
    except KeyboardInterrupt:
        print("flexspline: interrupted", file=sys.stderr)
        raise SystemExit(INTERRUPTED) from None
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is left to be told about


if __name__ == "__main__":
    main()
