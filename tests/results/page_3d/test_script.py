"""ES modules as one script: what they export is what a browser's own modules would."""

import re
from importlib.resources import files

import pytest
from browser import chromium

from flexspline.results.page_3d.script import SHARED, VENDORED, in_function, script_3d

FIRST = "const a=1,b=2;class C{static of=5}export{a as one,b,C};"
SECOND = """// import { no } from "./first.js" is a comment's
import {
\tone as two,
\tC
} from './first.js'; // with words after it
import * as ALL from "./first.js";
export const three = two + ALL.b;
export class D extends C {}
export function four() { return three + 1; }
"""
THIRD = (
    'import{three as e,four}from"./second.js";export{D,D as E}from"./second.js";'
    "const s=e+four();export{s as sum};"
)


@pytest.fixture(scope="module")
def page():
    with chromium() as browser:
        yield browser.new_page()


def test_modules_find_each_other(page):
    modules = {"first.js": FIRST, "second.js": SECOND, "third.js": THIRD}
    script = "".join(in_function(name, text) for name, text in modules.items())
    asked = "[third_js.sum, third_js.D.of, third_js.E.of, Object.keys(second_js).join()]"
    assert page.evaluate(f"() => {{ {script} return {asked}; }}") == [7, 5, 5, "three,D,four"]


def test_three_js_is_whole(page):
    """All that its files export, as many as they name."""
    script = script_3d()
    assert not re.search(r"(?:^|[;}])(?:import|export)\b", script, re.M)
    assert "</script" not in script
    assert "<!--" not in script  # begins a comment inside a script
    counted = "[Object.keys(three_core_min_js).length, Object.keys(three_module_min_js).length]"
    folder = files("flexspline.results.page_3d") / "vendor"
    named = [
        sum(len(names.split(",")) for names in re.findall(r"export\{([^}]*)\}", text))
        for text in ((folder / name).read_text(encoding="utf-8") for name in VENDORED[:2])
    ]
    assert page.evaluate(f"() => {{ {script} return {counted}; }}") == named
    assert min(named) > 100


def test_every_shared_module_is_in_the_script():
    folder = files("flexspline.results.page_3d")
    assert {p.name for p in folder.iterdir() if p.name.endswith(".js")} == set(SHARED)
    vendored = {p.name for p in (folder / "vendor").iterdir() if p.name.endswith(".js")}
    assert vendored == set(VENDORED)
