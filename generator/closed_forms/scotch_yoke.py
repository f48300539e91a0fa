r"""A pin in a slot: the dyad of a hinge and two guides, of which a Scotch yoke is made.

A block is hinged to a placed body at Q. It slides in a slot of a yoke, along d1, and the yoke on a
guide of another placed body, along d2. Neither guide turns, so that both links keep the orientation
of that body, the *base*. In its axes, with w the way of Q from its design position and n across
both guides,

    w = x1 d1 + x2 d2,    x1 = n . (w x d2) / n . (d1 x d2),    x2 = n . (d1 x w) / n . (d1 x d2).

That is explicit, and linear: the same factors give the speeds from the velocity of Q relative to
the base, and the accelerations from the rest of its acceleration. There is one branch. Singular
set: the slot is along the guide, for all positions or for none; `prepare` refuses it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ..declare.joints import Prismatic, Revolute
from ..kinematics.extent import require
from ..loops.forms import ClosedForm
from ..program.floors import LENGTH
from ..program.vectors import NO_TWIST, ZERO, Twist, Vector
from .solved_motion import SlideOnGuide, projector

if TYPE_CHECKING:
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion, PointMotion
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known


_NONE = sp.Integer(0)


@dataclass(frozen=True)
class ScotchYoke(ClosedForm):
    """A pin of a placed body moves a block in the slot of a body on a guide: both slides follow."""

    # of the block: its hinge, and the placed body at the other side of that
    hinge: Revolute
    pin_body: str
    # guide between block and yoke, that of the yoke, and the placed body that has it
    slot: Prismatic
    block: str
    guide: Prismatic
    yoke: str
    base: str

    rank: ClassVar[int] = 7
    equations: ClassVar[tuple[int, ...]] = (2,)
    """Cut at the pin: the two slides remain."""

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the block and the yoke at the beginning of an arc of a loop, from the pin on."""
        if len(cut.joints) < 2:
            return None
        (slot, guide), (block, yoke, base) = cut.joints[:2], cut.bodies[:3]
        hinge, pin_body = known.topology.joint_between(cut.others[0], block), cut.others[0]
        if not (isinstance(slot, Prismatic) and isinstance(guide, Prismatic)):
            return None
        if not isinstance(hinge, Revolute) or known.unknowns_of(hinge) == 0:
            return None
        driven = known.unknowns_of(slot) == 0 or known.unknowns_of(guide) == 0
        if driven or {block, yoke} & known.bodies or not {pin_body, base} <= known.placed:
            return None
        return cls(hinge, pin_body, slot, block, guide, yoke, base)

    @property
    def about(self) -> str:
        return self.yoke

    @property
    def title(self) -> str:
        return f"transformer: {self.block} in the slot of {self.yoke}"

    @property
    def pin(self) -> Point:
        """The point of the hinge."""
        return self.hinge.axis.through

    def accept(self, known: Known) -> set[Coordinate]:
        """Record block and yoke, and their joints."""
        known.placed |= {self.block, self.yoke}
        return known.add_all([self.hinge, self.slot, self.guide])

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        return (
            f"way of {self.pin.name} = {self.slot.name}.slide and {self.guide.name}.slide",
            "explicit: the parts of the way along slot and guide",
        )

    def emit(self, kin: Kinematics) -> None:
        """Find both slides, and place block and yoke."""
        base = kin.placed[self.base]
        axes, pin = _Oblique.of(kin, self, base), kin.point_motion(self.pin_body, self.pin)
        q = projector(kin, base)(f"{self.block}_pin", pin.position - base.origin)
        x = axes.parts(kin, f"{self.yoke}_slide", q - kin.local(base, self.pin))
        kin.slides[self.slot.name] = x[0] if self.slot.second.name == self.block else -x[0]
        kin.slides[self.guide.name] = x[1] if self.guide.second.name == self.yoke else -x[1]
        yoke = SlideOnGuide(kin, self.yoke, base, axes.along(_NONE, x[1]))
        block = SlideOnGuide(kin, self.block, base, axes.along(*x))
        self._add_motion(kin, axes, q, pin, (yoke, block))

    def _add_motion(
        self,
        kin: Kinematics,
        axes: _Oblique,
        q: Vector,
        pin: PointMotion,
        sliding: tuple[SlideOnGuide, SlideOnGuide],
    ) -> None:
        """Record velocities and biases: the base carries both, and they slide on it.

        Written by hand: block and yoke have the same two unknowns, and need no division.
        """
        base = kin.placed[self.base]
        to_base, speeds = projector(kin, base), (_NONE, _NONE)
        for k in dict.fromkeys([*base.motion, *pin.motion]):
            carried = base.motion.get(k, NO_TWIST)
            target = to_base(f"{self.block}_pin_{k}", pin.motion.get(k, ZERO))
            relative_velocity = target - carried.linear - carried.angular.cross(q)
            v = axes.parts(kin, f"{self.yoke}_speed_{k}", relative_velocity)
            speeds = (
                speeds[0] + v[0] * kin.coordinates.rate(k),
                speeds[1] + v[1] * kin.coordinates.rate(k),
            )
            for on_base, slide in zip(sliding, (_NONE, v[0]), strict=True):
                twist = on_base.at_rest(k) + Twist(ZERO, axes.along(slide, v[1]))
                placed = on_base.placed
                placed.motion[k] = kin.define_twist(placed.body, k, twist)

        def bias(on_base: SlideOnGuide, part: int) -> Twist:
            """Return the bias of the block, or of the yoke, which has no part of the slot."""
            spin = kin.total(base).angular
            target = to_base(f"{self.block}_pin_bias", pin.bias)
            left = target - kin.point_bias(base, q) - spin.cross(axes.along(*speeds)) * 2
            a = axes.parts(kin, f"{self.yoke}_speed_bias", left)
            carried = on_base.carried_bias(axes.along(part * speeds[0], speeds[1]))
            own = Twist(ZERO, axes.along(part * a[0], a[1]))
            return kin.define_bias(on_base.placed.body, carried + own)

        yoke, block = sliding
        yoke.placed.bias = cache(lambda: bias(yoke, 0))
        block.placed.bias = cache(lambda: bias(block, 1))


