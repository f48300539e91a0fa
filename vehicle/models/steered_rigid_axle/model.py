"""The equations of motion of a steered rigid axle, and its positions."""

from types import ModuleType
from typing import ClassVar

import numpy as np

from ....core.named_types import Array, ArrayLike
from ....generated import steered_rigid_axle as equations
from ..packaged import equations_named
from ..rigid_axle.axle import BeamAxle
from ..rigid_axle.model import RigidAxleModel
from ..sides import SIDES
from ..whole_axle_model import solved_for_two
from .axle import SteeredRigidAxle

_MOST_STEPS = 20
# Greatest difference of a wheel centre's height at the end of Newton's method, which converges
# quadratically, and the greatest one that rounding leaves [m].
_CLOSE, _ROUNDING = 1e-14, 1e-12


class SteeredRigidAxleModel(RigidAxleModel):
    """The compiled equations of a steered rigid axle: beam, knuckles, wheels, springs and tyres.

    Those with the drag link at the right knuckle are derived and compiled at first use. Arguments
    and states are those of `RigidAxleModel`; the input ``rack_position`` is the displacement of the
    ball of the Pitman arm along its circle [m].

    Examples
    --------
    >>> import kintrafo
    >>> model = kintrafo.model_of(kintrafo.load("steered_rigid_axle"))
    >>> model.state_names[:2], model.input_names[0]
    (('heave', 'roll'), 'rack_position')
    """

    NEEDED = "the equations of a steered rigid axle are needed"
    AXLE: ClassVar[type[BeamAxle]] = SteeredRigidAxle
    EQUATIONS: ClassVar[ModuleType] = equations
    ENDS = (
        "a rod, the drag link or the track rod reaches no farther, a damper is at the end of its "
        "length, or the axle is inclined by 45 deg"
    )

    axle: SteeredRigidAxle

    def _equations(self) -> ModuleType:
        """Return the equations for the side of the drag link."""
        return equations_named(self.axle.equations_name)

    def placed(self, left: Array, right: Array, rack: ArrayLike = 0.0) -> Array:
        """Return the states at rest at wheel travels and displacements of the steering.

        A knuckle that turns about an inclined kingpin moves its wheel centre up or down. Newton's
        method solves for heave and roll of the axle at given heights of both wheel centres; NaN if
        no such position is found.
        """
        left, right, racks = np.broadcast_arrays(left, right, rack)
        wanted = np.stack([left, right], axis=-1).reshape(-1, len(SIDES)) + self.axle.center[2]
        inputs = self.inputs_at(racks.ravel())
        states = super().placed(left, right).reshape(len(wanted), len(self.state_names))
        columns = [self.state_names.index(name) for name in self.COORDINATES]
        missing = np.full(len(wanted), np.inf)
        for _ in range(_MOST_STEPS):
            heights, slopes = self._heights(states, inputs)
            off = wanted - heights
            missing = np.abs(off).max(axis=-1)
            if not (missing > _CLOSE).any():
                break
            with np.errstate(all="ignore"):
                states[:, columns] += solved_for_two(slopes, off)
        states[~(missing < _ROUNDING)] = np.nan
        return states.reshape(*left.shape, len(self.state_names))

    def moved(self, states: Array, left: Array, right: Array, inputs: Array | None = None) -> Array:
        lead = states.shape[:-1]
        rows = self.with_rates(states.reshape(-1, states.shape[-1]), 0.0)
        acting = self.inputs_at(np.zeros(lead)) if inputs is None else inputs
        acting = np.broadcast_to(acting, (*lead, acting.shape[-1])).reshape(
            len(rows), acting.shape[-1]
        )
        _, slopes = self._heights(rows, acting)
        still = self._of_wheels("wheel_velocity", rows, acting)
        wanted = np.stack(np.broadcast_arrays(left, right, np.empty(lead))[:2], axis=-1)
        with np.errstate(all="ignore"):
            rates = solved_for_two(slopes, wanted.reshape(still.shape) - still)
        return self.with_rates(rows, rates).reshape(states.shape)

    def _of_wheels(self, name: str, states: Array, inputs: Array) -> Array:
        """Return a signal of both wheels, (n, 2); NaN where a loop does not close."""
        values = np.full((len(states), len(SIDES)), np.nan)
        fine = np.asarray(np.isfinite(states).all(axis=-1))
        closing = self.evaluate("margins", states[fine], inputs[fine]) > 0.0
        fine[np.flatnonzero(fine)] = closing.all(axis=-1)
        found = self.signals(states[fine], inputs[fine])
        for column, side in zip(values.T, SIDES, strict=True):
            column[fine] = found[f"{side}_axle_{name}"]
        return values

    def _heights(self, states: Array, inputs: Array) -> tuple[Array, Array]:
        """Return the heights of both wheel centres, (n, 2), and their slopes, (n, 2, 2)."""
        still = inputs.copy()
        still[:, self.input_names.index("rack_velocity")] = 0.0
        slopes = [
            self._of_wheels("wheel_velocity", self.with_rates(states, unit), still)
            for unit in np.eye(len(self.COORDINATES))
        ]
        return self._of_wheels("wheel_center_z", states, still), np.stack(slopes, axis=-1)
