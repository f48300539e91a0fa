"""What every tyre answers: forces, moments, stiffnesses and lengths, of arrays."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ...core.validator import Validator

if TYPE_CHECKING:
    from ...generator.declare.contact_laws import ContactLaw

Array = NDArray[np.float64]

USUAL_SPEED = 16.7
"""Speed of a tyre's measurement where no file has one [m/s]."""
LOWEST_SPEED = 1.0
"""Speed below which slips are smoothed where no file has one [m/s]."""
_UNITS = {
    "load": "N", "slip_angle": "rad", "slip": "", "camber": "rad", "speed": "m/s", "pressure": "Pa",
}  # fmt: skip


@dataclass(frozen=True)
class TyreState:
    """Forces of a tyre in some states, in the axes of ISO 8855 at its contact.

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
        Relaxation lengths [m]; NaN where nothing says them.
    loaded_radius, effective_radius
        From the axis to the road in the plane of the wheel; speed over rate of spin of a wheel
        that rolls freely [m].
    vertical_stiffness
        Load over deflection, at the load [N/m].
    outside : dict of str to ndarray of bool
        By argument, where it was outside the range for which the tyre is known, and was replaced by
        the end of that range. Empty where none was.
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


class Tyre(ABC):
    """A tyre: forces and moments by load and slip.

    Attributes
    ----------
    name : str
        Which formulas it has.
    nominal_load : float
        [N].
    radius : float
        Of its file, without load [m].
    ranges : dict of str to (float, float)
        By argument of `evaluate`, where the tyre is known.
    side : str
        ``"left"``, ``"right"`` or empty: the side of the vehicle that it is for.
    lowest_speed : float
        Below which slips are smoothed in equations of motion [m/s].
    vertical_damping : float
        Along the normal [N s/m].
    left_out, assumed : tuple of str
        Keys of its file that are not used, and what that leaves open.
    law : str
        What its equations are called in names.
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
        """The radius in equations of motion at no load [m]."""
        return self.radius

    @abstractmethod
    def mirrored(self) -> Self:
        """Return the mirror image: the same tyre on the other side of the vehicle."""

    @abstractmethod
    def contact_law(self, name: str = "tyre") -> "ContactLaw":
        """Return the law of a rolling tyre in equations of motion, without its numbers.

        Parameters
        ----------
        name : str, optional
            Begins the names of its parameters, which `parameters` returns.
        """

    @abstractmethod
    def parameters(self, name: str = "tyre", *, relaxing: bool = False) -> dict[str, float]:
        """Return the parameters that equations of motion have of this tyre, in SI units.

        Parameters
        ----------
        name : str, optional
            Begins their names.
        relaxing : bool, optional
            Whether relaxation lengths are needed.
        """

    @abstractmethod
    def _state(self, at: States) -> dict[str, Any]:
        """Return the fields of a `TyreState` but the load and what is outside."""

    def on(self, side: str) -> Self:
        """Return the tyre as it is on a side of the vehicle.

        Parameters
        ----------
        side : {'left', 'right'}

        Returns
        -------
        Tyre
            Itself, or its mirror image where it was measured for the other side.
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
        """Return forces, moments, stiffnesses and lengths; arguments broadcast.

        Parameters
        ----------
        load : array_like
            Force of the road on the tyre along its normal [N], zero or more.
        slip_angle : array_like, optional
            arctan(Vy / abs(Vx)) of the contact [rad], positive where it moves to the left: the
            lateral force is to the right then.
        slip : array_like, optional
            kappa = -Vsx / abs(Vx): positive in driving, -1 of a wheel that is locked.
        camber : array_like, optional
            Inclination about x [rad], positive with the top to the right (ISO 8855), on both sides
            of the vehicle.
        speed : array_like, optional
            Vx [m/s], negative rolling backward; that of the measurement unless given.
        pressure : array_like, optional
            Inflation pressure [Pa]; that of the file unless given.
        extrapolate : bool, optional
            Whether arguments outside the ranges are used as they are; else the end of the range is
            taken for them, and `TyreState.outside` says where.

        Returns
        -------
        TyreState

        Raises
        ------
        InputError
            If an argument is no number, or the shapes do not broadcast.

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
            self._see(given, arrays, pressure is not None)
            try:
                found = dict(zip(arrays, np.broadcast_arrays(*arrays.values()), strict=True))
            except ValueError:
                shapes = ", ".join(f"{k} {v.shape}" for k, v in arrays.items())
                given.fail(f"the shapes do not broadcast: {shapes}.")
        load_there = found["load"]
        outside = {} if extrapolate else self._cut(found)
        with np.errstate(over="ignore", under="ignore"):
            state = self._state(States(**found))
        shape = load_there.shape
        fields = {k: np.array(np.broadcast_to(v, shape)) for k, v in state.items()}
        return TyreState(**fields, fz=np.array(load_there), outside=outside)

    def _see(self, given: Validator, arrays: Mapping[str, Array], with_pressure: bool) -> None:
        """Refuse what no tyre does."""
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

    def _cut(self, found: dict[str, Array]) -> dict[str, NDArray[np.bool_]]:
        """Bring arguments into their ranges; return where they were outside."""
        outside = {}
        for name, (low, high) in self.ranges.items():
            values = found[name]
            # a load below the least one is that load: forces vanish with it
            beyond = (values > high) | ((values < low) & (name != "load"))
            if beyond.any():
                outside[name] = beyond
                found[name] = np.clip(values, None if name == "load" else low, high)
        return outside
