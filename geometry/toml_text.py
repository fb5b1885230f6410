"""Values and text in TOML syntax."""

from __future__ import annotations

import json
from typing import Any

from flexspline.geometry.errors import readable

TomlTable = dict[str, Any]


def quoted(text: str) -> str:
    """A basic string of TOML; JSON's escapes are among TOML's, but for DEL and lone surrogates."""
    whole = readable(text).encode("utf-8", "replace").decode()
    return json.dumps(whole, ensure_ascii=False).replace("\x7f", "\\u007f")
