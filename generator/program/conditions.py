"""What the constants of a parameter set must fulfil: some must vanish, others must not."""

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
        The length that a distance is compared with; 1 for an angle.
    meaning, remedy
        What it means that it is not zero, and what to do then.
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
        A distance (unit ``m``), the sine of an angle (``1``), or what is left of a mass; its sign
        does not matter.
    least
        What its amount must exceed.
    meaning, remedy
        What it means that it does not, and what to do then.
    """

    quantity: sp.Expr
    least: sp.Expr
    unit: str
    meaning: str
    remedy: str
