"""The slope of the road under a car that drives."""

from typing import Any, NamedTuple

import numpy as np

from ....core.named_types import Array
from ....core.validator import Validator

STEEPEST = 0.5
"""The steepest slope of a road [1]; more is a mistake, such as a percentage."""


class Slope(NamedTuple):
    """The slope of a plane road.

    The axes of the equations are those of the road: x along it, y to the left, z along its normal.
    """

    grade: float = 0.0  # rise over horizontal distance in the direction of x, positive uphill [1]
    # rise over horizontal distance to the left of it, positive if the road falls to the right [1]
    crossfall: float = 0.0

    @classmethod
    def checked(cls, given: Validator, grade: Any, crossfall: Any) -> "Slope":
        """Return the slope of two arguments, whose problems are added to `given`."""
        values = {"grade": grade, "crossfall": crossfall}
        return cls(
            *(
                given.number(
                    name, value, least=-STEEPEST, below=STEEPEST, advice="It is 0.05 for 5 %."
                )
                for name, value in values.items()
            )
        )

    @property
    def upward(self) -> Array:
        """The unit vector opposite to gravity in the axes of the road, shape (3,)."""
        forward = np.array([1.0, 0.0, self.grade])
        normal = np.array([-self.grade, -self.crossfall, 1.0])
        axes = [
            each / np.linalg.norm(each) for each in (forward, np.cross(normal, forward), normal)
        ]
        return np.array(axes)[:, 2]

    @property
    def words(self) -> str:
        """Its description in titles; empty for a level road."""
        rise = f"{abs(100.0 * self.grade):g} % {'uphill' if self.grade > 0.0 else 'downhill'}"
        fall = f"crossfall {100.0 * self.crossfall:g} %"
        return ", ".join([rise] * bool(self.grade) + [fall] * bool(self.crossfall))


LEVEL = Slope()
