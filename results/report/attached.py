"""Input files attached to a report, byte for byte."""

from __future__ import annotations

import base64
import hashlib
from dataclasses import dataclass

from flexspline.results.numbers import grouped

TOML = "application/toml"
SAFE = str.maketrans({c: "_" for c in '/\\:*?"<>|'})
"""Letters that some system does not take in a file's name."""


@dataclass(frozen=True)
class Attachment:
    """A text file in UTF-8 as it was read; `about` says what it is."""

    name: str
    data: bytes
    about: str

    @property
    def safe_name(self) -> str:
        """The name that the file has in the PDF and as a download."""
        plain = "".join(c if c.isprintable() else "_" for c in self.name.translate(SAFE))
        return plain.lstrip(".") or "file"

    @property
    def size(self) -> str:
        return f"{grouped(len(self.data), 0)} bytes"

    @property
    def sha256(self) -> str:
        return hashlib.sha256(self.data).hexdigest()

    @property
    def text(self) -> str:
        """Its letters, without a mark at the start."""
        return self.data.decode("utf-8-sig", "replace")

    @property
    def uri(self) -> str:
        return f"data:{TOML};base64,{base64.b64encode(self.data).decode()}"
