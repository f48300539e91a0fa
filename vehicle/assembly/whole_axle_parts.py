"""The parts of an axle without sides in n positions, and the forces that need no input.

Names of points and parts of which there are two end in ``_left`` and ``_right``, as in other axles.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.vectors import cross
from ...systems.allowed import LengthLimit
from ..corner.corner import UP, RoadWheel
from ..corner.structure import LineForce, Structure
from ..corner.wheel_loads import UNITS
from ..models.sides import SENSE, SIDES
from ..models.whole_axle import of_side
from ..models.whole_axle_model import WholeAxleModel
from .corner_kinematics import vehicle
from .load import Load, known
from .part_poses import CENTER, CONTACT, PartMass, PartPoses
from .wheel import lowest_point, upward_across

BAR = "bar"


@dataclass(frozen=True)
class WholeAxleParts(PartPoses):
    """The parts of an axle without sides in n positions."""

    model: WholeAxleModel

    PARAMETERS: ClassVar[Mapping[str, str]]  # prefix of the names of parameters, by part with mass
    MASSIVE: ClassVar[Mapping[str, str]]  # names of these parts in the equations
    # parameter with the rate of the bar or beam, per unit of the second coordinate
    RATE: ClassVar[str]

    @classmethod
    def of(cls, model: Any, states: Array, inputs: Array | None = None) -> Self:
        """Return the parts in some states, by default with zero inputs."""
        if inputs is None:
            inputs = np.zeros((len(states), len(model.input_names)))
        bodies = cls.bodies(model.axle)
        rows = [model.equations.BODIES.index(body) for body in bodies.values()]
        places = np.moveaxis(model.evaluate("positions", states, inputs)[:, rows], 1, 0)
        turns = np.moveaxis(model.evaluate("orientations", states, inputs)[:, rows], 1, 0)
        centers, turned = (dict(zip(bodies, found, strict=True)) for found in (places, turns))
        points = cls.placed(model.axle, centers, turned)
        return cls(model, states, inputs, points, centers, turned)

    @classmethod
    def bodies(cls, axle: Any) -> Mapping[str, str]:
        """Return the names in the equations of their parts, by part."""
        return cls.MASSIVE

    @classmethod
    @abstractmethod
    def placed(
        cls, axle: Any, centers: Mapping[str, Array], turned: Mapping[str, Array]
    ) -> dict[str, Array]:
        """Return all points for positions and rotations of the parts, (n, 3) [m].

        These are centres of mass, (n, 3) [m], and rotations from design, (n, 3, 3), by part.
        """

    @staticmethod
    def contacts(
        axle: Any, centers: Mapping[str, Array], turned: Mapping[str, Array]
    ) -> dict[str, Array]:
        """Return the lowest points of both wheels, if their radius is known, (n, 3) [m].

        `centers` are wheel centres [m], `turned` rotations of the carriers from design, by side.
        """
        radius = axle.tyre_radius()
        if radius is None:
            return {}
        axes = {side: turned[side] @ axle.wheel.spin_axis(SENSE[side]) for side in SIDES}
        return {
            f"{CONTACT}_{side}": lowest_point(centers[side], axes[side], radius) for side in SIDES
        }

    @property
    def axle(self) -> Any:
        """The axle."""
        return self.model.axle

    @property
    def steering_gear(self) -> Any:
        return self.axle.steering_gear

    @property
    def structure(self) -> Structure:
        return self.axle.structure()

    @cached_property
    def design(self) -> dict[str, Array]:
        centers = {part: center[None] for part, center in self.design_centers(self.axle).items()}
        turned = dict.fromkeys(centers, np.eye(3)[None])
        return {name: at[0] for name, at in self.placed(self.axle, centers, turned).items()}

    @classmethod
    @abstractmethod
    def design_centers(cls, axle: Any) -> dict[str, Array]:
        """Return the centres of mass of the carriers of the wheels at design, (3,) [m]."""

    @abstractmethod
    def carrier(self, side: str) -> str:
        """Return the part that carries a wheel."""

    @cached_property
    def wheels(self) -> dict[str, RoadWheel]:
        return {
            f"wheel_{side}": RoadWheel(
                vehicle(self.axle, SENSE[side], self.axle.end),
                self.points[f"{CENTER}_{side}"],
                self.design[f"{CENTER}_{side}"],
                SENSE[side] * self.wheel_axis(side),
                SENSE[side] * self.axle.wheel.spin_axis(SENSE[side]),
            )
            for side in SIDES
        }

    def parameters_of(self, line: LineForce) -> Mapping[str, float]:
        return of_side(self.model.parameters, line.name.rpartition("_")[2])

    def counted_by(self, line: LineForce) -> str:
        name, _, side = line.name.rpartition("_")
        return f"{side}_{name}_length"

    def allowed_lengths(self) -> Sequence[LengthLimit]:
        return self.model.allowed_lengths()

    def wheel_axis(self, side: str) -> Array:
        """Return the spin axis of a wheel, which points left, (n, 3)."""
        return self.turned[self.carrier(side)] @ self.axle.wheel.spin_axis(SENSE[side])

    def twists(self) -> dict[str, Array]:
        """Return the velocities of the parts for a unit rate of each coordinate, (n, 2, 6)."""
        found = []
        for coordinate in self.model.COORDINATES:
            states = self.states.copy()
            states[:, self.model.state_names.index(f"{coordinate}_rate")] = 1.0
            found.append(self.model.evaluate("velocities", states, self.inputs))
        return self._by_part(np.stack(found, axis=-2))

    def velocity_at(self, part: str, place: Array, twist: Array) -> Array:
        """Return the velocity of a point of a part, (n, 3).

        `place` is the position of the point, (n, 3) [m]; `twist` is the angular velocity of the
        part and the velocity of its centre of mass, (n, 6).
        """
        return twist[:, 3:] + cross(twist[:, :3], place - self.centers[part])

    def _by_part(self, velocities: Array) -> dict[str, Array]:
        """Return velocities of all bodies, (n, bodies, ...), by the parts with a mass."""
        bodies = self.model.equations.BODIES
        return {part: velocities[:, bodies.index(body)] for part, body in self.MASSIVE.items()}

    def masses(self) -> dict[str, PartMass]:
        axes = {f"wheel_{side}": self.axle.wheel.spin_axis(SENSE[side]) for side in SIDES}
        return {
            part: PartMass.of(self.model.parameters, self.PARAMETERS[part], body, axes.get(part))
            for part, body in self.MASSIVE.items()
        }

    def tyre_forces(self) -> dict[str, Array]:
        forces = {
            side: self.model.signal(f"{side}_axle_tyre_force", self.states, self.inputs)
            for side in SIDES
        }
        return {
            f"wheel_{side}": force[:, None] * upward_across(self.wheel_axis(side))
            for side, force in forces.items()
        }

    def inputs_of_wheels(self) -> dict[str, dict[str, Array]]:
        if not self.model.wheel_loads:
            return {}
        given = dict(zip(self.model.input_names, self.inputs.T, strict=True))
        return {
            f"wheel_{side}": {name: given[f"{side}_{name}"] for name in UNITS} for side in SIDES
        }

    def upright(self) -> NDArray[np.bool_]:
        """Return whether springs and dampers have turned by less than 90 deg from design, (n,)."""
        fine = np.ones(len(self.states), dtype=bool)
        for side in SIDES:
            design = self.axle.points(side)
            for name in ("spring", "damper"):
                way = self.points[f"{name}_top_{side}"] - self.points[f"{name}_seat_{side}"]
                fine &= way @ (design[f"{name}_top"] - design[f"{name}_seat"]) > 0.0
        return fine

    # -- its loads ------------------------------------------------------------------------------

    @property
    @abstractmethod
    def twist(self) -> Array:
        """The twist of the bar or beam, positive with the left wheel up, (n,) [rad]."""

    @property
    @abstractmethod
    def rate_of_twist(self) -> float:
        """The torque of the bar or beam per twist [N m/rad]; zero without one."""

    @property
    def torque(self) -> Array:
        """The torque of the bar or beam, positive as the twist, (n,) [N m]."""
        return self.rate_of_twist * self.twist

    @abstractmethod
    def by_torque(self) -> list[Load]:
        """Return the loads of a unit torque of the bar or beam, against its twist."""

    def acting(self) -> list[Load]:
        """Return the forces that need no input: weights, springs, dampers, stops, the bar."""
        of_bar = self.by_torque() if self.rate_of_twist else []
        torque = self.torque[:, None]
        return [*known(self), *(replace(one, moment=torque * one.moment) for one in of_bar)]

    def weights(self) -> dict[str, Array]:
        values = self.model.parameters
        masses = {part: values[f"{self.PARAMETERS[part]}_mass"] for part in self.MASSIVE}
        return {part: -mass * values["gravity"] * UP for part, mass in masses.items()}
