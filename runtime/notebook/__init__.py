"""How things look in a notebook: pictures and tables instead of `<Model ...>`.

What IPython shows of an object is registered by the name of its class, so that importing kintrafo
loads none of it, and lower floors know nothing of notebooks. Showing one more is one more line
here and a function in `pages`; objects of a higher floor are added by `show`.
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
"""By module and name of a class, module and name of the function that writes its page."""


def show(pages: Mapping[tuple[str, str], tuple[str, str]]) -> None:
    """Show objects of more classes, or some in another way.

    Parameters
    ----------
    pages : mapping
        By module and name of a class, module and name of the function that writes its page.
    """
    _SHOWN.update(pages)
    register()


def register(formatter: Any = None) -> None:
    """Register how a notebook shows objects of kintrafo.

    Parameters
    ----------
    formatter : IPython.core.formatters.HTMLFormatter, optional
        By default that of the notebook that runs; without one, nothing happens.
    """
    formatter = formatter or _running()
    if formatter is not None:
        for (module, name), page in _SHOWN.items():
            formatter.for_type_by_name(module, name, _page(*page))


def _running() -> Any:
    """Return the formatter of the notebook in which this runs; None elsewhere."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return None if shell is None else shell.display_formatter.formatters.get("text/html")


def _page(module: str, name: str) -> Callable[[Any], str]:
    """Return what writes a page; it is loaded when the first one is shown."""

    def write(shown: Any) -> str:
        page: str = getattr(import_module(module), name)(shown)
        return page

    return write
