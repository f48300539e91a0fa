"""Laws of force elements: the force of a spring, damper or stop by a length and its rate.

Every law returns the force that pushes the two ends of its element apart, in newtons; along a twist
of hinges, the moment. A law owns its parameters, whose types are those of a force or of a moment.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import sympy as sp
from typing_extensions import override

from ...core.si_units import powers_of
from ..program.functions import Positive
from .declared import Count, DeclarationError, Name, declared
from .inputs import Input
from .internal_states import InternalState
from .parameters import (
    Angle,
    AngularSpeed,
    DamperRate,
    Displacement,
    ForceLevel,
    Length,
    MomentLevel,
    Owner,
    Parameter,
    Progression,
    Speed,
    SpringRate,
    TimeConstant,
    TorsionDamperRate,
    TorsionProgression,
    TorsionRate,
)
from .shown import Event, Range, words_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..program.program import Program
    from .paths import AnyPath


def _of_either_sign(length: Parameter | None, path: AnyPath) -> list[str]:
    """Return problems of a length that may be negative, on a path whose length is positive."""
    if path.of_either_sign or not isinstance(length, Displacement):
        return []
    return [f"{length.name!r} is a Displacement, and no length is negative; give a Length"]


@dataclass(frozen=True)
class Stretch:
    """The state of a force element."""

    # receives the steps of laws; beginning of their names
    program: Program
    name: str
    # distance of the two ends [m] and its rate, positive in rebound [m/s]
    length: sp.Expr
    velocity: sp.Expr
    # coordinate of a telescope, positive in compression [m]; None for other elements
    slide: sp.Expr | None = None


class AnyLaw(ABC):
    """Base of the laws."""

    from_outside: ClassVar[bool] = False
    """Whether the force is an input, and not shown."""

    @property
    @abstractmethod
    def signal(self) -> str:
        """Name of the signal that shows the force."""

    @property
    @abstractmethod
    def meaning(self) -> str:
        """The meaning of that signal."""

    def ranges_of_rate(self) -> tuple[Range, ...]:
        """Return the valid ranges of the rate of the length."""
        return ()

    def ranges_of_length(self) -> tuple[Range, ...]:
        """Return the valid ranges of the length."""
        return ()

    def events_of_length(self, element: str) -> tuple[Event, ...]:
        """Return events at certain lengths of an element of this name."""
        return ()

    def describe(self) -> str:
        """Return its description in reports: its name, with a formula where that is short."""
        return self.meaning

    @abstractmethod
    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""

    def rates(self, at: Stretch) -> dict[str, sp.Expr]:
        """Return the rates of its internal states, by name."""
        return {}

    def problems(self, path: AnyPath) -> list[str]:
        """Return problems of the law on a path."""
        return []


def _with_formula(law: AnyLaw) -> str:
    """Return the name of a law, and its force by the names of its inputs."""
    length, velocity, slide = (sp.Symbol(name) for name in ("length", "velocity", "slide"))
    program: Any = None  # a formula has no steps
    force = law.force(Stretch(program, "", length, velocity, slide))
    return f"{law.meaning} `{force}`"


@declared
@dataclass(frozen=True)
class LinearSpring(AnyLaw):
    """A linear spring: force ``rate (slide - free_slide)``, or ``rate (free_length - length)``.

    A positive force pushes the ends apart.

    Parameters
    ----------
    rate
        Spring rate [N/m]; of an angle, [N m/rad].
    free_slide, free_length
        Slide or length at which the spring is free of force [m]: one of the two, the first for a
        telescope only (Eq. 23 of the paper). Of an angle, the free angle [rad].
    """

    rate: SpringRate | TorsionRate
    free_slide: Displacement | None = None
    free_length: Length | Displacement | Angle | None = None

    def __post_init__(self) -> None:
        if (self.free_slide is None) == (self.free_length is None):
            raise DeclarationError("LinearSpring", ["give it a free_slide or a free_length"])

    signal = "spring_force"
    meaning = "spring force"

    def describe(self) -> str:
        return _with_formula(self)

    def problems(self, path: AnyPath) -> list[str]:
        if self.free_slide is not None and not path.has_slide:
            return ["a free_slide needs a telescope; give its spring a free_length"]
        return _of_either_sign(self.free_length, path)

    def force(self, at: Stretch) -> sp.Expr:
        if self.free_slide is not None:
            return self.rate.symbol * (at.slide - self.free_slide.symbol)
        assert self.free_length is not None
        return self.rate.symbol * (self.free_length.symbol - at.length)


@declared
@dataclass(frozen=True)
class LinearDamper(AnyLaw):
    """A linear damper with the force ``-rate velocity``, where the velocity is that of the length.

    Parameters
    ----------
    rate
        Damper rate [N s/m]; of an angle, [N m s/rad].
    """

    rate: DamperRate | TorsionDamperRate

    signal = "damper_force"
    meaning = "damper force"

    def describe(self) -> str:
        return _with_formula(self)

    def force(self, at: Stretch) -> sp.Expr:
        return -self.rate.symbol * at.velocity


@dataclass(frozen=True, kw_only=True)
class AnyTable(AnyLaw, Owner):
    r"""A curve of force over compression, as smooth as its data.

    Let p_i be the compression beyond knot i, 0 before it, of knots 0 to n. With t_i the fraction of
    segment i that is passed, 0 before and 1 behind it, and x_0 the compression beyond the first
    knot, negative before it,

        force = F_0 + s_0 min(x_0, 0) + sum_i t_i (a_i + t_i (b_i + t_i c_i)) + s_n p_n,
        t_i = (p_i - p_{i+1}) / (width of segment i),    min(x_0, 0) = x_0 - p_0.

    That is a cubic in each segment and a straight line at both ends, without a branch. With the
    coefficients of a C1 interpolation the curve is C1 too; with b_i = c_i = 0 it has straight lines
    between its knots. Written in p_i, its derivative is right at the knots, too.

    Parameters
    ----------
    name
        Prefix of the names of the parameters: ``<name>_first_force`` [N], ``<name>_first_slope``
        and ``<name>_last_slope``, ``<name>_knot_<i>``, and for each segment
        ``<name>_inverse_width_<i>``, ``_linear``, ``_quadratic``, ``_cubic`` [N].
    segments
        Number of segments; superfluous ones have width and coefficients zero (but any inverse
        width).
    """

    name: Name
    segments: Count

    units: ClassVar[tuple[str, str, str]]
    """Of a slope, a knot and an inverse width."""
    knots: ClassVar[str]
    """Quantity of the knots."""
    ends: ClassVar[tuple[str, str]]
    """Sides on which the slopes of the first and the last knot hold."""

    @abstractmethod
    def beyond(self, at: Stretch, knot: sp.Symbol) -> sp.Expr:
        """Return the compression of the element beyond a knot.

        Parameters
        ----------
        at
            State of the element.
        knot
            Length or velocity of a point between two segments.
        """

    @cached_property
    def numbers(self) -> tuple[Parameter, ...]:
        """All parameters; by default there is no force."""
        return tuple(
            Parameter(f"{self.name}_{what}", default, unit, meaning)
            for what, default, unit, meaning in self._entries()
        )

    def _entries(self) -> Iterator[tuple[str, float, str, str]]:
        of_slope, of_knot, of_inverse = self.units
        first, last = self.ends
        yield "first_force", 0.0, "N", "force at the first knot"
        yield "first_slope", 0.0, of_slope, f"slope {first} the first knot"
        yield "last_slope", 0.0, of_slope, f"slope {last} the last knot"
        for i in range(self.segments + 1):
            yield f"knot_{i}", 0.0, of_knot, f"knot {i} of {self.knots}"
        for i in range(self.segments):
            yield f"inverse_width_{i}", 1.0, of_inverse, f"inverse width of segment {i}"
            for power in ("linear", "quadratic", "cubic"):
                yield f"{power}_{i}", 0.0, "N", f"{power} coefficient of segment {i}"

    def _symbol(self, what: str) -> sp.Symbol:
        return sp.Symbol(f"{self.name}_{what}")

    def _end_knots(self) -> tuple[sp.Symbol, sp.Symbol]:
        """Return both ends; the knots of superfluous segments equal the last one."""
        return self._symbol("knot_0"), self._symbol(f"knot_{self.segments}")

    def force(self, at: Stretch) -> sp.Expr:
        program, symbol = at.program, self._symbol
        passed = []
        for i in range(self.segments + 1):
            beyond = program.define(f"{self.name}_beyond_{i}", self.beyond(at, symbol(f"knot_{i}")))
            passed.append((beyond, program.define(f"{self.name}_passed_{i}", Positive(beyond))))
        (first, first_passed), (_, last_passed) = passed[0], passed[-1]
        total = symbol("first_force") + symbol("first_slope") * (first - first_passed)
        total += symbol("last_slope") * last_passed
        for i in range(self.segments):
            t = program.define(
                f"{self.name}_part_{i}",
                (passed[i][1] - passed[i + 1][1]) * symbol(f"inverse_width_{i}"),
            )
            a, b, c = (symbol(f"{power}_{i}") for power in ("linear", "quadratic", "cubic"))
            total += t * (a + t * (b + t * c))
        return total


@declared
@dataclass(frozen=True, kw_only=True)
class DamperTable(AnyTable):
    """A damper with a curve of force over velocity, with its own shape in bump and in rebound.

    Its segments and ends are as of `SpringTable`.

    Parameters
    ----------
    name
        Prefix of the names of the parameters, which are those of `SpringTable` with knots in m/s.
        Knots are velocities of compression in increasing order.
    segments
        Number of segments, one or more.
    """

    signal = "damper_force"
    meaning = "damper force"
    units = "N s/m", "m/s", "s/m"
    knots = "compression velocity"
    ends = "below", "above"

    @override
    def beyond(self, at: Stretch, knot: sp.Symbol) -> sp.Expr:
        return -at.velocity - knot

    def ranges_of_rate(self) -> tuple[Range, ...]:
        first, last = self._end_knots()
        words = "the damper is faster in {} than its table goes, and is taken to go on straight"
        below, above = words.format("bump"), words.format("rebound")
        return (Range(-last, -first, below, above, possible=True),)


@declared
@dataclass(frozen=True, kw_only=True)
class SpringTable(AnyTable):
    """A spring with a curve of force over length: a cubic, or a straight line, in each segment.

    Beyond its ends the curve is a straight line with the slope there.

    Parameters
    ----------
    name
        Prefix of the names of the parameters: ``<name>_first_force`` [N], ``<name>_first_slope``
        and ``<name>_last_slope`` [N/m], ``<name>_knot_<i>`` [m], and of each segment
        ``<name>_inverse_width_<i>`` [1/m] and the coefficients ``_linear``, ``_quadratic`` and
        ``_cubic`` [N]. Knots are lengths in decreasing order: the first is the longest, where the
        spring is compressed least.
    segments
        Number of segments, one or more.
    """

    signal = "spring_force"
    meaning = "spring force"
    units = "N/m", "m", "1/m"
    knots = "length, falling"
    ends = "by compression before", "by compression after"

    def problems(self, path: AnyPath) -> list[str]:
        if path.words.force == "moment":
            return [f"the lengths of {self.name!r} are in m, and a twist has none"]
        return []

    @override
    def beyond(self, at: Stretch, knot: sp.Symbol) -> sp.Expr:
        return knot - at.length

    def ranges_of_length(self) -> tuple[Range, ...]:
        longest, shortest = self._end_knots()
        words = "the spring is {} than its table goes, and is taken to go on straight"
        below, above = words.format("shorter"), words.format("longer")
        return (Range(shortest, longest, below, above, possible=True),)


@declared
@dataclass(frozen=True)
class Friction(AnyLaw):
    """Coulomb friction, smoothed about rest: ``-level velocity / sqrt(velocity^2 + speed^2)``.

    Parameters
    ----------
    level
        Force of fast sliding [N]; of an angle, the moment [N m].
    speed
        Velocity at which 71 % (1/sqrt(2)) of it act, above zero [m/s]; of an angle, [rad/s].
    """

    level: ForceLevel | MomentLevel
    speed: Speed | AngularSpeed

    signal = "friction_force"
    meaning = "friction force"

    def force(self, at: Stretch) -> sp.Expr:
        v = at.velocity
        smoothed = at.program.define(
            f"{at.name}_sliding_speed", sp.sqrt(v**2 + self.speed.symbol**2)
        )
        return -self.level.symbol * v / smoothed


@declared
@dataclass(frozen=True, kw_only=True)
class Stop(AnyLaw):
    """A progressive stop with the force ``rate x + progression x^3`` at its compression x >= 0.

    Parameters
    ----------
    side
        "bump": acts when the element is shorter than `length` and pushes its ends apart.
        "rebound": acts when the element is longer than `length` and pulls them together.
    length
        Length of the element at which the stop is touched [m]; of an angle, the angle [rad].
    rate, progression
        Rate at first contact [N/m], and cubic coefficient [N/m^3]; of an angle, [N m/rad] and
        [N m/rad^3].
    """

    side: Literal["bump", "rebound"]
    length: Length | Displacement | Angle
    rate: SpringRate | TorsionRate
    progression: Progression | TorsionProgression

    @property
    def signal(self) -> str:
        return f"{self.side}_stop_force"

    @property
    def meaning(self) -> str:
        return f"force of the {self.side} stop"

    def problems(self, path: AnyPath) -> list[str]:
        return _of_either_sign(self.length, path)

    def events_of_length(self, element: str) -> tuple[Event, ...]:
        """Return the event at which it is touched."""
        name, rising = f"{element}_reaches_{self.side}_stop", self.side == "rebound"
        meaning = f"{words_of(element)} touches its {self.side} stop"
        return (Event(name, self.length.symbol, rising, meaning, needs=self.rate),)

    def force(self, at: Stretch) -> sp.Expr:
        sense = 1 if self.side == "bump" else -1
        gap = at.program.define(
            f"{at.name}_{self.side}_gap", sense * (self.length.symbol - at.length)
        )
        x = at.program.define(f"{at.name}_{self.side}_depth", Positive(gap))
        return sense * x * (self.rate.symbol + self.progression.symbol * x**2)


@declared
@dataclass(frozen=True)
class Actuator(AnyLaw):
    """A force that is an input, positive when it pushes the ends apart.

    Parameters
    ----------
    input
        The force [N]; of an angle, the moment [N m].
    """

    input: Input

    from_outside: ClassVar[bool] = True
    signal = "actuator_force"
    meaning = "actuator force"

    @override
    def force(self, at: Stretch) -> sp.Expr:
        return sp.Symbol(self.input.name)


@declared
@dataclass(frozen=True)
class LaggingDamper(AnyLaw):
    """A damper whose force follows ``-rate velocity`` with a lag.

    The equation is ``lag force' = -rate velocity - force``. It is that of a damper in series with a
    spring of the stiffness ``rate / lag``, such as soft bushes at its ends (Maxwell's element): the
    damper dominates in slow strokes, the spring in fast ones.

    Parameters
    ----------
    rate
        Damper rate [N s/m]; of an angle, [N m s/rad].
    lag
        Time constant [s].
    state
        Internal state for the force [N], or for the moment [N m].
    """

    rate: DamperRate | TorsionDamperRate
    lag: TimeConstant
    state: InternalState

    signal = "damper_force"
    meaning = "damper force"

    def describe(self) -> str:
        """Return its name and its formula."""
        return f"{self.meaning} `{self.state.name}`, `-{self.rate.name}*velocity` with a lag"

    @override
    def force(self, at: Stretch) -> sp.Expr:
        return self.state.symbol

    def rates(self, at: Stretch) -> dict[str, sp.Expr]:
        behind = -self.rate.symbol * at.velocity - self.state.symbol
        return {self.state.name: behind / self.lag.symbol}

    def problems(self, path: AnyPath) -> list[str]:
        """Return a problem if the state is not in the unit of the force."""
        if powers_of(self.state.unit) == powers_of(path.words.unit):
            return []
        return [f"state {self.state.name!r} is in {self.state.unit}; {path.words.unit} is needed"]


Law = (
    LinearSpring | SpringTable | LinearDamper | LaggingDamper | DamperTable | Friction | Stop
    | Actuator
)  # fmt: skip
