"""The printed equations of a mechanism, with numbers whose changes are imaginary.

Where a program is given ``x + 1e-40j d``, the imaginary part of what it returns is its derivative
along d: changes are too small to matter, and nothing is subtracted.
"""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import kintrafo
import numpy as np

if TYPE_CHECKING:
    import pytest
    from kintrafo.generator import Formulation

STEP = 1e-40j


def printed(mechanism: Formulation, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the module of NumPy's functions, which takes complex numbers."""
    equations = kintrafo.compile(mechanism, backend="numpy")
    module: Any = sys.modules[f"{equations.__name__.rpartition('.')[0]}._{equations.NAME}"]
    sign = {"copysign": lambda size, of: np.copysign(size, of.real)}
    monkeypatch.setattr(module, "np", SimpleNamespace(**vars(np) | sign))
    return module
