"""The interface of all tyres: forces, moments, stiffnesses and lengths, over arrays."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.validator import Validator
from ...formulas.magic_formula import Contact, Forces

if TYPE_CHECKING:
    from ...generator.declare.contact_laws import ContactLaw

USUAL_SPEED = 16.7
"""Speed of a tyre's measurement if its file has none [m/s]."""
LOWEST_SPEED = 1.0
"""Speed below which slips are smoothed if the file of the tyre has none [m/s]."""
_UNITS = {
    "load": "N", "slip_angle": "rad", "slip": "", "camber": "rad", "speed": "m/s", "pressure": "Pa",
}  # fmt: skip


@dataclass(frozen=True)
class TyreState:
    """Forces and properties of a tyre, in the axes of ISO 8855 at its contact.

    All arrays have the shape to which the arguments broadcast. x is forward, y left, z up.

    Attributes
    ----------
    fx, fy, fz
        Force of the road on the tyre [N].
    mx, my, mz
        Moment of the road on the tyre about the contact [N m].
    slip_stiffness, cornering_stiffness
        dFx over slip and -dFy over the tangent of the slip angle, at zero slip: both positive [N].
    trail
        Pneumatic trail [m].
    relaxation_x, relaxation_y
        Relaxation lengths [m]; NaN if the file does not give them.
    loaded_radius, effective_radius
        Distance from the axis to the road in the plane of the wheel; speed over rate of spin of
        a freely rolling wheel [m].
    vertical_stiffness
        Load over deflection, at the load [N/m].
    outside : dict of str to ndarray of bool
        By argument: elements outside the range of the tyre, which were replaced by the end of that
        range. Only arguments with such elements are present.
    """

    fx: Array
    fy: Array
    fz: Array
    mx: Array
    my: Array
    mz: Array
    slip_stiffness: Array
    cornering_stiffness: Array
    trail: Array
    relaxation_x: Array
    relaxation_y: Array
    loaded_radius: Array
    effective_radius: Array
    vertical_stiffness: Array
    outside: Mapping[str, NDArray[np.bool_]]


@dataclass(frozen=True)
class States:
    """Arguments of a tyre as arrays of equal shape, within its ranges; see `Tyre.evaluate`."""

    load: Array
    slip_angle: Array
    slip: Array
    camber: Array
    speed: Array
    pressure: Array

    def contact(self) -> Contact:
        """Return the state of the contact, with the speed in m/s and nominal pressure."""
        rolling = np.sign(self.speed)
        return Contact(
            load=self.load,
            longitudinal=self.slip,
            lateral=np.tan(self.slip_angle),
            inclination=np.sin(self.camber),
            direction=np.cos(self.slip_angle) * rolling,
            rolling=rolling,
            speed=self.speed,
            pressure=0.0,
        )


@dataclass(frozen=True)
class ContactTerms:
    """The contact law of a tyre, without SymPy."""

    name: str  # class of `kintrafo.generator`
    options: tuple[tuple[str, Any], ...] = ()  # names and values of its options

    def law(self, name: str) -> "ContactLaw":
        """Return the law with this prefix of its parameters."""
        from ... import generator  # noqa: PLC0415 (an extra)

        return getattr(generator, self.name)(name=name, **dict(self.options))


