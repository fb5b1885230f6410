"""Python source as a syntax tree, also while a thread of another test compiles."""

from __future__ import annotations

import ast
from contextlib import suppress

TRIES = 5


def parsed(source: str) -> ast.Module:
    """`ast.parse`, tried again where Python 3.11 fails by itself.

    It counts the depth of a tree once for all threads: one that compiles at the same time makes it raise
    "SystemError: AST constructor recursion depth mismatch" (github.com/python/cpython/issues/106905).
    """
    for _ in range(TRIES):
        with suppress(SystemError):
            return ast.parse(source)
    return ast.parse(source)
