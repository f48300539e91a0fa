"""How things look in a notebook: pictures and tables instead of `<Model ...>`.

What IPython shows of an object is registered by the name of its class, so that importing kintrafo
loads none of it, and lower floors know nothing of notebooks. Showing one more is one more line
here and a function in `pages`.
"""

import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

_SHOWN = {
    ("kintrafo.suspension.base", "Suspension"): "suspension",
    ("kintrafo.suspension.model", "Model"): "model",
    ("kintrafo.suspension.axle.axle", "Axle"): "axle",
    ("kintrafo.suspension.rigid.axle", "RigidAxle"): "rigid_axle",
    ("kintrafo.simulation.result", "Simulation"): "simulation",
    ("kintrafo.systems.linearisation", "Linearisation"): "linearisation",
    ("kintrafo.systems.system", "System"): "system",
}


def register(formatter: Any = None) -> None:
    """Tell a notebook how to show what is ours.

    Parameters
    ----------
    formatter : IPython.core.formatters.HTMLFormatter, optional
        By default that of the notebook that runs; without one, nothing happens.
    """
    formatter = formatter or _running()
    if formatter is not None:
        for (module, name), page in _SHOWN.items():
            formatter.for_type_by_name(module, name, _page(page))


def _running() -> Any:
    """Return the formatter of the notebook in which this runs; None elsewhere."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return None if shell is None else shell.display_formatter.formatters.get("text/html")


def _page(name: str) -> Callable[[Any], str]:
    """Return what writes a page; it is loaded when the first one is shown."""

    def write(shown: Any) -> str:
        page: str = getattr(import_module(f"{__name__}.pages"), name)(shown)
        return page

    return write
