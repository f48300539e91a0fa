"""The base of suspensions and of axles without sides: the data of one file with wheels."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Self

from ...core.columns import number
from ..input.damper import NO_CURVE, Damper
from ..input.described import DescribedSection
from ..input.spring import rate_key
from ..input.stop import NO_STOP
from ..input.units import in_metres
from .wheel_loads import needed_radius

if TYPE_CHECKING:
    from ..input.hardpoints import Hardpoints
    from ..input.stop import StopSection
    from ..input.vehicle import GravitySection, TyreSection, WheelSection
    from .bushes import Bushings

NOT_STEERED = "{}: its wheels are not steered. Leave it out."
"""The problem of an option of the steering where there is none; with the name of the option."""
# The least height of a wheel centre above z = 0 if this is the ground [m].
_SMALLEST_WHEEL_RADIUS = 0.1


class WheeledSection(DescribedSection):
    """The data of a file with wheels, with a section for each attribute."""

    if TYPE_CHECKING:
        # sections of every class, each in the order of its file
        vehicle: Any
        hardpoints: Hardpoints
        wheel: WheelSection
        bump_stop: StopSection | None
        rebound_stop: StopSection | None
        tyre: TyreSection
        gravity: GravitySection
        bushings: Bushings | None

    @classmethod
    def steered(cls) -> bool:
        """Return whether the wheels are steered, by a rack or a Pitman arm."""
        return False

    @property
    def steered_by(self) -> str:
        """The key of the section of its steering; empty without steering."""
        return ""

    @property
    def steering_gear(self) -> Any:
        """The section of its steering; None without steering."""
        return None

    def tyre_radius(self) -> float | None:
        """Return the radius of a wheel as a thin disc [m].

        It is ``tyre.radius_mm``, by default the height of the wheel centre at design above z = 0,
        which is the ground in files that follow the conventions; None if this is less than 100 mm,
        as no car has such wheels.
        """
        if self.tyre.radius_mm is not None:
            return in_metres(self.tyre.radius_mm, "mm")
        height: float = number(self.hardpoints.metres("wheel_center")[2])
        return height if height >= _SMALLEST_WHEEL_RADIUS else None

    def wheel_load_parameters(self) -> dict[str, float]:
        """Return the additional parameters of equations with wheel loads as inputs [m].

        An unknown radius of the wheels raises an `InputError`.
        """
        return {"tyre_radius": needed_radius(self.tyre_radius())}

    def on_tyre(self, tyre: "TyreSection") -> Self:
        """Return the same data with another tyre."""
        return self.model_copy(update={"tyre": tyre})

    def in_vehicle(self, known: Mapping[str, float | None]) -> Self:
        """Return the same data in a vehicle with known values of keys that ``[vehicle]`` lacks."""
        found = {key: value for key, value in known.items() if getattr(self.vehicle, key) is None}
        return self.model_copy(update={"vehicle": self.vehicle.model_copy(update=found)})

    def rate_key(self, part: str) -> str:
        """Return the key of the rate of a part, "spring" or "damper", or of the spring's curve."""
        return rate_key(part, getattr(self, "spring", None))

    def parameters_of_extras(self, length: float, curve: Damper | None) -> dict[str, float]:
        """Return the further parameters of general equations, except friction, in SI units.

        `length` is the one that the stops limit, at the design position [m]; `curve` is that of the
        damper, if any.
        """
        values = dict(NO_CURVE) if curve is None else curve.parameters()
        for side, stop in (("bump", self.bump_stop), ("rebound", self.rebound_stop)):
            values |= (stop or NO_STOP).parameters(side, length)
        return values | {
            "tyre_damper_rate": self.tyre.damper_rate_N_s_per_m,
            "tyre_lifts_off": float(self.tyre.lifts_off),
        }
