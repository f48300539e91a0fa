"""CasADi: maximal coordinates with Lagrange multipliers, as generated C.

Arm, knuckle and wheel, the bodies that have mass, each with position, rotation matrix, velocity and
angular velocity (body axes). The massless tie rod is a distance, the massless upper strut two
equations: the strut top lies on the knuckle's axis. That leaves 16 equations for 18 accelerations.
Jacobian and bias are CasADi's AD; the multipliers come from G M^-1 G^T by its sparse Cholesky.
"""

import time
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from .casadi_tree import Model, as_literals, as_symbols
from .case import ARM, KNUCKLE, MASSIVE, WHEEL, Array, Instant, car, parameters
from .geometry import strut_frame

ACCELERATIONS = slice(36, 54)
"""Where the accelerations are in the output; also the velocities in the state."""

_LOADS = ("spring_rate", "damper_rate", "tyre_rate", "tyre_free_height", "gravity")


def numbers() -> dict[str, Array]:
    """Return all constants by name, SI units; arms are from the bodies' centres of mass."""
    mechanism, given = car(), parameters()
    point, centre = mechanism.points, mechanism.centres
    frame, spin = strut_frame(), mechanism.spin_axis
    first = np.cross(spin, [1.0, 0.0, 0.0])
    tensors = [mechanism.inertias[body - 1] for body in MASSIVE]
    values: dict[str, Any] = {
        "hinge_foot": mechanism.hinge_foot,
        "hinge": mechanism.hinge,
        "strut_top": point["strut_top"],
        "tie_rod_inner": point["tie_rod_inner"],
        "arm_foot": mechanism.hinge_foot - centre[ARM],
        "arm_ball": point["ball_joint"] - centre[ARM],
        "ball": point["ball_joint"] - centre[KNUCKLE],
        "tie_rod_outer": point["tie_rod_outer"] - centre[KNUCKLE],
        "hub": point["wheel_center"] - centre[KNUCKLE],
        "across": frame[1:].T,
        "spin_axis": spin,
        "spin_across": np.array([first, np.cross(spin, first)]).T,
        "tensors": np.hstack(tensors),
        "inverses": np.hstack([np.linalg.inv(tensor) for tensor in tensors]),
        "masses": mechanism.masses[[body - 1 for body in MASSIVE]],
        "free_length": given["strut_length_max"] - given["spring_free_slide"],
    }
    values |= {name: given[name] for name in _LOADS}
    arrays = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    return {name: np.where(abs(value) < 1e-15, 0.0, value) for name, value in arrays.items()}


def build(*, literal: bool) -> Model:
    """Set up the function of the right-hand side.

    Parameters
    ----------
    literal : bool
        Whether the constants are folded in as numbers.

    Returns
    -------
    Model
        State: positions (9), rotations (3 times 9, by columns), velocity and angular velocity of
        each body (18).
    """
    begin = time.perf_counter()
    values = numbers()
    symbols, given = as_symbols(values)
    c = SimpleNamespace(**(as_literals(values) if literal else given))
    state = ca.SX.sym("x", 54)
    pose, velocity = state[:36], state[36:]
    rate = _pose_rate(pose, velocity)
    gap_rate = ca.jtimes(_gaps(c, pose), pose, rate)
    jacobian = ca.jacobian(gap_rate, velocity)
    bias = ca.jtimes(gap_rate, pose, rate)
    free = _mobility(c, _forces(c, pose, velocity, rate))
    spread = ca.horzcat(*[_mobility(c, row) for row in ca.vertsplit(jacobian)])
    multipliers = _cholesky_solve(jacobian @ spread, jacobian @ free + bias)
    acceleration = free - spread @ multipliers
    inputs = ca.SX(0, 1) if literal else symbols
    name = f"casadi_maximal_{'literal' if literal else 'inputs'}"
    out = ca.cse(ca.simplify(ca.vertcat(rate, acceleration)))
    function = ca.Function(name, [state, inputs], [ca.densify(out)], ["x", "p"], ["ode"])
    flat = np.concatenate([np.ravel(value, order="F") for value in values.values()])
    return Model(function, np.zeros(0) if literal else flat, time.perf_counter() - begin)


def state(instant: Instant) -> Array:
    """Return this model's state, shape (54,)."""
    chosen = [body - 1 for body in MASSIVE]
    rotation = instant.pose.rotation[chosen]
    twist = instant.twist[chosen].copy()
    twist[:, 3:] = np.einsum("bji,bj->bi", rotation, twist[:, 3:])
    turned = rotation.swapaxes(1, 2)
    return np.concatenate((instant.pose.position[chosen], turned, twist), axis=None)


