"""What the acceleration of a part takes, as a load on it: Euler's equations in chassis axes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.vectors import cross
from ....systems.system import System
from ...assembly.load import Load
from ...assembly.mass import PartMass

Array = NDArray[np.float64]

# Accelerations of parts are the derivative of their velocities along the motion, by a difference of
# fourth order over a step in which no state changes by more than this [rad, m, rad/s, m/s]: its
# error is of the fourth power of that, and rounding 1e-16 over it.
_STEP = 1e-3
_WEIGHTS = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}


@dataclass(frozen=True)
class PartTwists:
    """How the parts of a system move in many states.

    Attributes
    ----------
    bodies : tuple of str
    twists, rates : ndarray, shape (n, bodies, 6)
        Angular velocity and velocity of the centre of mass of each, and their derivatives by time.
    """

    bodies: tuple[str, ...]
    twists: Array
    rates: Array

    @classmethod
    def of(
        cls, model: System, states: Array, inputs: Array, by_time: Array, inputs_by_time: Array
    ) -> "PartTwists":
        """Return them along a motion.

        Parameters
        ----------
        model : System
        states, inputs : ndarray
            As in the compiled module.
        by_time, inputs_by_time : ndarray
            Their rates.
        """
        fastest = np.maximum(
            np.abs(by_time).max(axis=1), np.abs(inputs_by_time).max(axis=1, initial=0.0)
        )
        step = _STEP / np.maximum(fastest, 1.0)[:, None]
        twists = model.evaluate("velocities", states, inputs)
        total = np.zeros_like(twists)
        for by, weight in _WEIGHTS.items():
            moved = (states + by * step * by_time, inputs + by * step * inputs_by_time)
            total += weight * model.evaluate("velocities", *moved)
        return cls(tuple(model.equations.BODIES), twists, total / step[:, :, None])

    def load(self, part: str, of: PartMass, turned: Array, center: Array) -> Load:
        """Return what the acceleration of a part takes.

        Parameters
        ----------
        part : str
            What it is called among the loads.
        of : PartMass
            What is accelerated.
        turned : ndarray, shape (n, 3, 3)
            Its rotation from design.
        center : ndarray, shape (n, 3)
            Its centre of mass [m].
        """
        which = self.bodies.index(of.body)
        turning, rate = self.twists[:, which, :3], self.rates[:, which]
        momentum, its_rate = (
            # there and back: the tensor belongs to the axes of the part
            np.einsum("nij,nj->ni", turned, np.einsum("nji,nj->ni", turned, vector) @ of.tensor)
            for vector in (turning, rate[:, :3])
        )
        moment = its_rate + cross(turning, momentum)
        return Load(part, "mass", "inertia", -of.mass * rate[:, 3:], -moment, center)
