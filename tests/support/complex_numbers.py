"""The printed equations of a mechanism, with numbers whose changes are imaginary.

Where a program is given ``x + 1e-40j d``, the imaginary part of what it returns is its derivative
along d: changes are too small to matter, and nothing is subtracted.
"""

import sys
from types import SimpleNamespace

import kintrafo
import numpy as np

STEP = 1e-40j


def printed(mechanism, monkeypatch):
    """Return the module of NumPy's functions, which takes complex numbers."""
    equations = kintrafo.compile(mechanism, backend="numpy")
    module = sys.modules[f"{equations.__name__.rpartition('.')[0]}._{equations.NAME}"]
    sign = {"copysign": lambda size, of: np.copysign(size, of.real)}
    monkeypatch.setattr(module, "np", SimpleNamespace(**vars(np) | sign))
    return module
