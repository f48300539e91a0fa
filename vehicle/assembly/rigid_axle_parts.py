"""The parts of a rigid axle at many positions, and what acts on them by itself.

The parts are the beam, both wheels and the rods; names of points and of what there is twice end in
``_left`` and ``_right``, as those of other axles do.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.vectors import cross
from ...systems.allowed import LengthLimit
from ..corner.corner import UP, RoadWheel
from ..corner.structure import ForceElement, Structure
from ..corner.wheel_loads import UNITS
from ..models.rigid.axle import RigidAxle
from ..models.rigid.model import RigidAxleModel
from ..models.rigid.structure import BEAM, CHASSIS, MIDDLE
from ..models.sides import SIDES
from .load import Load, known
from .mass import PartMass
from .part_poses import CENTER, CONTACT, forces_along, road_axes
from .rigid_axle_kinematics import COORDINATES, SENSE, parameters_of, vehicle_of
from .wheel import lowest_point, upward_across

Array = NDArray[np.float64]

BAR = "bar"

PARAMETERS = {BEAM: "beam", "wheel_left": "left_wheel", "wheel_right": "wheel"}
"""What begins the names of the parameters of parts with mass."""

MASSIVE = {BEAM: "beam", "wheel_left": "left_wheel", "wheel_right": "right_wheel"}
"""What they are called in the equations."""

_LEFTWARD = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class RigidAxleParts:
    """A rigid axle in n positions.

    Attributes
    ----------
    model : RigidAxleModel
    states, inputs : ndarray
        As in the compiled module.
    centers, turned : dict of str to ndarray
        Of each part a point, (n, 3) [m]: the centre of mass, of rods their middle; and the rotation
        from design, (n, 3, 3).
    points : dict of str to ndarray
        By name, (n, 3) [m].
    """

    model: RigidAxleModel
    states: Array
    inputs: Array
    centers: dict[str, Array]
    turned: dict[str, Array]
    points: dict[str, Array]

    @classmethod
    def of(
        cls, model: RigidAxleModel, states: Array, inputs: Array | None = None
    ) -> "RigidAxleParts":
        """Return the parts in some states, by default without any input."""
        if inputs is None:
            inputs = np.zeros((len(states), len(model.input_names)))
        bodies = {name: f"rod_{i}" for i, name in enumerate(model.axle.guides, 1)} | MASSIVE
        rows = [model.equations.BODIES.index(body) for body in bodies.values()]
        places = np.moveaxis(model.evaluate("positions", states, inputs)[:, rows], 1, 0)
        turns = np.moveaxis(model.evaluate("orientations", states, inputs)[:, rows], 1, 0)
        centers, turned = (dict(zip(bodies, found, strict=True)) for found in (places, turns))
        points = _points(model.axle, centers[BEAM], turned[BEAM])
        # rods have no mass, and so none of their own
        for name, (inner, outer) in model.axle.ends().items():
            if name not in turned:
                way = points[f"{name}_axle"] - points[f"{name}_{CHASSIS}"]
                turned[name] = _upright_frames(way) @ _upright_frames(outer - inner).T
            centers[name] = 0.5 * (points[f"{name}_{CHASSIS}"] + points[f"{name}_axle"])
        return cls(model, states, inputs, centers, turned, points)

    @property
    def axle(self) -> RigidAxle:
        """The axle."""
        return self.model.axle

    @property
    def structure(self) -> Structure:
        """What holds the parts together."""
        return self.axle.structure()

    @cached_property
    def design(self) -> dict[str, Array]:
        """The points at design, (3,) [m]."""
        begin = self.axle.bodies.beam.centre_of_mass(self.axle.hardpoints)
        at_design = _points(self.axle, np.array([begin]), np.eye(3)[None])
        return {name: point[0] for name, point in at_design.items()}

    @cached_property
    def wheels(self) -> dict[str, RoadWheel]:
        """Both wheels, the left one first, by their parts."""
        return {
            f"wheel_{side}": RoadWheel(
                vehicle_of(self.axle, side),
                self.points[f"{CENTER}_{side}"],
                self.design[f"{CENTER}_{side}"],
                SENSE[side] * self.wheel_axis(side),
                SENSE[side] * self.axle.wheel.spin_axis(SENSE[side]),
            )
            for side in SIDES
        }

    @property
    def rack_axis(self) -> Array | None:
        """No rack steers it."""
        return None

    def parameters_of(self, line: ForceElement) -> Mapping[str, float]:
        """Return the parameters of the spring or the stops on a line, as the right side's are."""
        return parameters_of(self.model, line.name.rpartition("_")[2])

    def signals(self) -> dict[str, Array]:
        """Return the signals of the equations, (n,)."""
        return self.model.signals(self.states, self.inputs)

    def counted_by(self, line: ForceElement) -> str:
        """Return the signal by which the stops beside a damper count: its length."""
        name, _, side = line.name.rpartition("_")
        return f"{side}_{name}_length"

    def carried_by(self, part: str, point: str) -> Array:
        """Return where a part has a point, (n, 3) [m].

        A fifth rod is as long as at design, in the middle between where the others leave its ends.
        """
        if part not in self.axle.rods or part in self.axle.guides:
            return self.points[point]
        inner, outer = self.axle.ends()[part]
        arm = self.turned[part] @ (self.design[point] - 0.5 * (inner + outer))
        return self.centers[part] + arm

    def allowed_lengths(self) -> Sequence[LengthLimit]:
        """Return the lengths of the dampers that the file allows."""
        return self.model.allowed_lengths()

    def mass(self, part: str) -> float:
        """Return the mass of a part [kg]."""
        return self.model.parameters[f"{PARAMETERS[part]}_mass"]

    def wheel_axis(self, side: str) -> Array:
        """Return the spin axis of a wheel, which points left, (n, 3)."""
        axis: Array = self.turned[BEAM] @ self.axle.wheel.spin_axis(SENSE[side])
        return axis

    def rod(self, name: str) -> Array:
        """Return the unit vector along a rod from the axle to the chassis, (n, 3)."""
        way = self.points[f"{name}_{CHASSIS}"] - self.points[f"{name}_axle"]
        along: Array = way / np.linalg.norm(way, axis=-1, keepdims=True)
        return along

    def twists(self) -> dict[str, Array]:
        """Return how beam and wheels move for a unit rate of heave, and of roll, (n, 2, 6)."""
        found = []
        for coordinate in COORDINATES:
            states = self.states.copy()
            states[:, self.model.state_names.index(f"{coordinate}_rate")] = 1.0
            found.append(self.model.evaluate("velocities", states, self.inputs))
        both = np.stack(found, axis=-2)
        bodies = self.model.equations.BODIES
        return {part: both[:, bodies.index(body)] for part, body in MASSIVE.items()}

    def masses(self) -> dict[str, PartMass]:
        """Return what the acceleration of beam and wheels moves."""
        axes = {f"wheel_{side}": self.axle.wheel.spin_axis(SENSE[side]) for side in SIDES}
        return {
            part: PartMass.of(self.model.parameters, PARAMETERS[part], body, axes.get(part))
            for part, body in MASSIVE.items()
        }

    def rates_of_inputs(self) -> Array:
        """Return zeros: nothing but the states moves the parts."""
        return np.zeros_like(self.inputs)

    def tyre_forces(self) -> dict[str, Array]:
        """Return the forces of the tyres, in the planes of their wheels, (n, 3) [N]."""
        forces = {
            side: self.model.signal(f"{side}_axle_tyre_force", self.states, self.inputs)
            for side in SIDES
        }
        return {
            f"wheel_{side}": force[:, None] * upward_across(self.wheel_axis(side))
            for side, force in forces.items()
        }

    def inputs_of_wheels(self) -> dict[str, dict[str, Array]]:
        """Return the inputs on both wheels; empty where the equations have none."""
        if not self.model.wheel_loads:
            return {}
        given = dict(zip(self.model.input_names, self.inputs.T, strict=True))
        return {
            f"wheel_{side}": {name: given[f"{side}_{name}"] for name in UNITS} for side in SIDES
        }

    def upright(self) -> NDArray[np.bool_]:
        """Return where springs and dampers have turned by less than a right angle from design."""
        fine = np.ones(len(self.states), dtype=bool)
        for side in SIDES:
            design = self.axle.points(side)
            for name in ("spring", "damper"):
                way = self.points[f"{name}_top_{side}"] - self.points[f"{name}_seat_{side}"]
                fine &= way @ (design[f"{name}_top"] - design[f"{name}_seat"]) > 0.0
        return fine

    @property
    def roll(self) -> Array:
        """The inclination of the axle, positive with the left wheel up, (n,) [rad]."""
        return self.states[:, self.model.state_names.index("roll")]

    # -- what acts ------------------------------------------------------------------------------

    def acting(self) -> list[Load]:
        """Return what acts without anybody's doing: weights, springs, dampers, stops, the bar."""
        return [*known(self), *self._of_bar()]

    def weights(self) -> dict[str, Array]:
        """Return the weight of each part that has a mass, (3,) [N]."""
        gravity = self.model.parameters["gravity"]
        return {part: -self.mass(part) * gravity * UP for part in MASSIVE}

    def forces_along_lines(self) -> dict[str, Array]:
        """Return the force of each spring and damper, positive when it pushes, (n,) [N]."""
        return forces_along(self.structure, self.model, self.states, self.inputs)

    def bar_by_torque(self) -> Load:
        """Return what a unit torque of the anti-roll bar does on the axle: against its roll."""
        # the line through the wheels points left, and what is forward of it is level
        forward = road_axes(self.turned[BEAM][:, :, 1])[:, 0]
        return Load(BEAM, MIDDLE, BAR, np.zeros(3), -forward, self.points[MIDDLE])

    def _of_bar(self) -> list[Load]:
        """Return the couple of the anti-roll bar, about the axle's axis forward."""
        if self.axle.anti_roll_bar is None:
            return []
        unit = self.bar_by_torque()
        torque = (self.model.parameters["bar_rate"] * self.roll)[:, None]
        return [
            replace(unit, part=part, moment=sign * torque * unit.moment)
            for part, sign in ((BEAM, 1.0), (CHASSIS, -1.0))
        ]


