"""The corner of a MacPherson suspension, from its compiled model: exact, nothing is differenced."""

import numpy as np
from numpy.typing import ArrayLike

from ..hardpoints import hardpoints
from ..input.suspension import Suspension
from ..input.units import in_metres
from ..model import Model
from ..reach import at_rest
from .corner import Array, Corner, Motion, Plane, Spring, Stroke, Vehicle


def corner(model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0) -> Corner:
    """Return the corner at arm angles and rack positions.

    Parameters
    ----------
    model : Model
    arm_angle, rack_position : array_like
        beta1 [rad] and displacement of the rack [m]; they are broadcast.

    Returns
    -------
    Corner
    """
    states, inputs = at_rest(model, arm_angle, rack_position)
    points = hardpoints(model, states, inputs)
    turned = model.evaluate("orientations", states, inputs)[..., _knuckle(model), :, :]
    design_axis = _design_axis(model.suspension)
    by_arm = _motion(model, points, states, inputs, "arm")
    by_rack = _motion(model, points, states, inputs, "rack")
    travel = by_arm.per(by_arm.velocity[..., 2])
    strokes = _Strokes(model, states, inputs)
    return Corner(
        vehicle=vehicle(model.suspension),
        center=points["wheel_center"],
        design_center=model.suspension.hardpoints.metres("wheel_center"),
        axis=turned @ design_axis,
        design_axis=design_axis,
        lower=points["ball_joint"],
        upper=points["strut_top"],
        travel=travel,
        steering=by_rack.minus(travel, by_rack.velocity[..., 2]),
        links=_links(points),
        spring=strokes.spring,
        stops=strokes.stops,
        damper=strokes.stroke("strut"),
        arm_angle=model.design_state[0] - np.broadcast_to(arm_angle, states.shape[:-1]),
    )


def vehicle(suspension: Suspension) -> Vehicle:
    """Return what the input says about the vehicle, in SI units.

    Parameters
    ----------
    suspension : Suspension

    Returns
    -------
    Vehicle
    """
    given = suspension.vehicle
    return Vehicle(
        side=given.sign,
        tyre_radius=suspension.tyre_radius(),
        tyre_rate=suspension.tyre.rate_N_per_m,
        wheelbase=_metres(given.wheelbase_mm),
        center_of_gravity_height=_metres(given.center_of_gravity_height_mm),
        front_brake_share=given.front_brake_share,
        travel_per_turn=_metres(suspension.rack.travel_per_turn_mm),
    )


def _metres(length: float | None) -> float | None:
    return None if length is None else in_metres(length, "mm")


def _design_axis(suspension: Suspension) -> Array:
    """Return the spin axis at design, pointing outboard."""
    side = suspension.vehicle.sign
    return side * suspension.wheel.spin_axis(side)


def _knuckle(model: Model) -> int:
    index: int = model.equations.BODIES.index("knuckle")
    return index


def _motion(
    model: Model, points: dict[str, Array], states: Array, inputs: Array, what: str
) -> Motion:
    """Return the motion for a unit rate of the arm angle, or of the rack, the other held.

    Velocities are linear in the rates, so that those at unit rate are the derivatives.
    """
    states, inputs = states.copy(), inputs.copy()
    if what == "arm":
        states[..., model.state_names.index("beta1_rate")] = 1.0
    elif model.free_rack:
        states[..., model.state_names.index("beta9_rate")] = 1.0
    else:
        inputs[..., model.input_names.index("rack_velocity")] = 1.0
    twist = model.evaluate("velocities", states, inputs)[..., _knuckle(model), :]
    turning, velocity = twist[..., :3], twist[..., 3:]
    origin = model.evaluate("positions", states, inputs)[..., _knuckle(model), :]

    def at(point: str) -> Array:
        return velocity + np.cross(turning, points[point] - origin)

    lower = at("ball_joint")
    # the strut turns about its mount on the chassis
    return Motion(at("wheel_center"), turning, lower, upper=np.zeros_like(lower))


def _links(points: dict[str, Array]) -> tuple[Plane, Plane]:
    """Return the plane of the control arm and that across the strut through its mount."""
    ball, front, rear = points["ball_joint"], points["arm_front"], points["arm_rear"]
    top, bottom = points["strut_top"], points.get("strut_lower", ball)
    return Plane(ball, np.cross(front - rear, ball - rear)), Plane(top, top - bottom)


class _Strokes:
    """Lengths and forces over wheel travel, by the chain rule from derivatives by the arm angle."""

    def __init__(self, model: Model, states: Array, inputs: Array) -> None:
        # at unit rate velocities are first derivatives, and their derivatives second ones
        states = states.copy()
        states[..., model.state_names.index("beta1_rate")] = 1.0
        self._signals = model.signals(states, inputs)
        by_arm = model.evaluate("signals_jacobian", states, inputs)[..., 0]
        self._by_arm = dict(zip(model.signal_names, np.moveaxis(by_arm, -1, 0), strict=True))

    @property
    def spring(self) -> Spring:
        """The spring, which may have an axis of its own."""
        own = "spring_length" in self._signals
        return self._spring("spring_force", "spring" if own else "strut")

    @property
    def stops(self) -> tuple[Spring, ...]:
        """The stops that the model has."""
        known = ("bump_stop_force", "rebound_stop_force")
        return tuple(self._spring(force, "strut") for force in known if force in self._signals)

    def stroke(self, path: str) -> Stroke:
        rise, rise_change = self._signals["wheel_velocity"], self._by_arm["wheel_velocity"]
        slope = self._signals[f"{path}_velocity"] / rise
        change = self._by_arm[f"{path}_velocity"]
        return Stroke(
            length=self._signals[f"{path}_length"],
            slope=slope,
            curvature=(change - slope * rise_change) / rise**2,
        )

    def _spring(self, force: str, path: str) -> Spring:
        slope = self._by_arm[force] / self._signals["wheel_velocity"]
        return Spring(self.stroke(path), self._signals[force], slope)
