"""Laws of force over displacement of bushes, springs and stops."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ....core.named_types import Array
from ...input.curve import Curve
from ...input.spring import force_and_rate


class Law(Protocol):
    """A force over a displacement."""

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return the force that resists the displacement [N], and its derivative [N/m]."""


@dataclass(frozen=True)
class LinearLaw:
    """A force in proportion to the displacement."""

    rate: float  # [N/m]; of an angle [N m/rad]
    carried: float = 0.0  # the force at zero displacement [N], [N m]
    bush: str = ""  # the hardpoint of the bush; empty for a spring or an angle
    start: float = 0.0  # the displacement with both parts at the hardpoint [m]

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return force and rate."""
        return self.carried + self.rate * displacement, np.full_like(displacement, self.rate)


@dataclass(frozen=True)
class CurvedLaw:
    """A force over a displacement by a curve."""

    curve: Curve
    before: float = 0.0  # the displacement along the curve where that of the parts is zero [m]
    bush: str = ""
    start: float = 0.0  # the displacement with both parts at the hardpoint [m]

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return force and rate."""
        whole = displacement + self.before
        return self.curve.force(whole), self.curve.rate(whole)


@dataclass(frozen=True)
class SpringLaw:
    """The force of a spring over its length."""

    # a length of reference [m], and the force that pushes the ends apart there, (n,) [N]
    length: Array
    force: Array
    parameters: Mapping[str, float]

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return the tension at a length, and its derivative."""
        before, _ = force_and_rate(self.parameters, self.length)
        now, of_curve = force_and_rate(self.parameters, displacement)
        rate = self.parameters["spring_rate"]
        return rate * (displacement - self.length) + (before - now) - self.force, rate + of_curve


@dataclass(frozen=True)
class StopLaw:
    """The force of damper and stops at rest, over the distance of the damper's ends."""

    # a distance of reference [m], and the force that pushes the ends apart there, (n,) [N]
    length: Array
    force: Array
    # the stroke at that distance, which decides whether stops are in contact, (n,) [m]
    stroke: Array
    parameters: Mapping[str, float]

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return the tension at a distance, and its derivative."""
        before, _ = self._resisting(self.stroke)
        now, rate = self._resisting(self.stroke + displacement - self.length)
        return now - before - self.force, rate

    def _resisting(self, stroke: Array) -> tuple[Array, Array]:
        """Return the force of both stops against a stroke, and its derivative."""
        force, rate = np.zeros_like(stroke), np.zeros_like(stroke)
        for side, sense in (("bump", -1.0), ("rebound", 1.0)):
            if f"{side}_stop_rate" not in self.parameters:
                continue
            length, first, cubic = (
                self.parameters[f"{side}_stop_{name}"] for name in ("length", "rate", "progression")
            )
            pressed = np.maximum(sense * (stroke - length), 0.0)
            force += sense * (first * pressed + cubic * pressed**3)
            rate += np.where(pressed > 0.0, first + 3.0 * cubic * pressed**2, 0.0)
        return force, rate
