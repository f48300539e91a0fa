"""Forces of a rolling tyre on the road: load, forces and moments at its contact."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ...formulas import linear_contact, magic_formula, tmeasy, vertical
from ...formulas.arithmetic import at_most
from ...formulas.coefficients import IN_EQUATIONS, NEUTRAL, ODD
from ...formulas.magic_formula import Contact, Form
from .declared import DeclarationError, Name, declared
from .parameters import Owner, Parameter

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...formulas.arithmetic import Arithmetic
    from ...formulas.magic_formula import Forces


_SMALL_DEFLECTION = sp.Rational(1, 10**9)  # added to a radicand [m]


@dataclass(frozen=True)
class RollingState:
    """Rolling motion of a tyre at an instant."""

    load: sp.Expr  # force of the road along its normal [N]
    # -Vsx and Vcy over the smoothed speed, a tangent
    longitudinal: sp.Expr
    lateral: sp.Expr
    inclination: sp.Expr  # sine of the inclination about the forward axis
    # Vcx over the speed of the contact, and over its own absolute value; both smoothed near
    # standstill
    direction: sp.Expr
    rolling: sp.Expr
    speed: sp.Expr  # Vcx [m/s]
    size: sp.Expr  # absolute value of Vcx, smoothed near standstill [m/s]

    def contact(self, **others: sp.Expr) -> Contact:
        """Return the inputs of formulas, with some of them replaced."""
        own = {key: value for key, value in vars(self).items() if key != "size"}
        return Contact(**(own | others))


@dataclass(frozen=True, kw_only=True)
class AnyContactLaw(Owner):
    """Base of the laws of a contact.

    Parameters
    ----------
    name
        Prefix of the names of its parameters.
    """

    name: Name

    _POSITIVE: ClassVar[tuple[str, ...]] = ("vxlow",)
    """Divisors of the law, which are positive for every tyre."""

    @cached_property
    def numbers(self) -> tuple[Parameter, ...]:
        return tuple(
            Parameter(
                f"{self.name}_{what}",
                default,
                unit,
                meaning,
                above=0.0 if what in self._POSITIVE else None,
            )
            for what, default, unit, meaning in self._entries()
        )

    @abstractmethod
    def _entries(self) -> Iterator[tuple[str, float, str, str]]:
        """Yield name, default, unit and meaning of each parameter."""

    def symbol(self, what: str) -> sp.Symbol:
        """Return the symbol of a parameter, by its name without that of the law."""
        return sp.Symbol(f"{self.name}_{what}")

    @property
    def lowest_speed(self) -> sp.Expr:
        """Speed below which slips are smoothed [m/s]."""
        return self.symbol("vxlow")

    @property
    def radius(self) -> sp.Expr:
        """Radius of the disc, without load [m]."""
        return self.symbol("unloaded_radius")

    @abstractmethod
    def load(self, deflection: sp.Expr) -> sp.Expr:
        """Return the load of a deflection [N]; zero of none."""

    @abstractmethod
    def rolling_radius(self, a: Arithmetic, load: sp.Expr) -> sp.Expr:
        """Return the speed of a freely rolling wheel over its rate of spin [m].

        Parameters
        ----------
        a
            Defines intermediate values, and has the functions of formulas.
        load
            Force along the normal of the road [N].
        """

    @abstractmethod
    def forces(self, a: Arithmetic, at: RollingState) -> Forces:
        """Return forces [N] and moments [N m] at the contact.

        Parameters
        ----------
        a
            Defines intermediate values, and has the functions of formulas.
        at
            Rolling motion of the tyre.
        """

    @abstractmethod
    def relaxation(
        self, a: Arithmetic, load: sp.Expr, inclination: sp.Expr
    ) -> tuple[sp.Expr, sp.Expr]:
        """Return the longitudinal and the lateral relaxation length [m].

        Parameters
        ----------
        a
            Defines intermediate values, and has the functions of formulas.
        load
            Force along the normal of the road [N].
        inclination
            Sine of the inclination about the forward axis.
        """

    @abstractmethod
    def describe(self) -> str:
        """Return its description in reports."""


@declared
@dataclass(frozen=True, kw_only=True)
class LinearContact(AnyContactLaw):
    """Forces that are linear at small slip, and approach the limit of friction.

    With F = (C_x kappa, -C_y tan(alpha) - C_gamma sin(gamma)), the horizontal force is
    ``F / sqrt(1 + |F|^2 / (mu F_z)^2)``.

    Parameters
    ----------
    name
        Prefix of the names of its parameters: ``<name>_vertical_stiffness``, ``<name>_friction``.
    """

    _POSITIVE: ClassVar[tuple[str, ...]] = (
        "unloaded_radius", "effective_radius", "vertical_stiffness", "vxlow",
    )  # fmt: skip

    def _entries(self) -> Iterator[tuple[str, float, str, str]]:
        yield "unloaded_radius", 0.3, "m", "radius of the tyre without load"
        yield "effective_radius", 0.29, "m", "speed over rate of spin of a freely rolling wheel"
        yield "vertical_stiffness", 200e3, "N/m", "vertical stiffness of the tyre"
        yield "vxlow", 1.0, "m/s", "speed below which slips are smoothed"
        yield "relaxation_x", 0.3, "m", "longitudinal relaxation length"
        yield "relaxation_y", 0.5, "m", "lateral relaxation length"
        defaults = (9e4, 7e4, 3e3, 0.03, 1.0, 0.0)
        for default, (what, described) in zip(
            defaults, linear_contact.COEFFICIENTS.items(), strict=True
        ):
            yield what, default, *described

    def load(self, deflection: sp.Expr) -> sp.Expr:
        return self.symbol("vertical_stiffness") * deflection

    @override
    def rolling_radius(self, a: Arithmetic, load: sp.Expr) -> sp.Expr:
        return self.symbol("effective_radius")

    @override
    def forces(self, a: Arithmetic, at: RollingState) -> Forces:
        p = {what: self.symbol(what) for what in linear_contact.COEFFICIENTS}
        contact = at.contact(pressure=sp.Integer(0))
        return linear_contact.forces(a, p, contact, self.radius)

    @override
    def relaxation(
        self, a: Arithmetic, load: sp.Expr, inclination: sp.Expr
    ) -> tuple[sp.Expr, sp.Expr]:
        return self.symbol("relaxation_x"), self.symbol("relaxation_y")

    def describe(self) -> str:
        return "linear at small slip, limited by friction"


@declared
@dataclass(frozen=True, kw_only=True)
class MagicFormulaContact(AnyContactLaw):
    """The Magic Formula, with the coefficients of property files as parameters.

    Equations are those of Pacejka, Tire and Vehicle Dynamics, third edition, section 4.3.2.

    Parameters
    ----------
    name
        Prefix of the names of its parameters: ``<name>_pcx1``, as property files have them.
    newer
        Whether the version is MF 6.1 or 6.2; else PAC2002.
    weighted
        Whether combined slip has weighting functions; else the friction ellipse.
    angle
        Whether the lateral slip is an angle [rad]; else its tangent.
    without
        Coefficients without effect in the intended tyres: they are not parameters, and their terms
        are left out.
    """

    newer: bool = True
    weighted: bool = True
    angle: bool = False
    without: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        unknown = [key for key in self.without if key not in IN_EQUATIONS]
        if unknown:
            problems = [f"{key!r} is not a coefficient of these equations" for key in unknown]
            raise DeclarationError(f"MagicFormulaContact {self.name!r}", problems)

    _SIZES: ClassVar[Mapping[str, tuple[float, str, str]]] = {
        "UNLOADED_RADIUS": (0.316, "m", "radius of the tyre without load"),
        "FNOMIN": (4000.0, "N", "nominal load of the tyre"),
        "LONGVL": (16.7, "m/s", "speed at which the tyre was measured"),
        "LONGITUDINAL_STIFFNESS": (3.6e5, "N/m", "longitudinal stiffness of the carcass"),
        "LATERAL_STIFFNESS": (1.3e5, "N/m", "lateral stiffness of the carcass"),
        "VXLOW": (1.0, "m/s", "speed below which slips are smoothed"),
        "INFLPRES": (220e3, "Pa", "inflation pressure of the tyre"),
        "NOMPRES": (220e3, "Pa", "inflation pressure at which the tyre was measured"),
    }
    _POSITIVE: ClassVar[tuple[str, ...]] = tuple(key.lower() for key in _SIZES)
    _USUAL: ClassVar[Mapping[str, float]] = {
        "PCX1": 1.6, "PDX1": 1.1, "PKX1": 22.0, "PCY1": 1.35, "PDY1": 1.0, "PKY1": -20.0,
        "PKY2": 1.8, "QBZ1": 10.0, "QBZ9": 10.0, "QCZ1": 1.1, "QDZ1": 0.1, "RBX1": 12.0,
        "RBX2": 10.0, "RBY1": 11.0, "RBY2": 8.0, "Q_FZ1": 15.8, "PTX1": 2.0, "PTY1": 2.0,
        "PTY2": 1.8,
    }  # fmt: skip

    def _entries(self) -> Iterator[tuple[str, float, str, str]]:
        for key, described in self._SIZES.items():
            yield key.lower(), *described
        for key in self._keys:
            default = self._USUAL.get(key, NEUTRAL[key])
            yield key.lower(), default, "1", f"coefficient {key} of the Magic Formula"

    @property
    def turned(self) -> tuple[int, ...]:
        return tuple(-1 if key in ODD else 1 for key in (*self._SIZES, *self._keys))

    @property
    def _keys(self) -> tuple[str, ...]:
        return tuple(key for key in IN_EQUATIONS if key not in self.without)

    @cached_property
    def _coefficients(self) -> dict[str, sp.Expr]:
        fixed = {key: sp.Integer(int(NEUTRAL[key])) for key in self.without}
        return fixed | {key: self.symbol(key.lower()) for key in (*self._SIZES, *self._keys)}

    @property
    def _pressure(self) -> sp.Expr:
        return self._coefficients["INFLPRES"] / self._coefficients["NOMPRES"] - 1

    @property
    def _stiffening(self) -> sp.Expr:
        """Factor of the load by scale and pressure."""
        return self._coefficients["LCZ"] * (1 + self._coefficients["PFZ1"] * self._pressure)

    @property
    def radius(self) -> sp.Expr:
        return self._coefficients["UNLOADED_RADIUS"] * self._coefficients["Q_RE0"]

    def load(self, deflection: sp.Expr) -> sp.Expr:
        """Return the load of a deflection [N] (A3.3)."""
        share = deflection / self._coefficients["UNLOADED_RADIUS"]
        shape = share * (self._coefficients["Q_FZ1"] + self._coefficients["Q_FZ2"] * share)
        return shape * (self._coefficients["FNOMIN"] * self._stiffening)

    @override
    def rolling_radius(self, a: Arithmetic, load: sp.Expr) -> sp.Expr:
        # (A3.6)
        first, second = self._coefficients["Q_FZ1"], self._coefficients["Q_FZ2"]
        moved = self._stiffening
        # load over slope of the deflection, at the nominal load
        length = self._coefficients["UNLOADED_RADIUS"] / (
            moved * sp.sqrt(first * first + 4 * second / moved)
        )
        share = load / self._coefficients["FNOMIN"]
        part = self._coefficients["DREFF"] * a.atan(self._coefficients["BREFF"] * share)
        return self.radius - length * (part + self._coefficients["FREFF"] * share)

    @override
    def forces(self, a: Arithmetic, at: RollingState) -> Forces:
        given = {"speed": at.speed / self._coefficients["LONGVL"], "pressure": self._pressure}
        if self.angle:
            given["lateral"] = a.define("slip_as_angle", a.atan(at.lateral))
        contact = at.contact(**given)
        form = Form(newer=self.newer, weighted=self.weighted, angle=self.angle)
        return magic_formula.forces(a, self._coefficients, contact, form)

    @override
    def relaxation(
        self, a: Arithmetic, load: sp.Expr, inclination: sp.Expr
    ) -> tuple[sp.Expr, sp.Expr]:
        # stiffness over that of the carcass (A3.9); of PAC2002 by PTX and PTY
        p, zero = self._coefficients, sp.Integer(0)
        nominal = p["FNOMIN"] * p["LFZO"]
        dfz = a.define("load_change", (load - nominal) / nominal)
        if not self.newer:
            return vertical.relaxation_by_load(a, p, load, dfz, inclination)
        still = Contact(load, zero, zero, inclination, zero, zero, zero, self._pressure)
        stiff = magic_formula.stiffnesses(a, p, still)
        return vertical.relaxation_by_stiffness(p, dfz, self._pressure, *stiff)

    def describe(self) -> str:
        return "the Magic Formula" + ("" if self.newer else " of PAC2002")


@declared
@dataclass(frozen=True, kw_only=True)
class TMeasyContact(AnyContactLaw):
    """TMeasy: curves by slope, maximum and sliding force at two loads.

    Equations are those of Rill, Road Vehicle Dynamics, CRC Press 2012, chapter 3.

    Parameters
    ----------
    name
        Prefix of the names of its parameters: ``<name>_x_slope_1``, ``<name>_friction``.
    """

    _POSITIVE: ClassVar[tuple[str, ...]] = ("radius", "nominal_load", "vxlow")

    def _entries(self) -> Iterator[tuple[str, float, str, str]]:
        yield "vxlow", 1.0, "m/s", "speed below which slips are smoothed"
        for what, described in tmeasy.COEFFICIENTS.items():
            yield what, *described

    @cached_property
    def _coefficients(self) -> dict[str, sp.Expr]:
        return {what: self.symbol(what) for what in tmeasy.COEFFICIENTS}

    @property
    def radius(self) -> sp.Expr:
        return self.symbol("radius")

    def load(self, deflection: sp.Expr) -> sp.Expr:
        return tmeasy.load_of(self._coefficients, deflection)

    @override
    def rolling_radius(self, a: Arithmetic, load: sp.Expr) -> sp.Expr:
        p = self._coefficients
        deflection = self._deflection(a, load)
        once, twice = p["rolling_1"], p["rolling_2"]
        weight = tmeasy.by_load(load, p["nominal_load"], once, twice, quadratic=False)
        return p["radius"] - deflection * (1 - at_most(a, weight, sp.Integer(1)))

    def _deflection(self, a: Arithmetic, load: sp.Expr) -> sp.Expr:
        found, _ = tmeasy.deflection_of(a, self._coefficients, load)
        return a.define("pressed_by_load", found)

    @override
    def forces(self, a: Arithmetic, at: RollingState) -> Forces:
        pressed = self._deflection(a, at.load) + _SMALL_DEFLECTION
        length = a.define("contact_length", 2 * a.sqrt(self.radius * pressed))
        contact = at.contact(pressure=sp.Integer(0))
        return tmeasy.forces(a, self._coefficients, contact, length)

    @override
    def relaxation(
        self, a: Arithmetic, load: sp.Expr, inclination: sp.Expr
    ) -> tuple[sp.Expr, sp.Expr]:
        p = self._coefficients
        load = at_most(a, load, p["greatest_load"])
        x, y = (
            tmeasy.by_load(
                load, p["nominal_load"], p[f"{axis}_slope_1"], p[f"{axis}_slope_2"], quadratic=True
            )
            / p[f"stiffness_{axis}"]
            for axis in "xy"
        )
        return x, y

    def describe(self) -> str:
        return "TMeasy"


ContactLaw = LinearContact | MagicFormulaContact | TMeasyContact