def _upright_frames(way: Array) -> Array:
    """Return the axes of rods as columns, (..., 3, 3): along, level across it, and across both.

    A cross whose first axis is upright turns a rod so that its second axis stays level.
    """
    along = way / np.linalg.norm(way, axis=-1, keepdims=True)
    level = cross(along, np.broadcast_to(UP, along.shape))
    level /= np.linalg.norm(level, axis=-1, keepdims=True)
    return np.stack([along, level, cross(along, level)], axis=-1)


def _points(axle: RigidAxle, center: Array, turned: Array) -> dict[str, Array]:
    """Return all points where the centre of mass of the beam is at some place, and how it turned.

    Parameters
    ----------
    axle : RigidAxle
    center : ndarray, shape (n, 3)
    turned : ndarray, shape (n, 3, 3)
    """
    still, moved = {}, {MIDDLE: axle.center}
    for name, (inner, outer) in axle.ends().items():
        still[f"{name}_{CHASSIS}"], moved[f"{name}_axle"] = inner, outer
    for side in SIDES:
        for name, point in axle.points(side).items():
            (still if name.endswith("_top") else moved)[f"{name}_{side}"] = point
        moved[f"{CENTER}_{side}"] = axle.center + SENSE[side] * axle.half_track * _LEFTWARD
    begin = axle.bodies.beam.centre_of_mass(axle.hardpoints)
    points = {name: np.broadcast_to(point, center.shape) for name, point in still.items()}
    points |= {name: center + turned @ (point - begin) for name, point in moved.items()}
    radius = axle.tyre_radius()
    if radius is not None:
        for side in SIDES:
            axis = turned @ axle.wheel.spin_axis(SENSE[side])
            points[f"{CONTACT}_{side}"] = lowest_point(points[f"{CENTER}_{side}"], axis, radius)
    return points
