"""The example design XB1-40 without its bolt holes: a body of revolution."""

from example_files import EXAMPLES

from flexspline.geometry.cup import Cup
from flexspline.geometry.load import load_design


def _revolved() -> Cup:
    cup = load_design(EXAMPLES / "xb1-40.toml").flexspline
    assert isinstance(cup, Cup)
    return cup.model_copy(update={"bolt_count": 0})


CUP = _revolved()
