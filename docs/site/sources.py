"""Links from pages to files of the repository lead to a page of the site with that file.

On a code host such links work by themselves. The site has none of these files beside it, so it
gets a page for each that is linked.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from pygments.lexers import get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
FOLDER = "sources"

# All that are linked: every build reads all pages anew.
_linked: set[str] = set()


class Sources(SphinxTransform):
    """Turns links to files into links to the pages that show them."""

    # while the page is read, before files to be downloaded are collected
    default_priority = 400

    def apply(self, **_: Any) -> None:
        """Look at the links of one page."""
        top = "../" * self.env.docname.count("/")
        for link in list(self.document.findall(_may_be_a_file)):
            path = self._file_of(link)
            if path is None:
                continue
            _linked.add(path)
            page = nodes.reference(refuri=f"{top}{FOLDER}/{path}.html", internal=True)
            page += link.children
            link.replace_self(page)

    def _file_of(self, link: nodes.Element) -> str | None:
        """Return which file of the repository is meant, or nothing if it is a page of the site."""
        target = str(link["reftarget"])
        if link["refdomain"] == "doc":
            # Markdown is taken for a page of the site, wherever it lies
            file = (DOCS / f"{target}.md").resolve()
            if file.is_relative_to(DOCS):
                return None
        else:
            file = ((DOCS / self.env.docname).parent / target).resolve()
        if not file.is_relative_to(ROOT) or not file.is_file():
            return None
        return file.relative_to(ROOT).as_posix()


def _may_be_a_file(node: nodes.Node) -> bool:
    return isinstance(node, addnodes.download_reference) or (
        isinstance(node, addnodes.pending_xref) and node.get("refdomain") == "doc"
    )


def _language(path: str) -> str:
    try:
        return str(get_lexer_for_filename(path).aliases[0])
    except ClassNotFound:
        return "none"


def _pages(app: Sphinx) -> Iterator[tuple[str, dict[str, str], str]]:
    for path in sorted(_linked):
        text = (ROOT / path).read_text(encoding="utf-8")
        shown = app.builder.highlighter.highlight_block(text, _language(path), location=path)
        yield f"{FOLDER}/{path}", {"title": path, "body": f"<h1>{path}</h1>{shown}"}, "page.html"


def setup(app: Sphinx) -> dict[str, bool]:
    """Register what is done while pages are read, and when they are written."""
    app.add_transform(Sources)
    app.connect("html-collect-pages", _pages)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
