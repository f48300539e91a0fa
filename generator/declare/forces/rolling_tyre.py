"""Rolling tyres: a normal force by deflection, and forces and moments by slip."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import sympy as sp
from typing_extensions import override

from ...program.formulas import Steps
from ...program.functions import IsPositive, Positive
from ...program.vectors import Axes, Vector, from_axes
from ..contact_laws import ContactLaw, RollingState
from ..declared import DeclarationError, Name, declared
from ..inputs import Input
from ..internal_states import InternalState
from ..joints import Revolute
from ..parameters import DamperRate
from ..shown import Event, Shown
from ..wheel import Wheel
from .force import Action, Description, Force, road_problems

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....formulas.magic_formula import Forces
    from ..surroundings import Surroundings
    from ..wheel import WheelAttitude

_SHORTEST = sp.Rational(1, 20)  # relaxation length [m]
_TOUCH = 1e-3  # load at which a tyre touches [N]


@declared
@dataclass(frozen=True, kw_only=True)
class RollingTyre(Force):
    """A tyre that rolls on a level road, in the axes of ISO 8855 at its contact.

    The wheel is a thin disc. Its normal force acts at the lowest point of the disc, depends on the
    distance of that point below the road, and so is conservative without its damper; a tyre in the
    air has none. All other forces act where the plane of the wheel meets the road, straight below
    the axis.

    With the velocities V_centre of the wheel's centre and V_contact of the contact as a point of
    the carrier, the rate of spin Omega in the world, the effective rolling radius r_e, the unit
    vectors a along the spin axis (to the left), n up, x = a x n forward and y to the left, the
    slips kappa and tan(alpha) are::

        V_cx = x . V_centre,  V_cy = y . V_contact,  |V| = sqrt(V_cx^2 + V_low^2)
        kappa = (r_e Omega - V_cx) / |V|,  tan(alpha) = V_cy / |V|

    The speed V_low > 0 smooths them: at standstill the contact damps, and rolling backward needs no
    case of its own. With states u and v, the deflections of the contact along and across, the slips
    lag by the relaxation lengths s_x and s_y, of 50 mm at least::

        u' = r_e Omega - V_cx - |V| u / s_x,  kappa = u / s_x
        v' = V_cy - |V| v / s_y,              tan(alpha) = v / s_y

    Parameters
    ----------
    name
        Prefix of the names of its signals.
    wheel
        Its wheel.
    bearing
        The driven hinge about which the wheel turns on its carrier, along its spin axis.
    law
        Forces by load and slip.
    road
        Height of the road under the tyre in the world [m].
    damper, road_velocity
        Damping along the normal [N s/m], and the input that is the derivative of `road` [m/s]; both
        or neither.
    deflections
        Two states [m], along and across; without them forces are those of the slips at the time.
    """

    name: Name
    wheel: Wheel
    bearing: Revolute
    law: ContactLaw
    road: Input
    damper: DamperRate | None = None
    road_velocity: Input | None = None
    deflections: tuple[InternalState, InternalState] | None = None

    def __post_init__(self) -> None:
        problems = road_problems(self.road, self.damper, self.road_velocity)
        problems += [
            f"state {state.name!r} is in {state.unit}; m is needed"
            for state in self.deflections or ()
            if state.unit != "m"
        ]
        problems += self.wheel.bearing_problems(self.bearing)
        if problems:
            raise DeclarationError(f"RollingTyre {self.name!r}", problems)

    @property
    def identity(self) -> tuple[str, str]:
        return "force", self.name

    @property
    def along(self) -> Revolute:
        return self.bearing

    def describe(self) -> Description:
        acts = f"{self.law.describe()}: F and M at the contact, N at the lowest point of the disc"
        share = (
            r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T(\mathbf{F}+\mathbf{N})"
            r" + \mathbf{W}_b^T\mathbf{M}`$"
        )
        return Description(f"tyre {self.name}", acts, share)

    def act(self, at: Surroundings) -> Action:
        """Append its power on the motion of the carrier, and on the spin."""
        program, carrier, steps = at.program, self.wheel.carrier.name, Steps(at.program, self._own)
        upright = self.wheel.upright(at, self._own)
        cosine = program.define(f"{self._own}cosine", sp.sqrt(upright.squared))
        down = program.vector(f"{self._own}down", upright.pull * (-1 / cosine), "123")
        forward = program.vector(
            f"{self._own}forward", upright.axis.cross(upright.up) * (1 / cosine), "123"
        )
        axes = forward, upright.up.cross(forward), upright.up
        velocity, turning = self._motion(at)
        deflection, load = self._load(at, upright, cosine, (velocity, turning, down))
        arm = down * (self.law.radius - deflection / cosine)
        rolling = self._rolling(at, steps, axes, load, (velocity, turning, arm, upright))
        rolling, rates = self._relaxed(steps, rolling)
        found = self._forces(steps, rolling)
        along = from_axes(axes, Vector(found.fx, found.fy, sp.Integer(0)))
        upward = upright.up * load
        moment = arm.cross(along) + (down * self.law.radius).cross(upward)
        moment += from_axes(axes, Vector(found.mx, found.my, found.mz))
        force = program.vector(f"{self._own}force", along + upward, "123")
        moment = program.vector(f"{self._own}moment", moment, "123")
        forces = {
            k: force.dot(self.wheel.velocity(at, k)) + moment.dot(twist.angular)
            for k, twist in at.twists(carrier).items()
            if k in at.independent
        }
        forces[at.coordinate(self.bearing.name)] = moment.dot(upright.axis)
        values = {
            "fx": found.fx,
            "fy": found.fy,
            "fz": load,
            "mx": found.mx,
            "my": found.my,
            "mz": found.mz,
            "slip": rolling.longitudinal,
            "slip_angle": sp.atan2(rolling.lateral, sp.Integer(1)),
            "deflection": deflection,
        }
        shown = {f"{self._own}{k}": sp.sympify(v) for k, v in values.items()}
        return Action(forces, shown, rates=rates)

    @property
    def _own(self) -> str:
        return f"{self.name}_"

    def _motion(self, at: Surroundings) -> tuple[Vector, Vector]:
        """Return the velocity of the centre and the turning of the carrier, in its axes."""
        velocity, turning = Vector.of(0, 0, 0), Vector.of(0, 0, 0)
        for k, twist in at.twists(self.wheel.carrier.name).items():
            velocity += self.wheel.velocity(at, k) * at.rate(k)
            turning += twist.angular * at.rate(k)
        program = at.program
        return (
            program.vector(f"{self._own}center_velocity", velocity, "123"),
            program.vector(f"{self._own}carrier_turning", turning, "123"),
        )

    def _load(
        self,
        at: Surroundings,
        upright: WheelAttitude,
        cosine: sp.Expr,
        moving: tuple[Vector, Vector, Vector],
    ) -> tuple[sp.Expr, sp.Expr]:
        """Return the depth of the lowest point below the road, and the force along the normal."""
        program, body, radius = at.program, self.wheel.carrier.name, self.law.radius
        height = at.height(body, at.local(body, self.wheel.center))
        deflection = program.define(
            f"{self._own}deflection", sp.Symbol(self.road.name) + radius * cosine - height
        )
        pressed = program.define(f"{self._own}pressed", Positive(deflection))
        load = self.law.load(pressed)
        if self.damper is not None and self.road_velocity is not None:
            velocity, turning, down = moving
            sinking = -upright.up.dot(velocity + turning.cross(down * radius))
            rate = program.define(
                f"{self._own}deflection_rate", sp.Symbol(self.road_velocity.name) + sinking
            )
            bonded = program.define(f"{self._own}bonded", load + self.damper.symbol * rate)
            load = IsPositive(deflection) * Positive(bonded)
        return deflection, program.define(f"{self._own}fz", load)

    def _rolling(
        self,
        at: Surroundings,
        steps: Steps,
        axes: Axes,
        load: sp.Expr,
        moving: tuple[Vector, Vector, Vector, WheelAttitude],
    ) -> RollingState:
        """Return the rolling motion of the tyre."""
        (forward, left, _), (velocity, turning, arm, upright) = axes, moving
        ahead = steps.define("ahead", forward.dot(velocity))
        sideways = steps.define("sideways", left.dot(velocity + turning.cross(arm)))
        spin = at.rate(at.coordinate(self.bearing.name)) + upright.axis.dot(turning)
        radius = steps.define("rolling_radius", self.law.rolling_radius(steps, load))
        least = self.law.lowest_speed * self.law.lowest_speed
        size = steps.define("speed", sp.sqrt(ahead * ahead + least))
        both = steps.define("ground_speed", sp.sqrt(ahead * ahead + sideways * sideways + least))
        return RollingState(
            load=load,
            longitudinal=steps.define("slip", (radius * spin - ahead) / size),
            lateral=steps.define("lateral_slip", sideways / size),
            inclination=steps.define("inclination", upright.axis.dot(upright.up)),
            direction=steps.define("direction", ahead / both),
            rolling=steps.define("rolling", ahead / size),
            speed=ahead,
            size=size,
        )

    def _forces(self, steps: Steps, at: RollingState) -> Forces:
        """Return the forces of the law, which depend on a few numbers of all motion."""
        found = self.law.forces(steps, at)
        named = {n: steps.define(f"contact_{n}", v) for n, v in vars(found).items()}
        steps.program.narrow(vars(at).values(), named.values())
        return replace(found, **named)

    def _relaxed(self, steps: Steps, at: RollingState) -> tuple[RollingState, dict[str, sp.Expr]]:
        """Return the rolling motion with slips that lag, and the rates of the deflections."""
        if self.deflections is None:
            return at, {}
        along, across = self.deflections
        lengths = self.law.relaxation(steps, at.load, at.inclination)
        x, y = (
            steps.define(f"relaxation_{axis}", _SHORTEST + Positive(length - _SHORTEST))
            for axis, length in zip("xy", lengths, strict=True)
        )
        slip = steps.define("relaxed_slip", along.symbol / x)
        lateral = steps.define("relaxed_lateral_slip", across.symbol / y)
        rates = {
            along.name: at.size * (at.longitudinal - slip),
            across.name: at.size * (at.lateral - lateral),
        }
        return replace(at, longitudinal=slip, lateral=lateral), rates

    @override
    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        yield from self.wheel.signals(at, self._own)
        described = {
            "fx": ("N", "longitudinal force of the road on the tyre, positive forward"),
            "fy": ("N", "lateral force of the road on the tyre, positive to the left"),
            "fz": ("N", "normal force of the road on the tyre"),
            "mx": ("N m", "overturning moment of the road on the tyre, about its forward axis"),
            "my": ("N m", "rolling resistance moment of the road on the tyre, positive forward"),
            "mz": ("N m", "aligning moment of the road on the tyre, positive to the left"),
            "slip": ("1", "longitudinal slip that acts, positive in driving"),
            "slip_angle": ("rad", "slip angle that acts, positive moving to the left"),
            "deflection": ("m", "how far the lowest point of the disc is below the road"),
        }
        for what, (unit, meaning) in described.items():
            name = f"{self._own}{what}"
            events = self._events if what == "fz" else ()
            yield Shown(name, action.values[name], unit, meaning, (), events)

    @property
    def _events(self) -> tuple[Event, ...]:
        """Events at which the wheel leaves the road, and meets it."""
        leaves, touches = (f"{self._own}wheel_{what}_ground" for what in ("leaves", "touches"))
        return (
            Event(leaves, _TOUCH, rising=False, meaning="the tyre leaves the road"),
            Event(touches, _TOUCH, rising=True, meaning="the tyre meets the road"),
        )
