"""ES modules joined into one script, for a page that opens from a folder and cannot import files.

Each module becomes a function that returns what it exports; the live page is served the same files as
they are. So the report's policy allows its one script by its hash, and no address.
"""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files

VENDORED = ("three.core.min.js", "three.module.min.js", "OrbitControls.js")
SHARED = ("arrays.js", "colour_bar.js", "part_scene.js")

_NAMES = re.compile(
    r"""(?:^|(?<=[;}]))(import|export)\s*(\{[^{}]*\}|\*\sas\s\w+)(?:\s*from\s*["']\./([\w.]+)["'])?;""",
    re.M,
)
"""A statement that imports names, exports them or passes them on; minified files have several in a line."""
_DECLARED = re.compile(r"^export (?=(?:class|function|const) (\w+))", re.M)


@cache
def script_3d() -> str:
    """three.js and what both pages share, each module before those that import it."""
    folder = files("flexspline.results.page_3d")
    places = [folder / "vendor" / name for name in VENDORED] + [folder / name for name in SHARED]
    return "".join(in_function(p.name, p.read_text(encoding="utf-8")) for p in places)


def in_function(name: str, module: str) -> str:
    """A module as `const name_js = (() => { …; return {its exports}; })();`."""
    given: list[str] = []

    def bound(match: re.Match[str]) -> str:
        word, names, source = match.groups()
        if word == "import":
            taken = names.removeprefix("* as ").replace(" as ", ": ")
            return f"const {taken} = {_constant(source)};"
        for inner, _, outer in (n.strip().partition(" as ") for n in names[1:-1].split(",")):
            value = f"{_constant(source)}.{inner}" if source else inner
            given.append(f"{outer or inner}: {value}")
        return ""

    def declared(match: re.Match[str]) -> str:
        given.append(match[1])
        return ""

    body = _DECLARED.sub(declared, _NAMES.sub(bound, module))
    return (
        f"const {_constant(name)} = (() => {{\n{body}\nreturn {{ {', '.join(given)} }};\n}})();\n"
    )


def _constant(name: str) -> str:
    return name.replace(".", "_")
