"""Sums over the connected bodies on a base."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...program.vectors import NO_TWIST, ZERO, SymmetricTensor, Twist, Vector
from .flow import NONE, Flow
from .hinged import Hinged
from .in_plane import in_plane
from .moving import MovingBody
from .shifted import Shifted

if TYPE_CHECKING:
    from collections.abc import Iterable

    import sympy as sp

    from ...kinematics.carried import Carried
    from ..inertia import SpatialInertia


def kind_of(carried: Carried) -> type[Shifted | Hinged | MovingBody]:
    """Return the description of a body with the fewest operations."""
    fitting = (kind for kind in (Hinged, Shifted) if kind.fits(carried))
    return next(fitting, MovingBody)


@dataclass
class Sums:
    """Sums over the bodies of one part, about O and in the axes of the base."""

    # M, C and S
    mass: sp.Expr = NONE
    first: Vector = ZERO
    second: SymmetricTensor = field(default_factory=SymmetricTensor.zero)
    # those of each coordinate, and of all rates
    flows: dict[str, Flow] = field(default_factory=dict)
    now: Flow = field(default_factory=Flow)
    own: Twist = NO_TWIST  # h'' and P''
    # `∫ r_k' . r_l' dm`, b_k and X_k.
    matrix: dict[tuple[str, str], sp.Expr] = field(default_factory=dict)
    bias: dict[str, sp.Expr] = field(default_factory=dict)
    across: dict[str, Vector] = field(default_factory=dict)

    def add(self, carried: Carried, inertia: SpatialInertia, names: Iterable[str]) -> None:
        """Add a body, with its inertia about its origin in its axes; `names` need equations."""
        inertia = in_plane(carried, inertia)
        body: Any = kind_of(carried)(carried, inertia)  # each kind has columns of its own
        self.mass += inertia.mass
        self.first += body.first
        self.second += body.second
        columns = {k: body.column(k) for k in carried.relative.motion}
        if not columns:
            return
        if len(columns) == 1:
            ((k, column),) = columns.items()
            now = column * carried.part.coordinates.rate(k)
        else:
            now = body.column(None)
        taken = body.taken(now)
        self.now += now.flow
        self.own += taken.wrench
        rows = [k for k in names if k in columns]
        for i, k in enumerate(rows):
            column = columns[k]
            self.flows[k] = self.flows.get(k, Flow()) + column.flow
            self.bias[k] = self.bias.get(k, NONE) + body.work(column, taken)
            for other in rows[i:]:
                energy = body.energy(column, columns[other])
                self.matrix[k, other] = self.matrix.get((k, other), NONE) + energy
            if len(columns) > 1:
                self.across[k] = self.across.get(k, ZERO) + body.across(now, column)
