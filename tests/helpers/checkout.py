"""flexspline from the checkout where it is not installed: tests that read its text need nothing else.

An installed one comes first, so that the suite tries what was installed. To be imported before it.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from pathlib import Path

INSTALLED = find_spec("flexspline") is not None

if not INSTALLED:
    link = str(Path(__file__).parents[2] / ".ci" / "editable")
    sys.path.insert(0, link)
    # for the processes that tests start
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [link, os.environ.get("PYTHONPATH")]))
