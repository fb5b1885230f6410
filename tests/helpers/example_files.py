"""Where the designs, studies and measured files lie that come with the program."""

from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"
