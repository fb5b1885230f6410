"""Errors of measured data; each is one printable line that names the file, the line and the reason."""

from __future__ import annotations

from pathlib import Path

from flexspline.geometry.errors import FlexsplineError, one_line


class MeasurementError(FlexsplineError, ValueError):
    """A measurement file that cannot be accepted; `path`, `line` (1-based, None: the whole file)."""

    def __init__(self, path: Path | str, line: int | None, reason: str) -> None:
        self.path, self.line, self.reason = str(path), line, reason
        where = self.path if line is None else f"{self.path}:{line}"
        super().__init__(f"{one_line(where)}: {one_line(reason)}")


class ModelFileError(FlexsplineError, ValueError):
    """An extended model file that cannot be used; `path` and why."""

    def __init__(self, path: Path | str, reason: str) -> None:
        self.path, self.reason = str(path), reason
        super().__init__(f"{one_line(self.path)}: {one_line(reason)}")


class ChannelError(FlexsplineError, ValueError):
    """A channel of a torque history that a model cannot use; its `name` and why."""

    def __init__(self, name: str, reason: str) -> None:
        self.name, self.reason = name, reason
        super().__init__(f"{name} {reason}")
