"""The parameters of a mechanism with their ranges, as generated modules have them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .assembly import Assembly

_BOUNDS = ("least", "above", "most")


def described(mechanism: Assembly) -> dict[str, dict[str, float | str]]:
    """Return unit, meaning and bounds of every parameter.

    Returns
    -------
    dict
        By name: ``default``, ``unit``, ``meaning``, and ``least``, ``above``, ``most`` as far as
        there are such bounds.
    """
    return {
        p.name: {"default": p.default, "unit": p.unit, "meaning": p.meaning}
        | {bound: value for bound in _BOUNDS if (value := getattr(p, bound)) is not None}
        for p in mechanism.parameters
    }
