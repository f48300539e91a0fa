"""Sums over the connected bodies on a base."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ...program.vectors import NO_TWIST, ZERO, SymmetricTensor, Twist, Vector
from .flow import HALF, NONE, Flow
from .hinged import Hinged
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


def in_plane(carried: Carried, inertia: SpatialInertia) -> SpatialInertia:
    """Return the inertia of a body, or of a lamina with the same equations in a plane.

    If base and body turn about one direction only, the second moments along the plane enter the
    equations only by their sum, which is the moment of inertia about the normal of the plane. Each
    of the two is replaced by half of that moment, and products of inertia by zero.
    """
    normal = _normal(twist.angular for twist in carried.base.twists.values())
    along = None if normal is None else _along(carried.axes, normal)
    if along is None:
        return inertia
    moment = tuple(inertia.tensor)[along]
    xx, yy, zz = (moment if i == along else HALF * moment for i in range(3))
    return replace(inertia, tensor=SymmetricTensor(xx, yy, zz, NONE, NONE, NONE))


def _normal(turning: Iterable[Vector]) -> int | None:
    """Return the one axis of a base about which its motions turn, or None."""
    turned = {i for omega in turning for i, part in enumerate(omega) if part != 0}
    return turned.pop() if len(turned) == 1 else None


def _along(axes: Iterable[Vector], normal: int) -> int | None:
    """Return the axis of a body that is always along an axis of the base; None without one."""
    found = [i for i, axis in enumerate(axes) if tuple(axis)[normal] != 0]
    return found[0] if len(found) == 1 else None
