"""Pages link to files beside docs/ (tests, examples), which a site has not: there the name is enough."""

import re


def on_page_markdown(markdown: str, **_: object) -> str:
    """The page without links that leave docs/."""
    return re.sub(r"\[([^\]]+)\]\(\.\./[^)]+\)", r"\1", markdown)
