"""A tyre whose forces are linear in slip up to the friction."""

from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from ...core.validator import Validator
from ...formulas import linear_contact
from ...formulas.arithmetic import ARRAYS
from ...formulas.magic_formula import Contact
from .tyre import States, Tyre

if TYPE_CHECKING:
    from ...generator.declare.contact_laws import ContactLaw

_POSITIVE = ("radius", "effective_radius", "vertical_stiffness", "slip_stiffness",
             "cornering_stiffness", "friction", "relaxation_x", "relaxation_y", "lowest_speed",
             "nominal_load")  # fmt: skip

_OF_EQUATIONS = ("effective_radius", "vertical_stiffness", "relaxation_x", "relaxation_y")


@dataclass(frozen=True, kw_only=True)
class LinearSlip(Tyre):
    """A tyre whose forces are linear in slip, up to the friction, which they approach.

    Attributes
    ----------
    radius, effective_radius
        Without load; speed over rate of spin of a wheel that rolls freely [m].
    vertical_stiffness, vertical_damping
        [N/m] and [N s/m].
    slip_stiffness, cornering_stiffness, camber_stiffness
        dFx over longitudinal slip, -dFy over the tangent of the slip angle and over the sine of
        the inclination [N].
    friction
        Greatest horizontal force over the load.
    trail
        How far behind the contact the lateral force is without sliding [m].
    rolling_resistance
        Longitudinal force that rolling takes, over the load.
    relaxation_x, relaxation_y
        Relaxation lengths [m].
    """

    law: ClassVar[str] = "linear"
    radius: float
    effective_radius: float
    vertical_stiffness: float
    slip_stiffness: float
    cornering_stiffness: float
    camber_stiffness: float = 0.0
    friction: float = 1.0
    trail: float = 0.0
    rolling_resistance: float = 0.0
    relaxation_x: float = 0.3
    relaxation_y: float = 0.5
    lowest_speed: float = 1.0
    vertical_damping: float = 0.0
    nominal_load: float = 4000.0
    name: str = "linear"

    def __post_init__(self) -> None:
        with Validator("LinearSlip") as given:
            for key, value in asdict(self).items():
                if key not in {"name", "side"}:
                    above = 0.0 if key in _POSITIVE else -np.inf
                    object.__setattr__(self, key, given.number(key, value, above=above))

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:  # type: ignore[override] # read only
        """None: it is known everywhere."""
        return {}

    def mirrored(self) -> Self:
        """Return the mirror image, which is the tyre itself."""
        return replace(self)

    def contact_law(self, name: str = "tyre") -> "ContactLaw":
        """Return the `kintrafo.generator.LinearContact` of a name."""
        from ...generator import LinearContact  # noqa: PLC0415 (an extra)

        return LinearContact(name=name)

    def parameters(self, name: str = "tyre", *, relaxing: bool = False) -> dict[str, float]:
        """Return the parameters of equations of motion that this tyre has.

        Parameters
        ----------
        name : str, optional
            Of the `kintrafo.generator.LinearContact` whose parameters they are.
        relaxing : bool, optional
            Whether relaxation lengths are needed, which this tyre always has.

        Returns
        -------
        dict of str to float
            By name, such as ``"tyre_friction"``, in SI units.
        """
        del relaxing
        own = asdict(self)
        found = {key: own[key] for key in (*linear_contact.COEFFICIENTS, *_OF_EQUATIONS)}
        found |= {"unloaded_radius": self.radius, "vxlow": self.lowest_speed}
        return {f"{name}_{key}": value for key, value in found.items()}

    def _state(self, at: States) -> dict[str, Any]:
        rolling = np.sign(at.speed)
        contact = Contact(
            load=at.load,
            longitudinal=at.slip,
            lateral=np.tan(at.slip_angle),
            inclination=np.sin(at.camber),
            direction=np.cos(at.slip_angle) * rolling,
            rolling=rolling,
            speed=at.speed,
            pressure=0.0,
        )
        found = linear_contact.forces(ARRAYS, asdict(self), contact, self.radius)
        return {
            "fx": found.fx,
            "fy": found.fy,
            "mx": found.mx,
            "my": found.my,
            "mz": found.mz,
            "slip_stiffness": found.slip_stiffness,
            "cornering_stiffness": -found.cornering_stiffness,
            "trail": found.trail,
            "relaxation_x": self.relaxation_x,
            "relaxation_y": self.relaxation_y,
            "loaded_radius": self.radius - at.load / self.vertical_stiffness,
            "effective_radius": self.effective_radius,
            "vertical_stiffness": self.vertical_stiffness,
        }
