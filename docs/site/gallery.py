"""Pictures of axles without sides, beside those that the gallery has: the first of each page."""

import re
from collections.abc import Iterator
from pathlib import Path

from kintrafo.vehicle.data.starter import whole_axles
from sphinx.application import Sphinx

DOCS = Path(__file__).resolve().parents[1]
PAGE = "get-started/gallery"
_PICTURE = re.compile(r"^!\[[^\]]*\]\([^)]+\)$", re.MULTILINE)
# The end of the first group of pictures, that of suspensions.
_END = "\n:::\n"


def with_axles(text: str) -> str:
    """Return the text of the gallery with the axles that have a page and no picture there."""
    missing = [entry for page, entry in _entries() if page not in text]
    return text.replace(_END, "".join([f"\n{entry}" for entry in missing]) + _END, 1)


def _entries() -> Iterator[tuple[str, str]]:
    for key in whole_axles():
        page = f"suspension/{key.replace('_', '-')}.md"
        file = DOCS / page
        if not file.exists():
            continue
        content = file.read_text(encoding="utf-8")
        picture = _PICTURE.search(content)
        if picture is not None:
            title = content.partition("\n")[0].removeprefix("# ")
            yield page, f"- {picture[0]}\n  [{title}](../{page})"


def _read(app: Sphinx, name: str, source: list[str]) -> None:
    del app
    if name == PAGE:
        source[0] = with_axles(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Change the page as it is read."""
    app.connect("source-read", _read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
