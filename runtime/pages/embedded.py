"""Templates of pages, and the data and files that are embedded in a page."""

import json
from importlib import resources
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup


def page_environment(package: str) -> Environment:
    """Return the environment for the templates in a package."""
    return Environment(
        loader=PackageLoader(package, "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def asset(package: str, name: str) -> Markup:
    """Return a script or a style sheet, by its path in a package, to be embedded in a page."""
    text = resources.files(package).joinpath(*name.split("/")).read_text(encoding="utf-8")
    return Markup(text)  # noqa: S704 (a file of kintrafo)


def moving_script() -> Markup:
    """Return the script by which pages turn a picture and play a motion."""
    return asset(__package__, "moving.js")


def embedded(data: Any) -> Markup:
    r"""Return data as JSON that is safe in an element of a page, for any texts.

    ``</script>`` in a text would end the element with the data, and ``<!--`` with ``<script`` would
    hide its own end. So every ``<`` is escaped.

    Examples
    --------
    >>> print(embedded({"meaning": "<!-- <script>"}))
    {"meaning": "\u003c!-- \u003cscript>"}
    """
    text = json.dumps(data, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    return Markup(text)  # noqa: S704 (no tag is left in it)
