"""Where the parts of a suspension are, and what acts on them from outside."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.vectors import cross, unit_vector
from ...systems.allowed import LengthLimit
from ...systems.inputs import rates_of
from ...systems.system import System
from ..corner.corner import UP, RoadWheel
from ..corner.structure import LineForce, Structure
from ..models.model import Model
from ..models.points import hardpoints
from .corner_kinematics import design_axis, vehicle_of
from .mass import PartMass
from .wheel import lowest_point, upward_across

Array = NDArray[np.float64]

CONTACT, CENTER = "contact", "wheel_center"
"""Where loads act on a wheel: at its lowest point, and at its centre."""


class PartPoses(Protocol):
    """The parts of a suspension, or of a rigid axle, in n positions, and what acts by itself.

    Attributes
    ----------
    model : Any
        Its equations.
    states, inputs : ndarray
        As in the compiled module.
    points : mapping of str to ndarray
        Hardpoints, (n, 3) [m].
    centers, turned : mapping of str to ndarray
        Of each part a point that it carries, its centre of mass if it has one, (n, 3) [m]; and its
        rotation from design, (n, 3, 3).
    structure : Structure
        What holds the parts together.
    design : mapping of str to ndarray
        The hardpoints at design, (3,) [m].
    wheels : mapping of str to RoadWheel
        By the part that each is.
    rack_axis : ndarray or None
        Along which a rack slides.
    """

    @property
    def model(self) -> Any: ...  # noqa: D102 (attributes stand above)
    @property
    def states(self) -> Array: ...  # noqa: D102
    @property
    def inputs(self) -> Array: ...  # noqa: D102
    @property
    def points(self) -> Mapping[str, Array]: ...  # noqa: D102
    @property
    def centers(self) -> Mapping[str, Array]: ...  # noqa: D102
    @property
    def turned(self) -> Mapping[str, Array]: ...  # noqa: D102
    @property
    def structure(self) -> Structure: ...  # noqa: D102
    @property
    def design(self) -> Mapping[str, Array]: ...  # noqa: D102
    @property
    def wheels(self) -> Mapping[str, RoadWheel]: ...  # noqa: D102
    @property
    def rack_axis(self) -> Array | None: ...  # noqa: D102

    def weights(self) -> Mapping[str, Array]:
        """Return the weight of each part that has one, (3,) [N]."""

    def forces_along_lines(self) -> Mapping[str, Array]:
        """Return the force of each line of the structure, positive when it pushes, (n,) [N]."""

    def signals(self) -> Mapping[str, Array]:
        """Return the signals of the equations, (n,)."""

    def parameters_of(self, line: LineForce) -> Mapping[str, float]:
        """Return the parameters of the spring or the stops on a line, as one wheel has them."""

    def counted_by(self, line: LineForce) -> str:
        """Return the signal by which the stops on a line count: a length."""

    def carried_by(self, part: str, point: str) -> Array:
        """Return where a part has a hardpoint, apart from others that it is joined to, (n, 3)."""

    def allowed_lengths(self) -> Sequence[LengthLimit]:
        """Return the lengths that the file allows, of these signals."""

    def twists(self) -> Mapping[str, Array]:
        """Return how each part moves, at rest, for a unit rate of each coordinate by itself.

        Returns
        -------
        dict of str to ndarray, shape (n, coordinates, 6)
            Angular velocity, and velocity of `centers`, with the brakes closed and the rack held.
        """

    def masses(self) -> Mapping[str, PartMass]:
        """Return what the acceleration of each part with a mass moves."""

    def rates_of_inputs(self) -> Array:
        """Return the rates of the inputs that move parts, of the shape of `inputs`."""

    def tyre_forces(self) -> Mapping[str, Array]:
        """Return the force of the tyre on each wheel, in the plane of the wheel, (n, 3) [N]."""

    def inputs_of_wheels(self) -> Mapping[str, Mapping[str, Array]]:
        """Return the inputs of `kintrafo.vehicle.corner.wheel_loads` on each wheel, (n,).

        Empty, where the equations have none.
        """


@dataclass(frozen=True)
class CornerParts:
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
    def of(cls, model: Model, states: Array, inputs: Array) -> "CornerParts":
        """Return the positions of some states."""
        bodies = model.equations.BODIES
        centers = model.evaluate("positions", states, inputs)
        rotations = model.evaluate("orientations", states, inputs)
        turned = {name: rotations[..., i, :, :] for i, name in enumerate(bodies)}
        axis = turned[model.suspension.carrier] @ design_axis(model.suspension)
        points = hardpoints(model, states, inputs, poses=(centers, rotations))
        radius = vehicle_of(model.suspension).tyre_radius
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

    @property
    def structure(self) -> Structure:
        """What holds the parts together."""
        return self.model.suspension.structure()

    @cached_property
    def wheels(self) -> dict[str, RoadWheel]:
        """The wheel."""
        suspension = self.model.suspension
        at_design = suspension.hardpoints.metres(CENTER)
        facts, design = vehicle_of(suspension), design_axis(suspension)
        wheel = RoadWheel(facts, self.points[CENTER], at_design, self.axis, design)
        return {"wheel": wheel}

    @property
    def rack_axis(self) -> Array | None:
        """Along which the rack slides; None where nothing is steered."""
        suspension = self.model.suspension
        return unit_vector(suspension.rack.axis) if suspension.steered() else None

    def parameters_of(self, line: LineForce) -> Mapping[str, float]:
        """Return the parameters of the spring or the stops on a line."""
        del line
        return self.model.parameters

    def counted_by(self, line: LineForce) -> str:
        """Return the signal by which the stops on a line count: a length."""
        del line
        return f"{self.model.suspension.STOPPED}_length"

    def carried_by(self, part: str, point: str) -> Array:
        """Return where a part has a hardpoint: where all that are joined there have it, (n, 3)."""
        del part
        return self.points[point]

    def signals(self) -> dict[str, Array]:
        """Return the signals of the equations, (n,)."""
        return self.model.signals(self.states, self.inputs)

    def allowed_lengths(self) -> Sequence[LengthLimit]:
        """Return the lengths that the file allows."""
        return self.model.suspension.allowed_lengths()

    def weights(self) -> dict[str, Array]:
        """Return the weight of each part, (3,) [N]."""
        model = self.model
        masses = {name: model.parameters[f"{name}_mass"] for name in model.equations.BODIES}
        return {name: -mass * model.parameters["gravity"] * UP for name, mass in masses.items()}

    def forces_along_lines(self) -> dict[str, Array]:
        """Return the force of each line of the structure, positive when it pushes, (n,) [N]."""
        return forces_along(self.structure, self.model, self.states, self.inputs)

    def twists(self) -> dict[str, Array]:
        """Return how each part moves for a unit rate of the arm angle, (n, 1, 6)."""
        model, states = self.model, self.states.copy()
        states[..., model.state_names.index(f"{model.names.arm}_rate")] = 1.0
        found = model.evaluate("velocities", states, self.inputs)
        return {name: found[:, i, None] for i, name in enumerate(model.equations.BODIES)}

    def masses(self) -> dict[str, PartMass]:
        """Return what the acceleration of each part with a mass moves."""
        values, suspension = self.model.parameters, self.model.suspension
        axes = {"wheel": suspension.wheel.spin_axis(suspension.vehicle.sign)}
        return {
            part: PartMass.of(values, part, part, axes.get(part))
            for part in (*self.structure.parts, "rack")
            if values.get(f"{part}_mass", 0.0) != 0.0
        }

    def rates_of_inputs(self) -> Array:
        """Return the rates of the inputs that move parts: those of a rack that is held."""
        model, inputs = self.model, self.inputs
        by_time = np.zeros_like(inputs)
        if model.suspension.steered() and not model.free_rack:
            names = ("rack_position", *rates_of("rack_position", model.equations.INPUTS))
            position, velocity, acceleration = (model.input_names.index(name) for name in names)
            by_time[:, position] = inputs[:, velocity]
            by_time[:, velocity] = inputs[:, acceleration]
        return by_time

    def tyre_forces(self) -> dict[str, Array]:
        """Return the force of the tyre, in the plane of the wheel, (n, 3) [N]."""
        force = self.model.signal("tyre_force", self.states, self.inputs)
        return {"wheel": force[:, None] * upward_across(self.axis)}

    def inputs_of_wheels(self) -> dict[str, dict[str, Array]]:
        """Return the inputs on the wheel; empty where the equations have none."""
        if not self.model.wheel_loads:
            return {}
        return {"wheel": dict(zip(self.model.input_names, self.inputs.T, strict=True))}


def states_with(
    model: System, values: Mapping[str, Array], count: int, prefix: str = ""
) -> tuple[Array, Array]:
    """Return states and inputs of equations, (count, names) each; missing ones are zero.

    Parameters
    ----------
    model : System
    values : mapping of str to ndarray
        By name, (count,) each.
    count : int
    prefix : str, optional
        Prefix of the names in the mapping; a shared value has none.
    """
    states, inputs = (np.zeros((count, len(own))) for own in (model.state_names, model.input_names))
    for array, names in ((states, model.state_names), (inputs, model.input_names)):
        for column, name in zip(array.T, names, strict=True):
            column[:] = values.get(f"{prefix}{name}", values.get(name, 0.0))
    return states, inputs


def forces_along(
    structure: Structure, model: System, states: Array, inputs: Array
) -> dict[str, Array]:
    """Return the force of each line of a structure in some states, (n,) [N]."""
    values = model.signals(states, inputs)
    values |= dict(zip(model.input_names, np.moveaxis(inputs, -1, 0), strict=True))
    nothing = np.zeros(states.shape[:-1])
    return {
        line.name: sum((values[name] for name in line.signals if name in values), nothing)
        for line in structure.lines
    }


def wheel_axes(wheel: RoadWheel) -> Array:
    """Return the axes of a wheel on the road as rows, (n, 3, 3): forward, left, up.

    Forward is horizontal in the plane of the wheel, as in the tyre axes of ISO 8855.
    """
    return road_axes(wheel.vehicle.side * wheel.axis)


def touching(wheel: RoadWheel) -> Array:
    """Return where the road touches a wheel: its lowest point, or its centre without a radius."""
    radius = wheel.vehicle.tyre_radius
    return wheel.center if radius is None else lowest_point(wheel.center, wheel.axis, radius)


def road_axes(left: Array) -> Array:
    """Return the axes of wheels on the road, see `wheel_axes`.

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
