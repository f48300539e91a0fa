"""A front axle: two MacPherson suspensions of the paper that share the rack, with an anti-roll bar.

One side is declared, the right one, and the drop link pulls at its control arm; see `axle`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import axle, macpherson

if TYPE_CHECKING:
    from .. import declare as d

CORNER, *_ = macpherson.MODELS


def mechanism() -> d.Mechanism:
    """Return the axle with its anti-roll bar."""
    title = "Front axle: two MacPherson suspensions, anti-roll bar"
    return axle.mechanism("front_axle", title, CORNER, pulls=macpherson.ARM.name)


def without_bar() -> d.Mechanism:
    """Return the axle without an anti-roll bar."""
    return axle.mechanism("front_axle", "Front axle: two MacPherson suspensions", CORNER)


def model(declared: d.Mechanism, *, with_mass: tuple[str, ...] = ()) -> d.Formulation:
    """Return the equations of one of them, with prescribed rack; see `axle.model`."""
    return axle.model(CORNER, declared, with_mass=with_mass)


MODELS = (model(mechanism()),)
