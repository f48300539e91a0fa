"""Bodies: moving ones with mass, and the ground."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

from ..program.vectors import ELEMENTS
from .declared import DeclarationError, Name, Number, Numeral, declared
from .geometry import ORIGIN, Direction, Point
from .parameters import Mass, MomentOfInertia, Owner, Parameter, ProductOfInertia, next_order

# Names of the numbers of an inertia, their allowed counts, and their meaning.
_Elements = tuple[tuple[str, ...], tuple[int, ...], str]
_SPATIAL: _Elements = (ELEMENTS, (0, 3, 6), "{element} element of the inertia tensor of the {body}")
_MIRRORED = ("xy", "yz")  # products with y change their sign in the mirror


@declared
@dataclass(frozen=True)
class Inertia(Owner):
    """The inertia of a body about its centre of mass: named numbers of it."""

    body: Name  # name of the body
    # elements (`ELEMENTS` of the tensor; `spin` and `diametral` of a rotor), with defaults [kg m^2]
    # and meanings
    given: tuple[tuple[str, Number, str], ...]

    @cached_property
    def numbers(self) -> tuple[Parameter, ...]:
        return tuple(
            (ProductOfInertia if element in ELEMENTS[3:] else MomentOfInertia)(
                f"{self.body}_inertia_{element}", value, meaning
            )
            for element, value, meaning in self.given
        )

    @property
    def turned(self) -> tuple[int, ...]:
        return tuple(-1 if element in _MIRRORED else 1 for element, *_ in self.given)


@declared
@dataclass(frozen=True)
class Body:
    """A rigid body.

    Parameters
    ----------
    name
        Prefix of the names of its parameters, ``<name>_mass`` and so on.
    mass
        Default mass [kg].
    com
        Centre of mass at the design position: a point, or its default coordinates [m].
    inertia
        Default elements of the inertia tensor about the centre of mass, world axes at the design
        position [kg m^2]: xx, yy, zz, and also xy, xz, yz where they are not zero (xy is minus the
        product of inertia). Of a body of a planar mechanism one number, the moment of inertia about
        the normal of the plane; it may be left out of a body that does not rotate.
    """

    name: Name
    mass: Mass | Number
    com: Point | tuple[Number, Number, Number]
    inertia: Inertia | Number | tuple[Number, ...] = ()
    order: int = field(default_factory=next_order, repr=False, compare=False, kw_only=True)

    def __post_init__(self) -> None:
        place = self.order  # its parameters have its place in lists
        if not isinstance(self.mass, Mass):
            what = self.name if self._normal else f"the {self.name}"
            mass = Mass(f"{self.name}_mass", self.mass, f"mass of {what}", order=place)
            self._set("mass", mass)
        if not isinstance(self.com, Point):
            meaning = f"centre of mass of the {self.name}"
            self._set("com", Point(f"{self.name}_com", self.com, meaning, order=place))
        if not isinstance(self.inertia, Inertia):
            self._set("inertia", Inertia(self.name, self._elements(), order=place))

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    @property
    def center(self) -> Point:
        """The centre of mass."""
        assert isinstance(self.com, Point)
        return self.com

    @property
    def _normal(self) -> str:
        """Axis across the plane of a planar body; empty for others."""
        return self.com.flat if isinstance(self.com, Point) else ""

    def _elements(self) -> tuple[tuple[str, float, str], ...]:
        given: tuple[Any, ...] = (
            self.inertia if isinstance(self.inertia, tuple) else (self.inertia,)
        )
        names, allowed, meaning = _SPATIAL
        if self._normal:
            names, allowed, meaning = (
                (2 * self._normal,),
                (0, 1),
                "inertia of {body} across the plane",
            )
        if len(given) not in allowed:
            counts = " or ".join(str(n) for n in allowed if n)
            problem = f"inertia has {len(given)} number(s); {counts} are needed"
            raise DeclarationError(f"Body {self.name!r}", [problem])
        if not self._normal:
            given = (*given, *[0.0] * (len(ELEMENTS) - len(given)))
        return tuple(
            (element, value, meaning.format(element=element, body=self.name))
            for element, value in zip(names, given, strict=False)
        )

    @property
    def rotor_axis(self) -> Direction | None:
        """The axis of a body of revolution that spins about a bearing; None for others."""
        return None


@declared
@dataclass(frozen=True)
class Rotor(Body):
    """A body of revolution that spins about a bearing, such as a wheel.

    Parameters
    ----------
    name, mass, com
        Name, mass [kg], and centre of mass at the design position, which is on the axis [m].
    axis
        Direction of its axis of revolution.
    spin, diametral
        Default moments of inertia about the axis and about any axis perpendicular to it through the
        centre of mass [kg m^2].
    """

    inertia: Inertia | None = field(default=None, kw_only=True)  # type: ignore[assignment] # of spin, diametral
    axis: Direction = field(kw_only=True)
    spin: Number = field(kw_only=True)
    diametral: Number = field(kw_only=True)

    turns_about: ClassVar[tuple[str, ...]] = ("axis",)

    def _elements(self) -> tuple[tuple[str, float, str], ...]:
        return (
            ("spin", self.spin, f"inertia of the {self.name} about its spin axis"),
            ("diametral", self.diametral, f"inertia of the {self.name} across its axis"),
        )

    @property
    def rotor_axis(self) -> Direction:
        """Its axis."""
        return self.axis


@declared
@dataclass(frozen=True)
class Ground(Body):
    """The body that is fixed in the world, with axes along those of the world.

    Parameters
    ----------
    name
        Name of the body, such as ``"chassis"``.
    number
        Its number in reports; the other bodies continue from it, in the order in which they were
        declared.
    """

    mass: Mass | Number = field(default=0.0, init=False)
    com: Point = field(default=ORIGIN, init=False)
    inertia: tuple[()] = field(default=(), init=False)
    number: Numeral = 0

    def __post_init__(self) -> None:
        """Own no parameters."""
