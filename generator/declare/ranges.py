"""The parameters of a mechanism with their ranges, as in generated modules."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .assembly import Parts

_BOUNDS = ("least", "above", "most")


def described(mechanism: Parts) -> dict[str, dict[str, float | str]]:
    """Return unit, meaning and bounds of every parameter.

    Returns
    -------
    dict
        By name: ``default``, ``unit``, ``meaning``, and the existing bounds of ``least``, ``above``
        and ``most``.
    """
    found: dict[str, dict[str, float | str]] = {}
    for p in mechanism.parameters:
        found[p.name] = {"default": p.default, "unit": p.unit, "meaning": p.meaning}
        found[p.name] |= {b: value for b in _BOUNDS if (value := getattr(p, b)) is not None}
    return found
