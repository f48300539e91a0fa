"""Parameters, numbers that users of the generated code may change, and their owners.

Every declared object owns its parameters: a point its coordinates, a body its mass, a law its
rates. A mechanism collects them from its parts, in the order in which their owners were written.
The type of a parameter defines its unit and its range.
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
    """Return a number greater than all before: the place in lists of a new object."""
    return next(_written)


@dataclass(frozen=True)
class Image:
    """The original of an owner in a copy."""

    original: Owner  # owner whose parameters represent those of the copy
    signs: tuple[int, ...]  # of every number: -1 where a mirror reverses it


@dataclass(frozen=True, kw_only=True)
class Owner:
    """An owner of parameters."""

    # place in lists: that of its creation, which `dataclasses.replace` keeps
    order: int = field(default_factory=next_order, repr=False, compare=False)
    image: Any = field(default=None, repr=False)  # in a copy: its original, which owns the numbers

    @property
    def numbers(self) -> tuple[Parameter, ...]:
        """Its parameters under its own names."""
        raise NotImplementedError

    @property
    def turned(self) -> tuple[int, ...]:
        """Sign of every number in the mirror."""
        return (1,) * len(self.numbers)

    @property
    def root(self) -> Owner:
        """The owner of the numbers: itself, or its original."""
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
        """Expressions of its names in parameters of the original; empty for an original."""
        if self.image is None:
            return {}
        return {p.name: value for p, value in zip(self.numbers, self.values, strict=True)}


@declared
@dataclass(frozen=True)
class Parameter(Owner):
    """A number that a user of the generated code may change.

    Attributes
    ----------
    name
        Name of the parameter in the generated code.
    default
        Value in SI units.
    unit
        Unit of SI without a prefix, such as m, N or kg m^2.
    meaning
        Description in the documentation of the generated code.
    least, above, most
        Bounds of its values: the least value, an exclusive lower bound, and the greatest value;
        None for no bound.
    """

    name: Name
    default: Number
    unit: str
    meaning: str
    least: Number | None = None
    above: Number | None = None
    most: Number | None = None

    of_angle: ClassVar[bool | None] = False
    """Whether it is about an angle or a moment (True), a length or a force (False), or neither."""

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
        return (self,)


@declared
@dataclass(frozen=True)
class DimensionedParameter(Parameter):
    """A parameter whose class defines its unit and its range.

    Parameters
    ----------
    name, default, meaning
        As of a `Parameter`.
    least, above, most
        Bounds instead of those of the class.
    """

    unit: str = field(default="", init=False)

    _bounds: ClassVar[dict[str, float]] = {}

    def __init_subclass__(
        cls, *, unit: str, of_angle: bool | None = False, **bounds: float
    ) -> None:
        super().__init_subclass__()
        cls.unit, cls.of_angle, cls._bounds = unit, of_angle, bounds

    def __post_init__(self) -> None:
        super().__post_init__()
        for bound, value in self._bounds.items():
            if getattr(self, bound) is None:
                object.__setattr__(self, bound, value)


class Mass(DimensionedParameter, unit="kg", least=0.0):
    """A mass [kg], not negative."""


class MomentOfInertia(DimensionedParameter, unit="kg m^2", least=0.0):
    """A moment of inertia [kg m^2], not negative."""


class ProductOfInertia(DimensionedParameter, unit="kg m^2"):
    """A product of inertia [kg m^2]."""


class Displacement(DimensionedParameter, unit="m"):
    """A coordinate or a height [m], of any sign."""


class Length(DimensionedParameter, unit="m", least=0.0):
    """A length [m], not negative."""


class Distance(DimensionedParameter, unit="m", above=0.0):
    """A distance [m], more than zero."""


class Angle(DimensionedParameter, unit="rad", of_angle=True):
    """An angle [rad], of any sign."""


class Speed(DimensionedParameter, unit="m/s", above=0.0):
    """A speed [m/s], more than zero."""


class AngularSpeed(DimensionedParameter, unit="rad/s", above=0.0, of_angle=True):
    """An angular speed [rad/s], more than zero."""


class TimeConstant(DimensionedParameter, unit="s", above=0.0, of_angle=None):
    """The time constant of a lag [s], more than zero."""


class Gravity(DimensionedParameter, unit="m/s^2", least=0.0):
    """The acceleration of gravity [m/s^2], not negative."""


class ForceLevel(DimensionedParameter, unit="N", least=0.0):
    """The amount of a force [N], not negative."""


class MomentLevel(DimensionedParameter, unit="N m", least=0.0, of_angle=True):
    """The amount of a moment [N m], not negative."""


class SpringRate(DimensionedParameter, unit="N/m", least=0.0):
    """The rate of a spring [N/m], not negative."""


class TorsionRate(DimensionedParameter, unit="N m/rad", least=0.0, of_angle=True):
    """The rate of a torsion spring [N m/rad], not negative."""


class DamperRate(DimensionedParameter, unit="N s/m", least=0.0):
    """The rate of a damper [N s/m], not negative."""


class TorsionDamperRate(DimensionedParameter, unit="N m s/rad", least=0.0, of_angle=True):
    """The rate of a damper of rotation [N m s/rad], not negative."""


class Progression(DimensionedParameter, unit="N/m^3", least=0.0):
    """The coefficient of the cubic term of a stop [N/m^3], not negative."""


class TorsionProgression(DimensionedParameter, unit="N m/rad^3", least=0.0, of_angle=True):
    """The coefficient of the cubic term of a stop of an angle [N m/rad^3], not negative."""


class Ratio(DimensionedParameter, unit="1"):
    """A ratio of two angles, or of two lengths [1], of any sign."""


class Lead(DimensionedParameter, unit="m/rad"):
    """Displacement of a thread, rack or rope per radian of a turn [m/rad], of any sign."""


class TurnPerTravel(DimensionedParameter, unit="rad/m"):
    """Rotation per metre of a slide [rad/m], of any sign."""


class Share(DimensionedParameter, unit="1", least=0.0, most=1.0):
    """A number between 0 and 1."""
