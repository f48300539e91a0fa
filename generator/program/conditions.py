"""Conditions on the constants of a parameter set: some must vanish, others must not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sympy as sp


@dataclass(frozen=True)
class Assumption:
    """A quantity that must be zero.

    Attributes
    ----------
    name
        Of the constant.
    quantity
        The sine of an angle (unit ``1``), or a distance (``m``).
    scale
        Length with which a distance is compared; 1 for an angle.
    meaning, remedy
        Cause of a quantity that is not zero, and its remedy, for the message.
    """

    name: str
    quantity: sp.Expr
    scale: sp.Expr
    unit: str
    meaning: str
    remedy: str


@dataclass(frozen=True)
class Condition:
    """A constant that must not vanish.

    Attributes
    ----------
    quantity
        A distance (unit ``m``), the sine of an angle (``1``), or the rest of a mass after
        elimination; its sign does not matter.
    least
        Lower bound of its absolute value.
    meaning, remedy
        Cause of a smaller value, and its remedy, for the message.
    """

    quantity: sp.Expr
    least: sp.Expr
    unit: str
    meaning: str
    remedy: str
