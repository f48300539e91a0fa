"""The parts of a rigid axle at many positions, and what acts on them by itself.

The parts are the beam, both wheels and the rods; names of points and of what there is twice end in
``_left`` and ``_right``, as those of other axles do.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.vectors import cross
from ..corner.corner import UP
from ..models.rigid_axle.axle import RigidAxle
from ..models.rigid_axle.model import RigidAxleModel
from ..models.rigid_axle.structure import BEAM, CHASSIS, MIDDLE
from ..models.sides import SIDES
from .load import Load
from .part_poses import CENTER, CONTACT, road_axes
from .wheel import lowest_point
from .whole_axle_kinematics import SENSE
from .whole_axle_parts import BAR, WholeAxleParts

Array = NDArray[np.float64]

PARAMETERS = {BEAM: "beam", "wheel_left": "left_wheel", "wheel_right": "wheel"}
"""What begins the names of the parameters of parts with mass."""

MASSIVE = {BEAM: "beam", "wheel_left": "left_wheel", "wheel_right": "right_wheel"}
"""What they are called in the equations."""

_LEFTWARD = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class RigidAxleParts(WholeAxleParts):
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

    PARAMETERS = PARAMETERS
    MASSIVE = MASSIVE

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

    @cached_property
    def design(self) -> dict[str, Array]:
        """The points at design, (3,) [m]."""
        begin = self.axle.bodies.beam.centre_of_mass(self.axle.hardpoints)
        at_design = _points(self.axle, np.array([begin]), np.eye(3)[None])
        return {name: point[0] for name, point in at_design.items()}

    def carrier(self, side: str) -> str:
        """Return the beam, which carries both wheels."""
        del side
        return BEAM

    def carried_by(self, part: str, point: str) -> Array:
        """Return where a part has a point, (n, 3) [m].

        A fifth rod is as long as at design, in the middle between where the others leave its ends.
        """
        if part not in self.axle.rods or part in self.axle.guides:
            return self.points[point]
        inner, outer = self.axle.ends()[part]
        arm = self.turned[part] @ (self.design[point] - 0.5 * (inner + outer))
        return self.centers[part] + arm

    def rod(self, name: str) -> Array:
        """Return the unit vector along a rod from the axle to the chassis, (n, 3)."""
        way = self.points[f"{name}_{CHASSIS}"] - self.points[f"{name}_axle"]
        along: Array = way / np.linalg.norm(way, axis=-1, keepdims=True)
        return along

    @property
    def roll(self) -> Array:
        """The inclination of the axle, positive with the left wheel up, (n,) [rad]."""
        return self.states[:, self.model.state_names.index("roll")]

    # -- what acts ------------------------------------------------------------------------------

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
