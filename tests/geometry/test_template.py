"""The commented templates load, mention every key of the schema, and their comments are its own."""

from __future__ import annotations

import json
import re
import tomllib

import pytest
from example_files import EXAMPLES

from flexspline.geometry.design import Design
from flexspline.geometry.load import design_from, load_design
from flexspline.geometry.sanity import warnings
from flexspline.geometry.schema import json_schema, resolved
from flexspline.geometry.shapes import KINDS
from flexspline.geometry.template import design_text, template

UNIT = re.compile(r"_(mm|um|GPa|MPa|Nm|deg|pct)$")


def leaves(node: dict, kind: str) -> set[str]:
    """Every key below a node of the schema."""
    node = resolved(node, kind)
    if node.get("type") == "array":
        return leaves(node["items"], kind)
    found = set(node.get("properties", {}))
    return found.union(*(leaves(n, kind) for n in node.get("properties", {}).values()))


@pytest.mark.parametrize("kind", KINDS)
def test_template_loads_without_a_warning(kind: str) -> None:
    design = design_from(tomllib.loads(template(kind)))
    assert design.flexspline.kind == kind
    assert warnings(design) == ()


def test_the_first_cup_is_the_example_but_for_the_shafts_diameter() -> None:
    first = design_from(tomllib.loads(template("cup")))
    example = load_design(EXAMPLES / "xb1-40.toml").changed(
        {
            "name": first.name,
            "shaft.segment[1].outer_diameter_mm": 17.0,
            "material.flexspline.density_kg_per_m3": 7850.0,  # said to be steel's where not stated
        }
    )
    assert example.tables == first.tables


@pytest.mark.parametrize("kind", KINDS)
def test_template_loads_with_its_optional_keys_too(kind: str) -> None:
    text = re.sub(r"(?m)^# (?=\[|\w+ = )", "", template(kind))
    design = design_from(tomllib.loads(text))
    assert design.shaft.keyway
    assert design.material.shaft
    assert design.material.circular_spline
    assert design.material.bearing
    assert design.solver.edge_length_mm


@pytest.mark.parametrize("kind", KINDS)
def test_template_comments_every_key_of_the_schema(kind: str) -> None:
    keys = leaves(json_schema(), kind)
    assert {"wall_thickness_mm", "depth_mm", "edge_length_mm", "youngs_modulus_GPa"} < keys
    for key in keys - {"flexspline", "shaft", "material", "gear", "bearing", "load", "uncertainty"}:
        if key in ("solver", "segment", "keyway", "wave_generator", "circular_spline"):
            assert re.search(
                rf"(?m)^(# )?\[+((shaft|material)\.)?{key}\]+ +# \w", template(kind)
            ), key
        else:
            assert re.search(rf"(?m)^(# )?{key} = .* # \S", template(kind)), key


def test_schema_describes_every_key_with_its_unit() -> None:
    for name, table in json_schema()["$defs"].items():
        for key, node in table["properties"].items():
            unit = UNIT.search(key)
            if unit:
                spelled = {"um": "µm", "Nm": "N·m", "pct": "%"}.get(unit[1], unit[1])
                assert node["description"].startswith(spelled), f"{name}.{key}"


def test_schema_is_json_and_forbids_unknown_keys() -> None:
    schema = json.loads(json.dumps(json_schema()))
    assert schema["additionalProperties"] is False
    assert all(t["additionalProperties"] is False for t in schema["$defs"].values())
    assert set(schema["properties"]) == set(Design.model_fields)


NAMES = ('a "quoted" \\ name', "<script>alert(1)</script>", "é € 𝛼 # [x]")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_design_written_and_read_is_the_same_design(kind: str, name: str) -> None:
    text = re.sub(r"(?m)^# (?=\[|\w+ = )", "", template(kind))
    tables = tomllib.loads(text)
    tables["name"] = name
    tables["flexspline"]["wall_thickness_mm"] = 0.1 + 0.2  # no short decimal
    design = design_from(tables)
    assert design_from(tomllib.loads(design_text(design))) == design


def test_what_a_design_leaves_out_stays_out() -> None:
    design = design_from(tomllib.loads(template("cup")))
    assert design.shaft.keyway is None
    assert "keyway" not in design_text(design)
