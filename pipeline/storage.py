"""The cache folder on this machine."""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path:
    """Return `FLEXSPLINE_CACHE` if set, else the user's cache folder by the platform's custom."""
    chosen = os.environ.get("FLEXSPLINE_CACHE")
    if chosen:
        return Path(chosen)
    from platformdirs import user_cache_path

    return user_cache_path("flexspline")
