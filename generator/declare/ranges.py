"""The parameters of a mechanism with their ranges, as in generated modules."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .assembly import Parts

_BOUNDS = ("least", "above", "most")


def described(mechanism: Parts) -> dict[str, dict[str, float | str]]:
    """Return ``default``, ``unit``, ``meaning`` and bounds of every parameter by name.

    Bounds are those of ``least``, ``above`` and ``most`` that exist.
    """
    found: dict[str, dict[str, float | str]] = {}
    for p in mechanism.parameters:
        found[p.name] = {"default": p.default, "unit": p.unit, "meaning": p.meaning}
        found[p.name] |= {b: value for b in _BOUNDS if (value := getattr(p, b)) is not None}
    return found
