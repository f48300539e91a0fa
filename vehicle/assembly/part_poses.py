"""Poses of the parts of a suspension, and the external forces on them."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...core.named_types import Array
from ...core.physical import ELEMENTS, inertia_tensor
from ...core.vectors import cross, directions
from ...systems.allowed import LengthLimit
from ...systems.inputs import rates_of
from ...systems.system import System
from ..corner.corner import UP, RoadWheel
from ..corner.structure import LineForce, Structure
from ..models.model import Model
from ..models.points import hardpoints
from .corner_kinematics import design_axis, vehicle_of
from .wheel import lowest_point, upward_across


@dataclass(frozen=True)
class PartMass:
    """Mass and inertia of a part."""

    body: str  # name of the part in the equations
    mass: float  # [kg]
    tensor: Array  # inertia about its centre of mass at design, chassis axes, (3, 3) [kg m^2]

    @classmethod
    def of(
        cls, parameters: Mapping[str, float], name: str, body: str, spin_axis: Array | None = None
    ) -> "PartMass":
        """Return mass and inertia of a body.

        `name` is the prefix of its parameters in the equations. `spin_axis`, (3,), is that of a
        wheel at design: its parameters are the inertia about this axis and across it.
        """
        if spin_axis is None:
            tensor = inertia_tensor([parameters[f"{name}_inertia_{which}"] for which in ELEMENTS])
        else:
            tensor = _of_wheel(parameters, name, spin_axis)
        return cls(body, parameters[f"{name}_mass"], tensor)


def _of_wheel(parameters: Mapping[str, float], name: str, axis: Array) -> Array:
    spin, across = (parameters[f"{name}_inertia_{part}"] for part in ("spin", "diametral"))
    return across * np.eye(3) + (spin - across) * np.outer(axis, axis)


CONTACT, CENTER = "contact", "wheel_center"
"""The points of a wheel at which loads act: its lowest point and its centre."""


@dataclass(frozen=True)
class PartPoses(ABC):
    """The parts of a suspension or of an axle in n positions, and the forces that need no input."""

    model: Any
    states: Array
    inputs: Array
    # hardpoints, and `contact` of each wheel if its radius is known, (n, 3) [m]
    points: dict[str, Array]
    # of each part a point that it carries, its centre of mass if it has one, (n, 3) [m]; and its
    # rotation from design, (n, 3, 3)
    centers: dict[str, Array]
    turned: dict[str, Array]

    @property
    @abstractmethod
    def structure(self) -> Structure:
        """The joints and force elements between the parts."""

    @property
    @abstractmethod
    def design(self) -> Mapping[str, Array]:
        """The hardpoints at design, (3,) [m]."""

    @property
    @abstractmethod
    def wheels(self) -> Mapping[str, RoadWheel]:
        """The wheels, by part, the left one first."""

    @property
    def rack_axis(self) -> Array | None:
        """The axis along which a rack slides, if there is one."""
        return None

    @property
    @abstractmethod
    def steering_gear(self) -> Any:
        """The section of the file that steers the wheels; None without steering."""

    @abstractmethod
    def weights(self) -> Mapping[str, Array]:
        """Return the weight of each part with a mass, (3,) [N]."""

    def forces_along_lines(self) -> dict[str, Array]:
        """Return the force of each line of the structure, positive when it pushes, (n,) [N]."""
        values = self.signals()
        values |= dict(zip(self.model.input_names, np.moveaxis(self.inputs, -1, 0), strict=True))
        nothing = np.zeros(self.states.shape[:-1])
        return {
            line.name: sum((values[name] for name in line.signals if name in values), nothing)
            for line in self.structure.lines
        }

    def signals(self) -> dict[str, Array]:
        """Return the signals of the equations, (n,)."""
        return self.model.signals(self.states, self.inputs)

    @abstractmethod
    def parameters_of(self, line: LineForce) -> Mapping[str, float]:
        """Return the parameters of spring or stops on a line, with the names of a right wheel."""

    @abstractmethod
    def counted_by(self, line: LineForce) -> str:
        """Return the signal, a length, that determines the force of the stops on a line."""

    def carried_by(self, part: str, point: str) -> Array:
        """Return the position of a hardpoint on a part, if its joints were apart, (n, 3) [m]."""
        return self.points[point]

    @abstractmethod
    def allowed_lengths(self) -> Sequence[LengthLimit]:
        """Return the lengths that the file allows, of these signals."""

    @abstractmethod
    def twists(self) -> Mapping[str, Array]:
        """Return the velocities of each part at rest for a unit rate of each coordinate alone.

        The shape is (n, coordinates, 6): angular velocity, and velocity of `centers`, with the
        brakes closed and the rack held.
        """

    @abstractmethod
    def masses(self) -> Mapping[str, PartMass]:
        """Return mass and inertia of each part with a mass."""

    def rates_of_inputs(self) -> Array:
        """Return the rates of the inputs that move parts, of the shape of `inputs`."""
        return np.zeros_like(self.inputs)

    @abstractmethod
    def tyre_forces(self) -> Mapping[str, Array]:
        """Return the force of the tyre on each wheel, in the plane of the wheel, (n, 3) [N]."""

    @abstractmethod
    def inputs_of_wheels(self) -> Mapping[str, Mapping[str, Array]]:
        """Return the inputs of `kintrafo.vehicle.corner.wheel_loads` on each wheel, (n,).

        It is empty if the equations do not have them.
        """


@dataclass(frozen=True)
class CornerParts(PartPoses):
    """The parts of a suspension in n positions."""

    model: Model
    axis: Array  # spin axis of the wheel, pointing outboard, (n, 3)

    @classmethod
    def of(cls, model: Model, states: Array, inputs: Array) -> "CornerParts":
        """Return the parts in some states."""
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
        return self.model.suspension.hardpoints.at_design()

    @property
    def structure(self) -> Structure:
        return self.model.suspension.structure()

    @cached_property
    def wheels(self) -> dict[str, RoadWheel]:
        suspension = self.model.suspension
        at_design = suspension.hardpoints.metres(CENTER)
        facts, design = vehicle_of(suspension), design_axis(suspension)
        wheel = RoadWheel(facts, self.points[CENTER], at_design, self.axis, design)
        return {"wheel": wheel}

    @property
    def steering_gear(self) -> Any:
        suspension = self.model.suspension
        return suspension.steering_gear if suspension.steered() else None

    @property
    def rack_axis(self) -> Array | None:
        rack = self.model.suspension.rack
        return None if rack is None else rack.direction()

    def parameters_of(self, line: LineForce) -> Mapping[str, float]:
        return self.model.parameters

    def counted_by(self, line: LineForce) -> str:
        return f"{self.model.suspension.STOPPED}_length"

    def allowed_lengths(self) -> Sequence[LengthLimit]:
        return self.model.suspension.allowed_lengths()

    def weights(self) -> dict[str, Array]:
        model = self.model
        masses = {name: model.parameters[f"{name}_mass"] for name in model.equations.BODIES}
        return {name: -mass * model.parameters["gravity"] * UP for name, mass in masses.items()}

    def twists(self) -> dict[str, Array]:
        """Return the velocities of each part for a unit rate of the arm angle, (n, 1, 6)."""
        model, states = self.model, self.states.copy()
        states[..., model.state_names.index(f"{model.names.arm}_rate")] = 1.0
        found = model.evaluate("velocities", states, self.inputs)
        return {name: found[:, i, None] for i, name in enumerate(model.equations.BODIES)}

    def masses(self) -> dict[str, PartMass]:
        values, suspension = self.model.parameters, self.model.suspension
        axes = {"wheel": suspension.wheel.spin_axis(suspension.vehicle.sign)}
        return {
            part: PartMass.of(values, part, part, axes.get(part))
            for part in (*self.structure.parts, "rack")
            if values.get(f"{part}_mass", 0.0) != 0.0
        }

    def rates_of_inputs(self) -> Array:
        """Return the rates of the inputs that move parts: those of a prescribed rack."""
        model, inputs = self.model, self.inputs
        by_time = np.zeros_like(inputs)
        if model.suspension.steered() and not model.free_rack:
            names = ("rack_position", *rates_of("rack_position", model.equations.INPUTS))
            position, velocity, acceleration = (model.input_names.index(name) for name in names)
            by_time[:, position] = inputs[:, velocity]
            by_time[:, velocity] = inputs[:, acceleration]
        return by_time

    def tyre_forces(self) -> dict[str, Array]:
        force = self.model.signal("tyre_force", self.states, self.inputs)
        return {"wheel": force[:, None] * upward_across(self.axis)}

    def inputs_of_wheels(self) -> dict[str, dict[str, Array]]:
        if not self.model.wheel_loads:
            return {}
        return {"wheel": dict(zip(self.model.input_names, self.inputs.T, strict=True))}


def states_with(
    model: System, values: Mapping[str, Array], count: int, prefix: str = ""
) -> tuple[Array, Array]:
    """Return arrays of states and inputs, (count, names) each; missing values are zero.

    `prefix` begins the names in `values`, (count,) each; a shared value has none.
    """
    states, inputs = (np.zeros((count, len(own))) for own in (model.state_names, model.input_names))
    for array, names in ((states, model.state_names), (inputs, model.input_names)):
        for column, name in zip(array.T, names, strict=True):
            column[:] = values.get(f"{prefix}{name}", values.get(name, 0.0))
    return states, inputs


def wheel_axes(wheel: RoadWheel) -> Array:
    """Return the axes of a wheel on the road as rows, (n, 3, 3): forward, left, up.

    Forward is horizontal in the plane of the wheel, as in the tyre axes of ISO 8855.
    """
    return road_axes(wheel.vehicle.side * wheel.axis)


def touching(wheel: RoadWheel) -> Array:
    """Return the contact of a wheel with the road; its centre if the radius is not known."""
    radius = wheel.vehicle.tyre_radius
    return wheel.center if radius is None else lowest_point(wheel.center, wheel.axis, radius)


def road_axes(left: Array) -> Array:
    """Return the axes of wheels on the road, see `wheel_axes`.

    `left` are spin axes that point left, (n, 3).
    """
    forward = directions(cross(left, UP))
    return np.stack([forward, cross(UP, forward), np.broadcast_to(UP, forward.shape)], -2)


def rotated(matrix: Array, rotation: Array) -> Array:
    """Return a matrix of forces and moments, (..., 6, 6), in rotated axes."""
    both = np.zeros((*rotation.shape[:-2], 6, 6))
    both[..., :3, :3] = both[..., 3:, 3:] = rotation
    return both @ matrix @ both.mT


def wrench_about(point: Array, at: Array, force: Array, moment: Array | float = 0.0) -> Array:
    """Return force and moment about `point`, (..., 6), of a force and a moment at another one."""
    return np.concatenate(np.broadcast_arrays(force, moment + cross(at - point, force)), axis=-1)
