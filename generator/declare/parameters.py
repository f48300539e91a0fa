"""Numbers that a user of the generated code may change, and what owns them.

Whatever is declared owns its parameters: a point its coordinates, a body its mass, a law its rates.
A mechanism collects them from what refers to them, in the order in which their owners were written.
The type of a parameter says its unit and its range.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import count
from typing import Any, ClassVar

import sympy as sp

from ...core.si_units import problem_of
from .declared import DeclarationError, Name, Number, declared

_written = count()


def next_order() -> int:
    """Return a number greater than all before: the place of what is written now."""
    return next(_written)


@dataclass(frozen=True)
class Image:
    """What an owner in a copy is the image of.

    Attributes
    ----------
    original
        The owner whose parameters stand for those of the copy.
    signs
        Of every number: -1 where a mirror turns it round.
    """

    original: Owner
    signs: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Owner:
    """Something that owns parameters.

    Attributes
    ----------
    order
        Its place in lists: that of its creation, which `dataclasses.replace` keeps.
    image
        In a copy: what it is the image of; its numbers then are none of its own.
    """

    order: int = field(default_factory=next_order, repr=False, compare=False)
    image: Any = field(default=None, repr=False)

    @property
    def numbers(self) -> tuple[Parameter, ...]:
        """Its parameters under its own names."""
        raise NotImplementedError

    @property
    def turned(self) -> tuple[int, ...]:
        """The sign of every number in the mirror."""
        return (1,) * len(self.numbers)

    @property
    def root(self) -> Owner:
        """What owns the numbers: itself, or what it is an image of."""
        return self if self.image is None else self.image.original.root

    @cached_property
    def values(self) -> tuple[sp.Expr, ...]:
        """Its numbers in terms of parameters of the root."""
        if self.image is None:
            return tuple(p.symbol for p in self.numbers)
        pairs = zip(self.image.signs, self.image.original.values, strict=True)
        return tuple(sign * value for sign, value in pairs)

    @property
    def derived(self) -> dict[str, sp.Expr]:
        """What its names stand for, where they are no parameters."""
        if self.image is None:
            return {}
        return {p.name: value for p, value in zip(self.numbers, self.values, strict=True)}


@declared
@dataclass(frozen=True)
class Parameter(Owner):
    """A number that a user of the generated code may change.

    Attributes
    ----------
    default
        Value in SI units.
    unit
        Of SI, without a factor.
    meaning
        For the documentation of the generated code.
    least, above, most
        Bounds of its values: the smallest, what it must be more than, the greatest.
    """

    name: Name
    default: Number
    unit: str
    meaning: str
    least: Number | None = None
    above: Number | None = None
    most: Number | None = None

    of_angle: ClassVar[bool] = False
    """Whether it is about an angle or a moment, where others are about a length or a force."""

    def __post_init__(self) -> None:
        problem = problem_of(self.unit)
        if problem:
            raise DeclarationError(f"{type(self).__name__} {self.name!r}", [problem])

    @property
    def symbol(self) -> sp.Symbol:
        """The symbol in equations."""
        return sp.Symbol(self.name)

    @property
    def numbers(self) -> tuple[Parameter, ...]:
        """Itself."""
        return (self,)


@declared
@dataclass(frozen=True)
class Mass(Parameter):
    """A mass [kg], not negative."""

    unit: str = field(default="kg", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class MomentOfInertia(Parameter):
    """A moment of inertia [kg m^2], not negative."""

    unit: str = field(default="kg m^2", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class ProductOfInertia(Parameter):
    """A product of inertia [kg m^2]."""

    unit: str = field(default="kg m^2", init=False)


@declared
@dataclass(frozen=True)
class Displacement(Parameter):
    """A coordinate or a height [m], of any sign."""

    unit: str = field(default="m", init=False)


@declared
@dataclass(frozen=True)
class Length(Parameter):
    """A length [m], not negative."""

    unit: str = field(default="m", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class Distance(Parameter):
    """A distance [m], more than zero."""

    unit: str = field(default="m", init=False)
    above: Number | None = 0.0


@declared
@dataclass(frozen=True)
class Angle(Parameter):
    """An angle [rad], of any sign."""

    of_angle: ClassVar[bool] = True
    unit: str = field(default="rad", init=False)


@declared
@dataclass(frozen=True)
class Speed(Parameter):
    """A speed [m/s], more than zero."""

    unit: str = field(default="m/s", init=False)
    above: Number | None = 0.0


@declared
@dataclass(frozen=True)
class AngularSpeed(Parameter):
    """An angular speed [rad/s], more than zero."""

    of_angle: ClassVar[bool] = True
    unit: str = field(default="rad/s", init=False)
    above: Number | None = 0.0


@declared
@dataclass(frozen=True)
class Gravity(Parameter):
    """The acceleration of gravity [m/s^2], not negative."""

    unit: str = field(default="m/s^2", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class ForceLevel(Parameter):
    """The amount of a force [N], not negative."""

    unit: str = field(default="N", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class MomentLevel(Parameter):
    """The amount of a moment [N m], not negative."""

    of_angle: ClassVar[bool] = True
    unit: str = field(default="N m", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class SpringRate(Parameter):
    """The rate of a spring [N/m], not negative."""

    unit: str = field(default="N/m", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class TorsionRate(Parameter):
    """The rate of a torsion spring [N m/rad], not negative."""

    of_angle: ClassVar[bool] = True
    unit: str = field(default="N m/rad", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class DamperRate(Parameter):
    """The rate of a damper [N s/m], not negative."""

    unit: str = field(default="N s/m", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class TorsionDamperRate(Parameter):
    """The rate of a damper of rotation [N m s/rad], not negative."""

    of_angle: ClassVar[bool] = True
    unit: str = field(default="N m s/rad", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class Progression(Parameter):
    """The cubic term of a stop [N/m^3], not negative."""

    unit: str = field(default="N/m^3", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class TorsionProgression(Parameter):
    """The cubic term of a stop of rotation [N m/rad^3], not negative."""

    of_angle: ClassVar[bool] = True
    unit: str = field(default="N m/rad^3", init=False)
    least: Number | None = 0.0


@declared
@dataclass(frozen=True)
class Ratio(Parameter):
    """A ratio of two angles, or of two lengths, of any sign."""

    unit: str = field(default="1", init=False)


@declared
@dataclass(frozen=True)
class Lead(Parameter):
    """What a thread, a rack or a rope moves for each radian of a turn [m/rad], of any sign."""

    unit: str = field(default="m/rad", init=False)


@declared
@dataclass(frozen=True)
class TurnPerTravel(Parameter):
    """By how much something turns for each metre of a slide [rad/m], of any sign."""

    unit: str = field(default="rad/m", init=False)


@declared
@dataclass(frozen=True)
class Share(Parameter):
    """A number between 0 and 1."""

    unit: str = field(default="1", init=False)
    least: Number | None = 0.0
    most: Number | None = 1.0