class Tyre(ABC):
    """The base of all tyres: forces and moments as functions of load and slip.

    Attributes
    ----------
    name : str
        Name of its formulas, such as ``"MF 6.1"``.
    nominal_load : float
        Reference load [N].
    radius : float
        Unloaded radius in the file [m].
    ranges : dict of str to (float, float)
        Ranges of validity by argument of `evaluate`, in its units.
    side : str
        Side of the vehicle for which it was measured: ``"left"``, ``"right"`` or empty.
    lowest_speed : float
        Speed below which slips are smoothed in equations of motion [m/s].
    vertical_damping : float
        Damping along the normal of the road in equations of motion [N s/m].
    left_out, assumed : tuple of str
        Unused keys of the file, and assumptions in place of missing ones.
    law : str
        Name of its contact law in names of generated equations.
    """

    law: ClassVar[str]
    name: str
    nominal_load: float
    radius: float
    ranges: Mapping[str, tuple[float, float]]
    side: str = ""
    lowest_speed: float = LOWEST_SPEED
    vertical_damping: float = 0.0
    usual_speed: float = USUAL_SPEED
    usual_pressure: float = 0.0
    left_out: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()

    @property
    def free_radius(self) -> float:
        """Unloaded radius in equations of motion [m]."""
        return self.radius

    @abstractmethod
    def mirrored(self) -> Self:
        """Return the mirror image: the same tyre on the other side of the vehicle."""

    def contact_law(self, name: str = "tyre") -> "ContactLaw":
        """Return the contact law of the equations of motion, with symbolic parameters.

        Parameters
        ----------
        name : str, optional
            Prefix of the parameters' names; their values are those of `parameters`.
        """
        return self.contact.law(name)

    @property
    @abstractmethod
    def contact(self) -> ContactTerms:
        """The class of the contact law, with the terms that this tyre has."""

    @abstractmethod
    def parameters(self, name: str = "tyre", *, relaxing: bool = False) -> dict[str, float]:
        """Return the values of the parameters of `contact_law`, in SI units.

        Parameters
        ----------
        name : str, optional
            Prefix of their names.
        relaxing : bool, optional
            Whether relaxation lengths are needed.
        """

    @abstractmethod
    def _state(self, at: States) -> tuple[Forces, dict[str, Any]]:
        """Return the forces, and lengths and the vertical stiffness by the names in `TyreState`."""

    def on(self, side: str) -> Self:
        """Return the tyre mounted on a side of the vehicle.

        Parameters
        ----------
        side : {'left', 'right'}

        Returns
        -------
        Tyre
            Itself, or its mirror image if it was measured for the other side.
        """
        with Validator("on") as given:
            given.among("side", side, ("left", "right"))
        return self if self.side in {"", side} else self.mirrored()

    def evaluate(
        self,
        load: Any,
        slip_angle: Any = 0.0,
        slip: Any = 0.0,
        camber: Any = 0.0,
        *,
        speed: Any = None,
        pressure: Any = None,
        extrapolate: bool = False,
    ) -> TyreState:
        """Return forces, moments, stiffnesses and lengths of the tyre in steady rolling.

        Arguments are broadcast with each other.

        Parameters
        ----------
        load : array_like
            Force of the road on the tyre along its normal [N], zero or more.
        slip_angle : array_like, optional
            arctan(Vy / abs(Vx)) of the velocity V of the contact [rad], positive if it moves to the
            left: the lateral force then acts to the right.
        slip : array_like, optional
            Longitudinal slip kappa = -Vsx / abs(Vx), with the sliding velocity Vsx of the contact:
            positive in driving, -1 for a locked wheel.
        camber : array_like, optional
            Inclination about x [rad], positive with the top to the right (ISO 8855), on both sides
            of the vehicle.
        speed : array_like, optional
            Vx [m/s], negative rolling backward. Default: the speed of the measurement.
        pressure : array_like, optional
            Inflation pressure [Pa]. Default: that of the file.
        extrapolate : bool, optional
            Whether arguments outside the ranges are used unchanged. By default they are replaced by
            the end of the range, and `TyreState.outside` marks them.

        Returns
        -------
        TyreState

        Raises
        ------
        InputError
            If an argument is not a number, or the shapes do not broadcast.

        Examples
        --------
        >>> import numpy as np
        >>> import kintrafo
        >>> tyre = kintrafo.tyres.load("passenger_205_55")
        >>> angles = np.radians([-4.0, 0.0, 4.0])
        >>> tyre.evaluate(4000.0, angles).fy.round(-1).tolist()
        [3530.0, -60.0, -3460.0]
        """
        with Validator("evaluate") as given:
            wanted = {
                "load": load,
                "slip_angle": slip_angle,
                "slip": slip,
                "camber": camber,
                "speed": self.usual_speed if speed is None else speed,
                "pressure": self.usual_pressure if pressure is None else pressure,
            }
            arrays = {k: given.array(k, v, _UNITS[k], empty=True) for k, v in wanted.items()}
            given.flag("extrapolate", extrapolate)
            self._check(given, arrays, pressure is not None)
            try:
                found = dict(zip(arrays, np.broadcast_arrays(*arrays.values()), strict=True))
            except ValueError:
                shapes = ", ".join(f"{k} {v.shape}" for k, v in arrays.items())
                given.fail(f"the shapes do not broadcast: {shapes}.")
        given_load = found["load"]
        outside = {} if extrapolate else self._clip(found)
        with np.errstate(over="ignore", under="ignore"):
            forces, others = self._state(States(**found))
        state = vars(forces) | others | {"cornering_stiffness": -forces.cornering_stiffness}
        shape = given_load.shape
        fields = {k: np.array(np.broadcast_to(v, shape)) for k, v in state.items()}
        return TyreState(**fields, fz=np.array(given_load), outside=outside)

    def _check(self, given: Validator, arrays: Mapping[str, Array], with_pressure: bool) -> None:
        """Refuse negative loads, angles beyond a right angle, and a pressure without effect."""
        if np.any(arrays["load"] < 0.0):
            given.fail(f"load = {arrays['load'].min():g} N: zero or more is needed.")
        for name in ("slip_angle", "camber"):
            if np.any(abs(arrays[name]) >= 0.5 * np.pi):
                given.fail(
                    f"{name} = {arrays[name].flat[abs(arrays[name]).argmax()]:g} rad: less than a "
                    "right angle is needed."
                )
        if with_pressure and not self.usual_pressure:
            given.fail("pressure: this tyre does not depend on it. Leave it out.")
        if np.any(arrays["pressure"] <= 0.0) and with_pressure:
            given.fail(f"pressure = {arrays['pressure'].min():g} Pa: more than zero is needed.")

    def _clip(self, found: dict[str, Array]) -> dict[str, NDArray[np.bool_]]:
        """Clip arguments to their ranges; return the elements that were outside."""
        outside = {}
        for name, (low, high) in self.ranges.items():
            values = found[name]
            # small loads are kept: the forces vanish with the load
            beyond = (values > high) | ((values < low) & (name != "load"))
            if beyond.any():
                outside[name] = beyond
                found[name] = np.clip(values, None if name == "load" else low, high)
        return outside


class SymmetricTyre(Tyre):
    """A tyre that is its own mirror image, and whose contact law has no options."""

    CONTACT_LAW: ClassVar[str]  # name of the class of its contact law in `kintrafo.generator`

    def mirrored(self) -> Self:
        return copy(self)

    @property
    def contact(self) -> ContactTerms:
        return ContactTerms(self.CONTACT_LAW)

    def parameters(self, name: str = "tyre", *, relaxing: bool = False) -> dict[str, float]:
        return {f"{name}_{key}": value for key, value in self._values().items()}

    @abstractmethod
    def _values(self) -> dict[str, float]:
        """Return the values of the parameters by their names without the prefix."""
