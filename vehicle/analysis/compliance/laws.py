"""Forces over displacements: of bushes, of springs, of stops."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...input.curve import Curve
from ...input.spring_table import force_and_rate

Array = NDArray[np.float64]


class Law(Protocol):
    """A force over a displacement."""

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return the force that resists it, and its derivative."""


@dataclass(frozen=True)
class LinearLaw:
    """A force in proportion to the displacement.

    Attributes
    ----------
    rate : float
        [N/m]; of an angle [N m/rad].
    carried : float
        What it carries where the displacement is zero [N], [N m].
    bush : str
        The hardpoint of the bush that is displaced; empty for a spring, or an angle.
    start : float
        The displacement where its parts are at the hardpoint [m].
    """

    rate: float
    carried: float = 0.0
    bush: str = ""
    start: float = 0.0

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return force and rate."""
        force = self.carried + self.rate * displacement
        return force, np.full_like(displacement, self.rate)


@dataclass(frozen=True)
class CurvedLaw:
    """A force over a displacement by a curve.

    Attributes
    ----------
    curve : Curve
    before : float
        The displacement that the bush has where this one is zero [m].
    bush : str
        Its hardpoint.
    start : float
        The displacement where its parts are there [m].
    """

    curve: Curve
    before: float = 0.0
    bush: str = ""
    start: float = 0.0

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return force and rate."""
        whole = displacement + self.before
        return self.curve.force(whole), self.curve.rate(whole)


@dataclass(frozen=True)
class SpringLaw:
    """The force of a spring over its length.

    Attributes
    ----------
    length, force : ndarray, shape (n,)
        A length, and the force that pushes its ends apart there [m], [N].
    parameters : mapping
        Of the equations.
    """

    length: Array
    force: Array
    parameters: Mapping[str, float]

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return what resists a greater length."""
        before, _ = force_and_rate(self.parameters, self.length)
        now, of_curve = force_and_rate(self.parameters, displacement)
        rate = self.parameters["spring_rate"]
        force = rate * (displacement - self.length) + (before - now) - self.force
        return force, rate + of_curve


@dataclass(frozen=True)
class StopLaw:
    """What damper and stops do over the distance of the damper's ends, at rest.

    Attributes
    ----------
    length, force : ndarray, shape (n,)
        A distance, and the force that pushes the ends apart there [m], [N].
    stroke : ndarray, shape (n,)
        By which the stops count, there [m].
    parameters : mapping
        Of the equations.
    """

    length: Array
    force: Array
    stroke: Array
    parameters: Mapping[str, float]

    def __call__(self, displacement: Array) -> tuple[Array, Array]:
        """Return what resists a greater length."""
        before, _ = self._resisting(self.stroke)
        now, rate = self._resisting(self.stroke + displacement - self.length)
        return now - before - self.force, rate

    def _resisting(self, stroke: Array) -> tuple[Array, Array]:
        """Return what both stops resist a greater stroke with."""
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
