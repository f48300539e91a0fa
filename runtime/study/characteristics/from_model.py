"""The corner of a suspension, from its compiled model: exact, nothing is differenced."""

import numpy as np
from numpy.typing import ArrayLike

from ...suspension.corner import Array, Corner, Motion, Vehicle
from ...suspension.input.units import in_metres
from ...suspension.kinds import Suspension
from ...suspension.model import Model
from ...suspension.points import hardpoints
from ...suspension.reach import at_rest
from ...suspension.strokes import Strokes
from ...systems.inputs import rates_of


def corner(model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0) -> Corner:
    """Return the corner at arm angles and rack positions.

    Parameters
    ----------
    model : Model
    arm_angle, rack_position : array_like
        Angle of the lower arm as in the state [rad], and displacement of the rack [m]; they are
        broadcast.

    Returns
    -------
    Corner
    """
    kind = model.suspension
    states, inputs = at_rest(model, arm_angle, rack_position)
    points = hardpoints(model, states, inputs)
    turned = model.evaluate("orientations", states, inputs)[..., _knuckle(model), :, :]
    at_design = design_axis(model.suspension)
    by_arm = _motion(model, points, states, inputs, "arm")
    by_rack = _motion(model, points, states, inputs, "rack")
    travel = by_arm.per(by_arm.velocity[..., 2])
    strokes = _strokes(model, states, inputs)
    low, high = model.suspension.hardpoints.STEERING_AXIS
    return Corner(
        vehicle=vehicle(model.suspension),
        center=points["wheel_center"],
        design_center=model.suspension.hardpoints.metres("wheel_center"),
        axis=turned @ at_design,
        design_axis=at_design,
        lower=points[low],
        upper=points[high],
        travel=travel,
        steering=by_rack.minus(travel, by_rack.velocity[..., 2]),
        links=kind.links_at(points),
        spring=kind.spring_at(strokes),
        stops=kind.stops_at(strokes),
        damper=kind.damper_at(strokes),
        arm_rotation=model.design_state[0] - np.broadcast_to(arm_angle, states.shape[:-1]),
    )


def gaps(model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0) -> tuple[Array, ...]:
    """Return what is open of each stop at arm angles and rack positions.

    Parameters
    ----------
    model : Model
    arm_angle, rack_position : array_like
        Angle of the lower arm as in the state [rad], and displacement of the rack [m]; they are
        broadcast.

    Returns
    -------
    tuple of ndarray
        For each stop that the model has: positive where it is free, negative where it is compressed
        [m]. What `catalogue.AT_STOPS` names jumps where a gap closes.
    """
    return model.suspension.gaps_at(_strokes(model, *at_rest(model, arm_angle, rack_position)))


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


def _strokes(model: Model, states: Array, inputs: Array) -> Strokes:
    return Strokes(model, states, inputs, model.names.arm)


def _metres(length: float | None) -> float | None:
    return None if length is None else in_metres(length, "mm")


def design_axis(suspension: Suspension) -> Array:
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
        states[..., model.state_names.index(f"{model.names.arm}_rate")] = 1.0
    elif model.free_rack:
        states[..., model.state_names.index(f"{model.names.rack}_rate")] = 1.0
    else:
        velocity_input, *_ = rates_of("rack_position", model.equations.INPUTS)
        inputs[..., model.input_names.index(velocity_input)] = 1.0
    twist = model.evaluate("velocities", states, inputs)[..., _knuckle(model), :]
    turning, velocity = twist[..., :3], twist[..., 3:]
    origin = model.evaluate("positions", states, inputs)[..., _knuckle(model), :]

    def at(point: str) -> Array:
        return velocity + np.cross(turning, points[point] - origin)

    given = model.suspension.hardpoints
    # a strut turns about its mount on the chassis
    lower, upper = (
        at(point) if point in given.CARRIERS else np.zeros_like(velocity)
        for point in given.STEERING_AXIS
    )
    return Motion(at("wheel_center"), turning, lower, upper)
