"""Laws of force elements: what a spring, damper or stop does with a length and its rate.

Every law returns the force that pushes the two ends of its element apart, in newtons. The names in
a law are those of parameters (or of an input), so one declaration serves every car.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import sympy as sp

from ..program.functions import Positive
from .declared import Amount, Count, Length, MoreThanZero, Name, declared
from .known import unknown

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..program.program import Program
    from .copying import Copying
    from .paths import AnyPath
    from .whole import Whole


@dataclass(frozen=True)
class Stretch:
    """The state of a force element.

    Attributes
    ----------
    length, velocity
        Distance of the two ends [m] and its rate, positive in rebound [m/s].
    slide
        Coordinate of a telescope, positive in compression [m]; None for other elements.
    """

    program: Program
    name: str
    length: sp.Expr
    velocity: sp.Expr
    slide: sp.Expr | None = None


class AnyLaw(ABC):
    """What the laws have in common.

    A force that is given from outside, by an input, is not shown.
    """

    not_named: ClassVar[tuple[str, ...]] = ()  # fields with a text that is no name

    @property
    @abstractmethod
    def signal(self) -> str:
        """Name of the signal that shows the force."""

    @property
    @abstractmethod
    def meaning(self) -> str:
        """What that signal is."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the inputs that it reads."""
        return ()

    @abstractmethod
    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""

    def problems(self, mechanism: Whole, path: AnyPath) -> list[str]:
        """Say what is wrong with it in a mechanism, on a path."""
        del path
        return unknown("input", self.inputs, mechanism.input_names)

    def copied(self, copy: Copying) -> Self:
        """Return the law of a copy: all that it names are parameters, but for inputs."""
        named: dict[str, Any] = {}
        for entry in fields(self):  # type: ignore[arg-type]  # every law is a dataclass
            value = getattr(self, entry.name)
            if isinstance(value, str) and entry.name not in self.not_named:
                of_input = value in self.inputs
                named[entry.name] = copy.input(value) if of_input else copy.named(value)
        return replace(self, **named)  # type: ignore[type-var]


@declared
@dataclass(frozen=True, kw_only=True)
class LinearSpring(AnyLaw):
    """Force ``rate (slide - free_slide)``, or ``rate (free_length - length)``.

    Parameters
    ----------
    rate
        Name of the parameter [N/m].
    free_slide, free_length
        Name of the parameter that says where the spring is free of force [m]: one of the two, the
        first for a telescope only (Eq. 23 of the paper).
    """

    rate: Amount
    free_slide: Name | None = None
    free_length: Length | None = None

    signal = "spring_force"
    meaning = "spring force"

    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""
        if self.free_slide is not None:
            return sp.Symbol(self.rate) * (at.slide - sp.Symbol(self.free_slide))
        return sp.Symbol(self.rate) * (sp.Symbol(str(self.free_length)) - at.length)

    def problems(self, mechanism: Whole, path: AnyPath) -> list[str]:
        """See that it is free of force somewhere, and that the path has such a coordinate."""
        problems = super().problems(mechanism, path)
        if (self.free_slide is None) == (self.free_length is None):
            problems.append("give its spring a free_slide or a free_length")
        elif self.free_slide is not None and not path.has_slide:
            problems.append("a free_slide needs a telescope; give a free_length")
        return problems


@declared
@dataclass(frozen=True, kw_only=True)
class LinearDamper(AnyLaw):
    """Force ``-rate velocity``.

    Parameters
    ----------
    rate
        Name of the parameter [N s/m].
    """

    rate: Amount

    signal = "damper_force"
    meaning = "damper force"

    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""
        return -sp.Symbol(self.rate) * at.velocity


