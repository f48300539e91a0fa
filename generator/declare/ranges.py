"""The ranges of a mechanism's parameters, from what reads them.

A law says of its rate that it is not negative (`declared.Bounds`), and a body that has a mass says
so of that; a parameter may say more. So nobody has to repeat what is clear from the role.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, get_type_hints

import sympy as sp

from ..program.vectors import ELEMENTS
from .declared import Bounds, parts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .assembly import Assembly

_NOT_NEGATIVE = Bounds(least=0.0)


def described(mechanism: Assembly) -> dict[str, dict[str, float | str]]:
    """Return unit, meaning and bounds of every parameter, as generated modules have them.

    Returns
    -------
    dict
        By name: ``default``, ``unit``, ``meaning``, and ``least``, ``above``, ``most`` as far as
        there are such bounds.
    """
    found: dict[str, dict[str, float | str]] = {
        p.name: {"default": p.default, "unit": p.unit, "meaning": p.meaning}
        for p in mechanism.parameters
    }
    own = ((p.name, Bounds(least=p.least, most=p.most)) for p in mechanism.parameters)
    for name, bounds in (*_bounds(mechanism), *own):
        entry = found.get(_read(mechanism, name), {})
        for key in ("least", "above", "most"):
            bound, known = getattr(bounds, key), entry.get(key)
            if bound is not None:
                stricter = min if key == "most" else max
                entry[key] = bound if known is None else stricter(bound, known)
    return found


def _read(mechanism: Assembly, name: str) -> str:
    """Return the parameter that a name stands for; nothing where it is an expression in several."""
    meant = mechanism.derived.get(name, sp.Symbol(name))
    return str(meant) if meant.is_Symbol else ""


def _bounds(mechanism: Assembly) -> Iterator[tuple[str, Bounds]]:
    for body in mechanism.bodies:
        yield f"{body.name}_mass", _NOT_NEGATIVE
        for element in (*ELEMENTS[:3], "spin", "diametral"):
            yield f"{body.name}_inertia_{element}", _NOT_NEGATIVE
    for joint in mechanism.joints:
        yield from _of_fields(joint, turns=False)
    for force in mechanism.forces:
        for part in parts(force):
            yield from _of_fields(part, turns=force.turns)


def _of_fields(part: object, *, turns: bool) -> Iterator[tuple[str, Bounds]]:
    """Yield the names of parameters in the fields of something, with their bounds."""
    hints = get_type_hints(type(part), include_extras=True)
    for entry in fields(part):  # type: ignore[arg-type]  # every part is a dataclass
        for hint in (hints[entry.name], *getattr(hints[entry.name], "__args__", ())):
            for bounds in getattr(hint, "__metadata__", ()):
                if isinstance(bounds, Bounds) and not (bounds.of_length and turns):
                    name = getattr(part, entry.name)
                    if name is not None:
                        yield name, bounds