def accelerations(instant: Instant, out: Array) -> Array:
    """Return the second derivatives of beta1 and spin from this model's output, shape (2,)."""
    angular = out[ACCELERATIONS].reshape(3, 6)[:, 3:]
    arm, knuckle, wheel = (
        instant.pose.rotation[body - 1] @ alpha
        for body, alpha in zip(MASSIVE, angular, strict=True)
    )
    axis = instant.pose.rotation[WHEEL - 1] @ car().spin_axis
    return np.array([-car().hinge[0] @ arm, axis @ (wheel - knuckle)])


def _rotations(pose: Any) -> list[Any]:
    return [ca.reshape(pose[9 + 9 * body : 18 + 9 * body], 3, 3) for body in range(3)]


def _pose_rate(pose: Any, velocity: Any) -> Any:
    speeds = [velocity[6 * body : 6 * body + 3] for body in range(3)]
    turns = [
        ca.vec(rotation @ ca.skew(velocity[6 * body + 3 : 6 * body + 6]))
        for body, rotation in enumerate(_rotations(pose))
    ]
    return ca.vertcat(*speeds, *turns)


def _points(c: Any, pose: Any) -> SimpleNamespace:
    _, knuckle, _ = _rotations(pose)
    return SimpleNamespace(
        ball=pose[3:6] + knuckle @ c.ball,
        rod=pose[3:6] + knuckle @ c.tie_rod_outer,
        wheel=pose[6:9],
    )


def _gaps(c: Any, pose: Any) -> Any:
    """Return the 16 constraint residuals."""
    arm, knuckle, wheel = _rotations(pose)
    point = _points(c, pose)
    rod = point.rod - c.tie_rod_inner
    axis = wheel @ c.spin_axis
    return ca.vertcat(
        pose[:3] + arm @ c.arm_foot - c.hinge_foot,
        c.hinge[1:, :] @ (arm @ c.hinge[0, :].T),
        pose[:3] + arm @ c.arm_ball - point.ball,
        (knuckle @ c.across).T @ (point.ball - c.strut_top),
        0.5 * ca.sumsqr(rod),
        pose[3:6] + knuckle @ c.hub - point.wheel,
        (knuckle @ c.spin_across).T @ axis,
    )


def _forces(c: Any, pose: Any, velocity: Any, rate: Any) -> Any:
    """Return force and moment (body axes) on each body, gyroscopic moments included."""
    point = _points(c, pose)
    span = point.ball - c.strut_top
    length = ca.sqrt(ca.sumsqr(span))
    ball_rate = ca.jtimes(point.ball, pose, rate)
    stretch = ca.dot(span, ball_rate) / length
    strut = c.spring_rate * (c.free_length - length) - c.damper_rate * stretch
    _, knuckle, wheel = _rotations(pose)
    axis = wheel @ c.spin_axis
    deflection = point.wheel[2] - c.tyre_free_height
    upright = (ca.vertcat(0, 0, 1) - axis[2] * axis) / (1 - axis[2] ** 2)
    push = strut / length * span
    result = ca.vertcat(
        ca.SX(6, 1),
        push,
        ca.cross(c.ball, knuckle.T @ push),
        -c.tyre_rate * deflection * upright,
        ca.SX(3, 1),
    )
    for body in range(3):
        omega = velocity[6 * body + 3 : 6 * body + 6]
        tensor = c.tensors[:, 3 * body : 3 * body + 3]
        result[6 * body + 2] -= c.masses[body] * c.gravity
        result[6 * body + 3 : 6 * body + 6] -= ca.cross(omega, tensor @ omega)
    return result


def _mobility(c: Any, wrench: Any) -> Any:
    """Return the inverse of the mass matrix times a wrench (a row or a column of 18)."""
    column = wrench.T if wrench.size1() == 1 else wrench
    parts = []
    for body in range(3):
        parts.append(column[6 * body : 6 * body + 3] / c.masses[body])
        inverse = c.inverses[:, 3 * body : 3 * body + 3]
        parts.append(ca.sparsify(inverse @ column[6 * body + 3 : 6 * body + 6]))
    return ca.vertcat(*parts)


def _cholesky_solve(matrix: Any, right: Any) -> Any:
    """Solve a symmetric positive definite system by CasADi's sparse LDL^T."""
    factor_d, factor_l, order = ca.ldl(matrix, True)
    return ca.ldl_solve(right, factor_d, factor_l, order)
