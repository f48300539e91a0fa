"""Forces and moments on the bodies of a driving car: rolling tyres, torques, air.

Everything is in the axes of the world. A wheel is a body of its own here, on which the road acts; a
torque acts on the wheel and, reversed, on what has the reaction. A tyre is the linear one, written
once more; its deflections are among the inputs, by their names.
"""

import numpy as np
from kintrafo.generator import RollingTyre, ShaftTorque

UP = np.array([0.0, 0.0, 1.0])


def wrench_of_driving(oracle, force, motion, inputs):
    """Return what one of these forces does, flattened like the twists of moving bodies."""
    if isinstance(force, RollingTyre):
        return _of_tyre(oracle, force, motion, inputs)
    if isinstance(force, ShaftTorque):
        return _of_shaft(oracle, force, motion, inputs)
    return _of_air(oracle, force, motion)


def _of_tyre(oracle, tyre, motion, inputs):
    """Return what the road does to the wheel of a linear tyre."""
    p = {k: oracle.parameters[f"{tyre.law.name}_{k}"] for k in _LINEAR}
    carrier, wheel = (oracle.index[b.name] for b in (tyre.bearing.first, tyre.bearing.second))
    axis = motion.rotation[carrier] @ oracle.along(tyre.wheel.spin)
    down = axis * axis[2] - UP
    cosine = np.linalg.norm(down)
    down = down / cosine
    forward = np.cross(axis, UP) / np.linalg.norm(np.cross(axis, UP))
    left = np.cross(UP, forward)
    center = oracle.point(motion, tyre.wheel.carrier.name, oracle.place(tyre.wheel.center))
    turning = motion.twist[carrier, 3:]
    lowest = p["unloaded_radius"] * down
    deflection = inputs[tyre.road.name] - (center.value + lowest)[2]
    sinking = inputs[tyre.road_velocity.name] - (center.rate + np.cross(turning, lowest))[2]
    load = 0.0
    if deflection > 0.0:
        damping = oracle.parameters[tyre.damper.name]
        load = max(p["vertical_stiffness"] * deflection + damping * sinking, 0.0)
    contact = down * (center.value[2] - inputs[tyre.road.name]) / cosine
    ahead = forward @ center.rate
    sideways = left @ (center.rate + np.cross(turning, contact))
    size = np.hypot(ahead, p["vxlow"])
    slip = (p["effective_radius"] * (motion.twist[wheel, 3:] @ axis) - ahead) / size
    lateral = sideways / size
    if tyre.deflections is not None:
        slip, lateral = (
            inputs[state.name] / max(p[f"relaxation_{a}"], 0.05)
            for state, a in zip(tyre.deflections, "xy", strict=True)
        )
    fx = p["slip_stiffness"] * slip
    fy = -p["cornering_stiffness"] * lateral - p["camber_stiffness"] * axis[2] * ahead / size
    share = p["friction"] * load / np.sqrt((p["friction"] * load) ** 2 + fx**2 + fy**2 + 1e-12)
    fx, fy = fx * share, fy * share
    along = fx * forward + fy * left
    moment = -p["rolling_resistance"] * load * p["unloaded_radius"] * ahead / size * left
    moment = moment - p["trail"] * share**3 * ahead / size * fy * UP
    moment = moment + np.cross(contact, along) + np.cross(lowest, load * UP)
    return oracle.wrench_on(
        motion, tyre.bearing.second.name, center.value, along + load * UP, moment
    )


_LINEAR = ("unloaded_radius", "effective_radius", "vertical_stiffness", "vxlow", "relaxation_x",
           "relaxation_y", "slip_stiffness", "cornering_stiffness", "camber_stiffness", "trail",
           "friction", "rolling_resistance")  # fmt: skip


def _of_shaft(oracle, shaft, motion, inputs):
    """Return a torque on a wheel and its reaction."""
    carrier, wheel, other = (
        oracle.index[b.name] for b in (shaft.bearing.first, shaft.bearing.second, shaft.reaction)
    )
    axis = motion.rotation[carrier] @ oracle.along(shaft.wheel.spin)
    torque = inputs[shaft.torque.name]
    if shaft.standstill is not None:
        spin = axis @ (motion.twist[wheel, 3:] - motion.twist[other, 3:])
        torque = -max(torque, 0.0) * np.sin(
            np.arctan2(spin, oracle.parameters[shaft.standstill.name])
        )
    total = np.zeros((oracle.size + 1, 6))
    total[wheel, 3:] += torque * axis
    total[other, 3:] -= torque * axis
    return total[1:].ravel()


def _of_air(oracle, air, motion):
    """Return drag, lift and moment of the air."""
    density, drag, lift, pitching = (
        oracle.parameters[one.name] for one in (air.density, air.drag, air.lift, air.pitching)
    )
    axes = motion.rotation[oracle.index[air.body.name]]
    point = oracle.point(motion, air.body.name, oracle.place(air.point))
    ahead = axes[:, 0] @ point.rate
    force = (
        -drag * np.sqrt(point.rate @ point.rate + 1e-6) * point.rate + lift * ahead**2 * axes[:, 2]
    )
    half = 0.5 * density
    return oracle.wrench_on(
        motion, air.body.name, point.value, half * force, half * pitching * ahead**2 * axes[:, 1]
    )
