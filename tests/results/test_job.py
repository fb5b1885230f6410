"""What commands share: lines on stderr."""

import subprocess
import sys

TWO_SPEAKERS = """
from threading import Thread
from flexspline.results.job import tell
speakers = [Thread(target=lambda: [tell("a line") for _ in range(5000)]) for _ in range(2)]
for speaker in speakers:
    speaker.start()
for speaker in speakers:
    speaker.join()
"""


def test_lines_of_two_threads_do_not_mix() -> None:
    done = subprocess.run(
        [sys.executable, "-c", TWO_SPEAKERS], capture_output=True, text=True, check=True
    )
    assert done.stderr.splitlines() == ["a line"] * 10000
