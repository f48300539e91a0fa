"""Conditions on the constants of a parameter set: some must vanish, others must not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sympy as sp


@dataclass(frozen=True)
class Assumption:
    """A quantity that must be zero."""

    name: str  # of the constant
    quantity: sp.Expr  # sine of an angle (unit `1`), or a distance (`m`)
    scale: sp.Expr  # length with which a distance is compared; 1 for an angle
    unit: str
    # cause of a quantity that is not zero, and its remedy, for the message
    meaning: str
    remedy: str


@dataclass(frozen=True)
class Condition:
    """A constant that must not vanish."""

    # distance (unit `m`), the sine of an angle (`1`), or the rest of a mass after elimination; its
    # sign does not matter
    quantity: sp.Expr
    least: sp.Expr  # lower bound of its absolute value
    unit: str
    # cause of a smaller value, and its remedy, for the message
    meaning: str
    remedy: str
