"""A tyre: a radial spring in the plane of its wheel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp
from typing_extensions import override

from ...program.functions import IsPositive, Positive
from ..declared import DeclarationError, Name, declared
from ..inputs import Input
from ..parameters import DamperRate, Displacement, Share, SpringRate
from ..shown import Event, Range, Shown
from ..wheel import Wheel
from .force import Action, Description, Force, road_problems

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..surroundings import Surroundings
    from ..whole import Whole


# Force at which a tyre touches, and below which tension is rounding [N]: nanometres of deflection.
_TOUCH = 1e-3


@declared
@dataclass(frozen=True, kw_only=True)
class LinearTyre(Force):
    """A radial tyre spring in the wheel plane (Eq. 24 of the paper).

    With the unit vectors ``a`` along the spin axis and ``e_z`` up, the force on the wheel at its
    centre is ``load (e_z - a a_z) / (1 - a_z^2)``: its vertical component is the load. The load is
    ``rate x`` with ``x = free_height + road - height`` and the height of the wheel centre.

    With a damper the load is ``rate x + damper x'``. A tyre that lifts off neither pulls nor damps
    in the air: its load is zero where x or the load itself would be negative; one that does not
    is bonded to the road, as in the paper.

    Parameters
    ----------
    name
        Prefix of the names of its signals, and those of the wheel, where there are several tyres.
    wheel
        Its wheel, at whose centre the force acts.
    rate, free_height
        Stiffness [N/m], and the height of the wheel centre above the road at which the tyre has no
        force [m].
    road
        Height of the road under the tyre in the world [m].
    damper, road_velocity
        Damping [N s/m], and the input that is the derivative of `road` [m/s]; both or neither.
    lifts_off
        1 if the tyre can leave the road, 0 if not; None: it cannot.
    """

    name: Name
    wheel: Wheel
    rate: SpringRate
    free_height: Displacement
    road: Input
    damper: DamperRate | None = None
    road_velocity: Input | None = None
    lifts_off: Share | None = None

    def __post_init__(self) -> None:
        problems = road_problems(self.road, self.damper, self.road_velocity)
        if problems:
            raise DeclarationError(f"LinearTyre {self.name!r}", problems)

    @property
    def identity(self) -> tuple[str, str]:
        return "force", self.name

    def prefix(self, mechanism: Whole) -> str:
        """Return the prefix of the names of its signals; empty for a single tyre."""
        alone = sum(isinstance(f, LinearTyre) for f in mechanism.forces) == 1
        return "" if alone else f"{self.name}_"

    def describe(self) -> Description:
        load = f"{self.rate.name}*({self.free_height.name} + {self.road.name} - height)"
        more = ", with damping" if self.damper is not None else ""
        pull = r"\mathbf{w} = \frac{F}{1-a_z^2}\,(\mathbf{e}_z - a_z\,\mathbf{a})"
        return Description(
            f"tyre {self.name}",
            f"F = `{load}`{more}; at `{self.wheel.center.name}`, a the spin axis: $`{pull}`$",
            r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T\mathbf{w}`$",
        )

    def act(self, at: Surroundings) -> Action:
        """Append the force at the centre of the wheel."""
        program, prefix, body = at.program, self.prefix(at.mechanism), self.wheel.carrier.name
        upright = self.wheel.upright(at, prefix)
        height = program.define(
            f"{prefix}wheel_height", at.height(body, at.local(body, self.wheel.center))
        )
        deflection = self.free_height.symbol + sp.Symbol(self.road.name) - height
        load = self._contact(at, prefix, deflection, self._bonded(at, deflection))
        load = program.define(f"{prefix}tyre_load", load / upright.squared)
        moving = [k for k in at.independent if k in at.twists(body)]
        forces = {k: load * upright.pull.dot(self.wheel.velocity(at, k)) for k in moving}
        shown = program.define(f"{prefix}tyre_force", load * sp.sqrt(upright.squared))
        return Action(forces, {f"{prefix}tyre_force": shown})

    def _bonded(self, at: Surroundings, deflection: sp.Expr) -> sp.Expr:
        """Return the load of spring and damper of a tyre that is bonded to the road."""
        load = self.rate.symbol * deflection
        if self.damper is None or self.road_velocity is None:
            return load
        body = self.wheel.carrier.name
        up, rise = at.up(body), sp.Integer(0)
        for k in at.twists(body):
            rise += up.dot(self.wheel.velocity(at, k)) * at.rate(k)
        return load + self.damper.symbol * (sp.Symbol(self.road_velocity.name) - rise)

    def _contact(
        self, at: Surroundings, prefix: str, deflection: sp.Expr, load: sp.Expr
    ) -> sp.Expr:
        """Return the load of a tyre that may leave the road."""
        if self.lifts_off is None:
            return load
        deflection = at.program.define(f"{prefix}tyre_deflection", deflection)
        load = at.program.define(f"{prefix}tyre_bonded_load", load)
        pressed = IsPositive(deflection) * Positive(load)
        return load + self.lifts_off.symbol * (pressed - load)

    @override
    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        yield from self.wheel.signals(at, self.prefix(at.mechanism))
        meaning = "tyre force in the wheel plane, positive in compression"
        limits = self._ranges, self._events(self.prefix(at.mechanism))
        for name, value in action.values.items():
            yield Shown(name, value, "N", meaning, *limits)

    @property
    def _ranges(self) -> tuple[Range, ...]:
        """Its valid range: a tyre that never lifts off would have to pull."""
        return (Range(-_TOUCH, below="the tyre pulls at the road", unless=self.lifts_off),)

    @staticmethod
    def _events(prefix: str) -> tuple[Event, ...]:
        """Events at which the wheel leaves the road, and meets it."""
        # in the air, the force of a tyre that lifts off is constantly zero
        leaves, touches = (f"{prefix}wheel_{what}_ground" for what in ("leaves", "touches"))
        return (
            Event(leaves, _TOUCH, rising=False, meaning="the tyre force falls to nothing"),
            Event(touches, _TOUCH, rising=True, meaning="the tyre force rises from nothing"),
        )
