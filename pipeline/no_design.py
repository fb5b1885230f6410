"""What is given in place of a design: a path, say, where a function wants the design itself."""

from __future__ import annotations

from pathlib import Path

from flexspline.geometry.errors import FlexsplineError, short


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


def require_design(given: object) -> None:
    """Refuse what is not a design, and one made without the checks of `load_design`: by `Design(…)`, say.

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

    if not isinstance(given, Design):
        raise NoDesignError(given)
    design_from(given.tables)
