"""Checks of the design that is passed to the Python functions: a design, not a path."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING
from warnings import warn

from flexspline.geometry.errors import FlexsplineError, short

if TYPE_CHECKING:
    from flexspline.geometry.design import Design


class NoDesignError(FlexsplineError, TypeError):
    """A function was given something else than a design; `given` is that."""

    def __init__(self, given: object) -> None:
        self.given = given
        if isinstance(given, str | Path):
            name = short(str(given))
            said = f"{name} is a name; load the design first: flexspline.load_design({name})"
        else:
            said = f"a {type(given).__name__} is not a design; flexspline.load_design reads one from a file"
        super().__init__(f"design: {said}")


class DesignWarning(UserWarning):
    """Warns of an unusual design, in the commands' words."""


def require_design(given: object) -> None:
    """Refuse what is not a design, and one made without the checks of `load_design`: by `Design(…)`, say.

    What is unusual in it is a `DesignWarning` at the line that called the function of `import flexspline`.

    Raises
    ------
    NoDesignError, DesignError

    Examples
    --------
    >>> try:
    ...     require_design("cup.toml")
    ... except FlexsplineError as fault:
    ...     print(fault)
    design: "cup.toml" is a name; load the design first: flexspline.load_design("cup.toml")
    """
    from flexspline.geometry.design import Design  # loads pydantic
    from flexspline.geometry.load import design_from
    from flexspline.geometry.sanity import warnings as unusual_in

    if not isinstance(given, Design):
        raise NoDesignError(given)
    for unusual in unusual_in(design_from(given.tables)):
        warn(unusual, DesignWarning, stacklevel=3)


def warn_of_first_face(design: Design) -> None:
    """Warn that K_e is too large, by a `DesignWarning` at the same line."""
    from flexspline.pipeline.first_face import too_large_lines

    for line in too_large_lines(design):
        warn(line, DesignWarning, stacklevel=3)