@dataclass(frozen=True)
class _Oblique:
    """Directions of slot and guide, and factors of a vector's parts along them (base axes)."""

    slot: Vector
    guide: Vector
    of_slot: Vector
    of_guide: Vector

    @classmethod
    def of(cls, kin: Kinematics, step: ScotchYoke, base: BodyMotion) -> _Oblique:
        """Return slot and guide, constants."""
        program, name = kin.program, step.yoke
        d1 = kin.local_direction(base, step.slot.direction)
        d2 = kin.local_direction(base, step.guide.direction)
        n = program.vector(f"{name}_normal", d1.cross(d2), "123")
        squared = program.define(f"{name}_normal_squared", n.dot(n))
        require(
            kin,
            f"{name}_slot_across_guide",
            sp.sqrt(squared),
            LENGTH,
            "1",
            f"the slot {step.slot.name} of {name} is along its guide {step.guide.name}",
            "turn one of the two",
        )
        inverse = program.define(f"{name}_normal_inverse", 1 / squared)
        return cls(
            d1,
            d2,
            program.vector(f"{name}_of_slot", d2.cross(n) * inverse, "123"),
            program.vector(f"{name}_of_guide", n.cross(d1) * inverse, "123"),
        )

    def along(self, slide: sp.Expr, lift: sp.Expr) -> Vector:
        """Return the displacement by two slides."""
        return self.slot * slide + self.guide * lift

    def parts(self, kin: Kinematics, name: str, way: Vector) -> tuple[sp.Expr, sp.Expr]:
        """Append the parts of a vector along slot and guide."""
        return (
            kin.program.define(f"{name}_in_slot", self.of_slot.dot(way)),
            kin.program.define(f"{name}_on_guide", self.of_guide.dot(way)),
        )
