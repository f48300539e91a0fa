"""Display of objects in a notebook: pictures and tables instead of ``<Model ...>``.

Pages are registered with IPython by names of classes: importing kintrafo loads none of them, and
other packages do not depend on notebooks. Another object needs a line here and a function in
`pages`; objects of a higher folder are added by `show`.
"""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

_PAGES = f"{__name__}.pages"
_SHOWN = {
    ("kintrafo.simulation.result", "Simulation"): (_PAGES, "simulation"),
    ("kintrafo.systems.linearisation", "Linearisation"): (_PAGES, "linearisation"),
    ("kintrafo.systems.system", "System"): (_PAGES, "system"),
}
"""By module and name of a class: module and name of the function that writes its page."""


def show(pages: Mapping[tuple[str, str], tuple[str, str]]) -> None:
    """Register pages for more classes, or other pages for these.

    `pages` have, by module and name of a class, module and name of the function that writes its
    page.
    """
    _SHOWN.update(pages)
    register()


def register(formatter: Any = None) -> None:
    """Register the pages with a formatter of IPython, by default that of the running notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if formatter is None and shell is not None:
        formatter = shell.display_formatter.formatters.get("text/html")
    if formatter is not None:
        for (module, name), page in _SHOWN.items():
            formatter.for_type_by_name(module, name, _page(*page))


def _page(module: str, name: str) -> Callable[[Any], str]:
    """Return a function that writes a page; its module is loaded for the first page."""

    def write(shown: Any) -> str:
        return getattr(import_module(module), name)(shown)

    return write
