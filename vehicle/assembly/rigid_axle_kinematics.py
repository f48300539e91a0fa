"""Kinematics of a rigid axle over n positions: the derivatives of its relative coordinates.

The two motions are those of the coordinates: heave, the middle of the axle rising by a metre at
constant inclination; and roll, the wheels moving oppositely, by a radian with the left wheel up.
"""

from dataclasses import dataclass
from functools import cached_property

from ...core.named_types import Array
from .whole_axle_kinematics import WholeAxleKinematics


@dataclass(frozen=True)
class RigidAxleKinematics(WholeAxleKinematics):
    """A rigid axle at rest in many positions, of shape (n,)."""

    @cached_property
    def _relative(self) -> dict[str, Array]:
        values = self.model.evaluate("relative_coordinates", self.parts.states, self.parts.inputs)
        return {n: values[:, i] for i, n in enumerate(self.model.equations.RELATIVE_COORDINATES)}

    @cached_property
    def _slopes(self) -> dict[str, Array]:
        """Derivatives of the relative coordinates with respect to heave and roll, (n, 2) each."""
        by = self.model.evaluate("relative_jacobian", self.parts.states, self.parts.inputs)[..., :2]
        return {n: by[:, i] for i, n in enumerate(self.model.equations.RELATIVE_COORDINATES)}

    def coordinate(self, name: str) -> Array:
        """Return heave, sway (left), shift (forward) [m], roll, yaw (left) or pitch [rad]."""
        return self._relative[name]

    def slope(self, name: str, by: str) -> Array:
        """Return the derivative of such a coordinate with respect to heave or roll."""
        return self._slopes[name][:, self.model.COORDINATES.index(by)]
