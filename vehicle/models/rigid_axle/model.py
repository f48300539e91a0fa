"""The equations of motion of a rigid axle, and its positions."""

from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar

import numpy as np

from ....core.errors import InputError
from ....core.named_types import Array, ArrayLike
from ....core.validator import Validator
from ....generated import rigid_axle as equations
from ..whole_axle_model import WholeAxleModel
from .axle import BeamAxle, RigidAxle

HEAVE, ROLL = "heave", "roll"
"""The coordinates: height of the middle between the wheels above design [m], inclination [rad]."""

_OVERHELD = (
    "[rods] {rods}: an axle on five rods heaves and rolls only as its bushes deflect, and here "
    "rods are rigid. `kintrafo compliance`, with and without --nonlinear, computes its motion on "
    "bushes. For all other analyses leave out one of the rods."
)


class RigidAxleModel(WholeAxleModel):
    """The compiled equations of a rigid axle: beam, wheels, springs, dampers, stops and tyres.

    Parameters
    ----------
    axle : RigidAxle, str or Path
        The data, or the name of a packaged data set or path of a TOML file.
    guided : bool, optional
        Whether an axle on five rods, which has no motion with rigid rods, has the equations of four
        of them, from which an equilibrium on bushes begins; otherwise it is refused.
    wheel_loads : bool, optional
        Whether the equations have loads on the wheels as inputs.

    Attributes
    ----------
    axle : RigidAxle
        The data of the file.
    parameters, constants, design_state
        Numbers, constants and state at design of the equations. The states are ``heave`` [m] and
        ``roll`` [rad], positive with the left wheel up, and the angles of the wheels; signals and
        inputs of a side have the prefix ``right_`` or ``left_``.

    Examples
    --------
    >>> from kintrafo import RigidAxleModel
    >>> model = RigidAxleModel("rigid_axle")
    >>> model.state_names[:2]
    ('heave', 'roll')
    """

    NEEDED = 'a kintrafo.RigidAxleModel, such as RigidAxleModel("rigid_axle"), is needed'
    AXLE: ClassVar[type[BeamAxle]] = RigidAxle
    EQUATIONS: ClassVar[ModuleType] = equations
    COORDINATES: ClassVar[tuple[str, str]] = (HEAVE, ROLL)
    ENDS = (
        "a rod reaches no farther, a damper is at the end of its length, or the axle is inclined "
        "by 45 deg"
    )

    axle: BeamAxle

    def __init__(
        self, axle: BeamAxle | str | Path, *, guided: bool = False, wheel_loads: bool = False
    ) -> None:
        with Validator("RigidAxleModel") as given:
            self._guided = given.flag("guided", guided)
        super().__init__(axle, wheel_loads=wheel_loads)

    def __reduce__(self) -> tuple[Any, ...]:
        made = partial(type(self), guided=self.axle.overheld, wheel_loads=self.wheel_loads)
        return made, (self.axle,)

    def _check(self) -> None:
        if self.axle.overheld and not self._guided:
            raise InputError([_OVERHELD.format(rods=", ".join(self.axle.rods))], "RigidAxleModel")

    def placed(self, left: Array, right: Array, rack: ArrayLike = 0.0) -> Array:
        states = np.broadcast_to(self.design_state, (*left.shape, self.design_state.size)).copy()
        states[..., self.state_names.index(HEAVE)] = 0.5 * (left + right)
        with np.errstate(invalid="ignore"):
            rolls = np.arcsin(0.5 * (left - right) / self.axle.half_track)
        states[..., self.state_names.index(ROLL)] = rolls
        return states

    def moved(self, states: Array, left: Array, right: Array, inputs: Array | None = None) -> Array:
        with np.errstate(all="ignore"):  # of an axle that is inclined too far
            leaning = np.cos(states[..., self.state_names.index(ROLL)])
            rolling = 0.5 * (left - right) / self.axle.half_track / leaning
        heaving = np.broadcast_to(0.5 * (left + right), rolling.shape)
        return self.with_rates(states, np.stack([heaving, rolling], axis=-1))

    def turned(self, states: Array) -> Array:
        return np.abs(states[..., self.state_names.index(ROLL)])
