"""What is packed comes back, and bytes from elsewhere make nothing but this package's dataclasses."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from flexspline.fea.solid.bisectable import BisectableMesh
from flexspline.fea.types import MeshLevel, StressPeak
from flexspline.pipeline.packing import packed, unpacked

READS = """
import sys
from pathlib import Path
from flexspline.pipeline.packing import unpacked
found = unpacked(Path(sys.argv[1]).read_bytes())
print(type(found).__name__, found.sector_deg)
"""
PEAK = StressPeak(12.5, (1.0, 2.0, 3.0), "the edges", 0.4, False, None)


def of_text(text: object) -> bytes:
    data = io.BytesIO()
    np.savez(data, json=np.frombuffer(json.dumps(text).encode(), np.uint8))
    return data.getvalue()


def test_nested_values_come_back() -> None:
    found = unpacked(packed({"peak": PEAK, "rows": [np.arange(3), b"abc", None, 1.5, "λ"]}))
    assert found["peak"] == PEAK
    rows = found["rows"]
    assert rows[0].tolist() == [0, 1, 2]
    assert rows[1:] == (b"abc", None, 1.5, "λ")


def test_a_process_that_has_not_met_the_class_reads_it(tmp_path: Path) -> None:
    """As the one that draws, which knows no layers: `run` once left two pictures out for them."""
    empty = np.zeros((0, 3))
    file = tmp_path / "mesh.npz"
    file.write_bytes(packed(BisectableMesh(empty, empty, empty, empty, ("",), 90.0, empty, True)))
    done = subprocess.run(
        [sys.executable, "-c", READS, str(file)], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "BisectableMesh 90.0"


@pytest.mark.parametrize(
    "name",
    [
        "builtins:dict",
        "dataclasses:Field",
        "flexspline.fea.types:np",  # a module
        "flexspline.pipeline.packing:packed",  # a function
        "flexspline.pipeline.parts:Elastic",  # a dataclass, but not where it is made
        "flexspline.fea.types:Nothing",
        "flexsplines.fea.types:MeshLevel",
    ],
)
def test_other_names_are_refused(name: str) -> None:
    with pytest.raises((ValueError, AttributeError)):
        unpacked(of_text({"type": name, "fields": {}}))


def test_a_dataclass_from_elsewhere_does_not_come_back() -> None:
    @dataclass(frozen=True)
    class Own:
        x: int

    with pytest.raises(ValueError, match="not a dataclass of this package"):
        unpacked(packed(Own(1)))


def test_fields_that_a_dataclass_lacks_are_refused() -> None:
    name = f"{MeshLevel.__module__}:{MeshLevel.__name__}"
    with pytest.raises(TypeError):
        unpacked(of_text({"type": name, "fields": {"none of it": 1}}))
