"""Signals: what a mechanism shows of itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sympy as sp


@dataclass(frozen=True)
class Shown:
    """A signal: an element of what the ``signals`` function returns."""

    name: str
    value: sp.Expr
    unit: str
    meaning: str
