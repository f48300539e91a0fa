"""Inertia of a part as a load on it: Euler's equations in chassis axes."""

from dataclasses import dataclass

import numpy as np

from ....core.named_types import Array
from ....core.vectors import cross
from ....systems.system import System
from ...assembly.load import Load
from ...assembly.part_poses import PartMass

# Accelerations of parts are differences of fourth order of their velocities along the motion, over
# a step in which no state changes by more than this [rad, m, rad/s, m/s]: the error is of its
# fourth power, and rounding is 1e-16 divided by it.
_STEP = 1e-3
_WEIGHTS = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}


@dataclass(frozen=True)
class PartTwists:
    """Velocities and accelerations of the parts of a system in many states."""

    bodies: tuple[str, ...]
    # (n, bodies, 6): angular velocity and velocity of the centre of mass, and their rates
    twists: Array
    rates: Array

    @classmethod
    def of(
        cls, model: System, states: Array, inputs: Array, by_time: Array, inputs_by_time: Array
    ) -> "PartTwists":
        """Return the motion of the parts in states with inputs and with their time derivatives."""
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
        """Return the inertia of a part as a load, with the name of the part among the loads.

        `turned` is its rotation from design, (n, 3, 3), `center` its centre of mass, (n, 3) [m].
        """
        which = self.bodies.index(of.body)
        turning, rate = self.twists[:, which, :3], self.rates[:, which]
        momentum, its_rate = (
            # the tensor is in the axes of the part
            np.einsum("nij,nj->ni", turned, np.einsum("nji,nj->ni", turned, vector) @ of.tensor)
            for vector in (turning, rate[:, :3])
        )
        moment = its_rate + cross(turning, momentum)
        return Load(part, "mass", "inertia", -of.mass * rate[:, 3:], -moment, center)
