"""The site that `make docs` makes of these pages."""

import sys
from importlib.metadata import version as version_of
from pathlib import Path

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent / "site"))

project = "kintrafo"
author = "The kintrafo developers"
project_copyright = author
version = release = version_of("kintrafo")

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "commands",
    "gallery",
    "sources",
]
exclude_patterns = ["images", "site"]

# Headings have the anchors that a code host gives them.
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

# Types stand in the sections of the docstrings, in words; signatures stay short without them.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
toc_object_entries_show_parents = "hide"
numpydoc_show_class_members = False
# Single backquotes name functions and arguments alike: the first become links, the others code.
default_role = "py:obj"

# What stands indented is a formula.
highlight_language = "none"

nitpicky = True
nitpick_ignore_regex = [
    ("py:obj", r"(?!kintrafo\.).*"),  # what is between single backquotes, see above
    # the floors inside, which have no pages
    ("py:obj", r"kintrafo\.(core|datasets|pictures|vehicle)\..*"),
]

html_theme = "pydata_sphinx_theme"
html_title = "kintrafo"
html_static_path = ["site/site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
# Pages without others below them.
html_sidebars = {page: [] for page in ("index", "contributing", "changelog")}
html_theme_options = {
    "header_links_before_dropdown": 8,
    "navbar_align": "left",
    "navigation_depth": 2,
    "show_nav_level": 1,
    "show_toc_level": 1,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}


def setup(app: Sphinx) -> None:
    """Name the language of tables, for which there are no colours."""
    app.add_lexer("csv", TextLexer)