@declared
@dataclass(frozen=True, kw_only=True)
class DamperTable(AnyLaw):
    r"""A curve of force over velocity, smooth, with its own shape in bump and in rebound.

    Let x be the compression velocity, k_0 < ... < k_n the knots, and p_i = max(x - k_i, 0). With
    t_i the part of segment i that x has passed, 0 before and 1 behind it,

        force = F_0 + s_0 min(x - k_0, 0) + sum_i t_i (a_i + t_i (b_i + t_i c_i)) + s_n p_n,
        t_i = (p_i - p_{i+1}) / (k_{i+1} - k_i),    min(x - k_0, 0) = x - k_0 - p_0.

    That is a cubic in each segment and a straight line at both ends, without a branch. With the
    coefficients of a C1 interpolation the curve is C1 too. Written in p_i, its derivative is right
    at the knots as well: a velocity belongs to one segment, and rest is often a knot.

    Parameters
    ----------
    name
        Begins the names of the parameters: ``<name>_first_force`` [N], ``<name>_first_slope`` and
        ``<name>_last_slope`` [N s/m], ``<name>_knot_<i>`` [m/s], and for each segment
        ``<name>_inverse_width_<i>`` [s/m], ``_linear``, ``_quadratic``, ``_cubic`` [N].
    segments
        Number of segments; those that are not needed have width and coefficients zero (but any
        inverse width).
    """

    name: Name
    segments: Count

    signal = "damper_force"
    meaning = "damper force"

    def parameters(self) -> Iterator[tuple[str, float, str, str]]:
        """Yield name, default, unit and meaning of every parameter; the default is no force."""
        yield f"{self.name}_first_force", 0.0, "N", "force at the first knot"
        yield f"{self.name}_first_slope", 0.0, "N s/m", "slope below the first knot"
        yield f"{self.name}_last_slope", 0.0, "N s/m", "slope above the last knot"
        for i in range(self.segments + 1):
            yield f"{self.name}_knot_{i}", 0.0, "m/s", f"knot {i} of compression velocity"
        for i in range(self.segments):
            yield f"{self.name}_inverse_width_{i}", 1.0, "s/m", f"inverse width of segment {i}"
            for power in ("linear", "quadratic", "cubic"):
                yield f"{self.name}_{power}_{i}", 0.0, "N", f"{power} coefficient of segment {i}"

    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""
        program, x = at.program, -at.velocity

        def symbol(what: str) -> sp.Symbol:
            return sp.Symbol(f"{self.name}_{what}")

        passed = []
        for i in range(self.segments + 1):
            beyond = program.define(f"{self.name}_beyond_{i}", x - symbol(f"knot_{i}"))
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
class Friction(AnyLaw):
    """Coulomb friction, regularised: ``-force velocity / sqrt(velocity^2 + speed^2)``.

    Parameters
    ----------
    level
        Name of the parameter: the force of full sliding [N].
    speed
        Name of the parameter: velocity at which 71 % of it act [m/s], more than zero.
    """

    level: Amount
    speed: MoreThanZero

    signal = "friction_force"
    meaning = "friction force"

    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""
        v = at.velocity
        pace = at.program.define(
            f"{at.name}_sliding_pace", sp.sqrt(v**2 + sp.Symbol(self.speed) ** 2)
        )
        return -sp.Symbol(self.level) * v / pace


@declared
@dataclass(frozen=True, kw_only=True)
class Stop(AnyLaw):
    """A progressive stop: ``rate x + progression x^3``, x being how far it is pressed in.

    Parameters
    ----------
    side
        "bump": acts when the element is shorter than `length` and pushes its ends apart.
        "rebound": acts when the element is longer than `length` and pulls them together.
    length
        Name of the parameter: length of the element at which the stop is touched [m].
    rate, progression
        Names of the parameters [N/m, N/m^3].
    """

    side: Literal["bump", "rebound"]
    length: Length
    rate: Amount
    progression: Amount

    not_named: ClassVar[tuple[str, ...]] = ("side",)

    @property
    def signal(self) -> str:
        """Name of the signal that shows the force."""
        return f"{self.side}_stop_force"

    @property
    def meaning(self) -> str:
        """What that signal is."""
        return f"force of the {self.side} stop"

    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""
        sense = 1 if self.side == "bump" else -1
        gap = at.program.define(
            f"{at.name}_{self.side}_gap", sense * (sp.Symbol(self.length) - at.length)
        )
        x = at.program.define(f"{at.name}_{self.side}_depth", Positive(gap))
        return sense * x * (sp.Symbol(self.rate) + sp.Symbol(self.progression) * x**2)


@declared
@dataclass(frozen=True, kw_only=True)
class Actuator(AnyLaw):
    """A force that is given from outside.

    Parameters
    ----------
    input
        Name of the input [N].
    """

    input: Name

    signal = "actuator_force"
    meaning = "actuator force"

    @property
    def inputs(self) -> tuple[str, ...]:
        """The force."""
        return (self.input,)

    def force(self, at: Stretch) -> sp.Expr:
        """Return the force on the ends."""
        del at
        return sp.Symbol(self.input)


Law = LinearSpring | LinearDamper | DamperTable | Friction | Stop | Actuator
