"""Where the parts of a suspension are, and what acts on them from outside."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.vectors import cross
from ...suspension.corner import UP
from ...suspension.model import Model
from ...suspension.points import hardpoints
from ..characteristics.from_model import design_axis, vehicle
from ..characteristics.wheel import lowest_point, upward_across

Array = NDArray[np.float64]

CONTACT, CENTER = "contact", "wheel_center"
"""Where loads act on a wheel: at its lowest point, and at its centre."""


@dataclass(frozen=True)
class Poses:
    """A suspension in many positions; arrays have one leading dimension, that of the positions.

    Attributes
    ----------
    model : Model
    states, inputs : ndarray
        As in the compiled module.
    points : dict of str to ndarray
        Hardpoints, and ``contact`` where the wheel's radius is known [m].
    centers, turned : dict of str to ndarray
        Centre of mass [m] and rotation from design of each part.
    axis : ndarray, shape (n, 3)
        Spin axis of the wheel, pointing outboard.
    """

    model: Model
    states: Array
    inputs: Array
    points: dict[str, Array]
    centers: dict[str, Array]
    turned: dict[str, Array]
    axis: Array

    @classmethod
    def of(cls, model: Model, states: Array, inputs: Array) -> "Poses":
        """Return the positions of some states."""
        bodies = model.equations.BODIES
        centers = model.evaluate("positions", states, inputs)
        rotations = model.evaluate("orientations", states, inputs)
        turned = {name: rotations[..., i, :, :] for i, name in enumerate(bodies)}
        axis = turned[model.suspension.carrier] @ design_axis(model.suspension)
        points = hardpoints(model, states, inputs)
        radius = vehicle(model.suspension).tyre_radius
        if radius is not None:
            points[CONTACT] = lowest_point(points[CENTER], axis, radius)
        return cls(
            model=model,
            states=states,
            inputs=inputs,
            points=points,
            centers={name: centers[..., i, :] for i, name in enumerate(bodies)},
            turned=turned,
            axis=axis,
        )

    @property
    def design(self) -> dict[str, Array]:
        """The hardpoints at design [m]."""
        return self.model.suspension.hardpoints.at_design()

    def weights(self) -> dict[str, Array]:
        """Return the weight of each part, (3,) [N]."""
        model = self.model
        masses = {name: model.parameters[f"{name}_mass"] for name in model.equations.BODIES}
        return {name: -mass * model.parameters["gravity"] * UP for name, mass in masses.items()}

    def forces_along_lines(self) -> dict[str, Array]:
        """Return the force of each line of the structure, positive when it pushes, (n,) [N]."""
        values = self.model.signals(self.states, self.inputs)
        values |= dict(zip(self.model.input_names, np.moveaxis(self.inputs, -1, 0), strict=True))
        nothing = np.zeros(self.states.shape[:-1])
        return {
            line.name: sum((values[name] for name in line.signals if name in values), nothing)
            for line in self.model.suspension.structure().lines
        }

    def push_of_tyre(self) -> Array:
        """Return the force of the tyre, in the plane of the wheel, (n, 3) [N]."""
        force = self.model.signal("tyre_force", self.states, self.inputs)
        push: Array = force[:, None] * upward_across(self.axis)
        return push

    def wheel_axes(self) -> Array:
        """Return the axes of the wheel on the road as rows, (n, 3, 3): forward, left, up.

        Forward is horizontal in the plane of the wheel, as in the tyre axes of ISO 8855.
        """
        return road_axes(self.model.suspension.vehicle.sign * self.axis)


def road_axes(left: Array) -> Array:
    """Return the axes of wheels on the road, see `Poses.wheel_axes`.

    Parameters
    ----------
    left : ndarray, shape (n, 3)
        Spin axes that point left.
    """
    forward = cross(left, UP)
    forward /= np.linalg.norm(forward, axis=-1, keepdims=True)
    return np.stack([forward, cross(UP, forward), np.broadcast_to(UP, forward.shape)], -2)


def rotated(matrix: Array, rotation: Array) -> Array:
    """Return a matrix of forces and moments, (..., 6, 6), in axes that are turned."""
    both = np.zeros((*rotation.shape[:-2], 6, 6))
    both[..., :3, :3] = both[..., 3:, 3:] = rotation
    result: Array = both @ matrix @ both.mT
    return result


def wrench_about(point: Array, at: Array, force: Array, moment: Array | float = 0.0) -> Array:
    """Return force and moment about a point, (..., 6), of a force and a moment elsewhere."""
    return np.concatenate(np.broadcast_arrays(force, moment + cross(at - point, force)), axis=-1)
