"""A tyre with forces linear in slip and limited by friction."""

from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import numpy as np

from ...core.validator import Validator
from ...formulas import linear_contact
from ...formulas.arithmetic import ARRAYS
from ...formulas.magic_formula import Forces
from .tyre import States, SymmetricTyre

_POSITIVE = ("radius", "effective_radius", "vertical_stiffness", "slip_stiffness",
             "cornering_stiffness", "friction", "relaxation_x", "relaxation_y", "lowest_speed",
             "nominal_load")  # fmt: skip

_OF_EQUATIONS = ("effective_radius", "vertical_stiffness", "relaxation_x", "relaxation_y")


@dataclass(frozen=True, kw_only=True)
class LinearSlip(SymmetricTyre):
    """A tyre with forces that are linear at small slip and approach the limit of friction.

    Attributes
    ----------
    radius, effective_radius
        Unloaded radius, and the speed of a freely rolling wheel divided by its rate of spin [m].
    vertical_stiffness, vertical_damping
        Stiffness [N/m] and damping [N s/m] along the normal of the road.
    slip_stiffness, cornering_stiffness, camber_stiffness
        Derivatives at zero slip: of Fx with respect to the longitudinal slip, and of -Fy with
        respect to the tangent of the slip angle and to the sine of the inclination [N].
    friction
        Greatest horizontal force divided by the load.
    trail
        Pneumatic trail without sliding [m]: positive if the lateral force acts behind the contact.
    rolling_resistance
        Rolling resistance force divided by the load.
    relaxation_x, relaxation_y
        Relaxation lengths [m].
    """

    law: ClassVar[str] = "linear"
    CONTACT_LAW: ClassVar[str] = "LinearContact"
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
        """Empty: the tyre is valid for all states."""
        return {}

    def _values(self) -> dict[str, float]:
        own = asdict(self)
        found = {key: own[key] for key in (*linear_contact.COEFFICIENTS, *_OF_EQUATIONS)}
        return found | {"unloaded_radius": self.radius, "vxlow": self.lowest_speed}

    def _state(self, at: States) -> tuple[Forces, dict[str, Any]]:
        return linear_contact.forces(ARRAYS, asdict(self), at.contact(), self.radius), {
            "relaxation_x": self.relaxation_x,
            "relaxation_y": self.relaxation_y,
            "loaded_radius": self.radius - at.load / self.vertical_stiffness,
            "effective_radius": self.effective_radius,
            "vertical_stiffness": self.vertical_stiffness,
        }
