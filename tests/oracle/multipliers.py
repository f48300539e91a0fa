"""Dynamics of the suspension in maximal coordinates with Lagrange multipliers.

The equations of Newton and Euler of the six moving bodies are solved together with the joints'
equations of `oracle.constraints`, differentiated twice:

    [M  G^T] [acceleration]   [applied - gyroscopic]
    [G   0 ] [multipliers ] = [   - (dG/dt) twist  ]

The accelerations of the independent coordinates are then read off the bodies' accelerations. The
rack is either free, with a force on it, or its motion is one more constraint.

The independent coordinates are in this order everywhere: beta1 (rad), wheel spin (rad, of the wheel
relative to the knuckle about the spin axis) and, where the rack is free, rack displacement (m,
along the unit rack axis). Units are SI, world axes are the chassis axes. Twists and wrenches are
(velocity of the centre of mass, angular velocity) and (force, moment about the centre of mass).
"""

from dataclasses import dataclass

import numpy as np

from oracle.constraints import ARM, KNUCKLE, RACK, UPPER_STRUT, WHEEL, Array
from oracle.laws import damper_force, friction_force, spring_force, stop_force, tyre_load
from oracle.newton import Z_AXIS, observe

CAUSES = (
    "gravity",
    "spring",
    "damper",
    "friction",
    "bump_stop",
    "rebound_stop",
    "actuator",
    "tyre",
    "rack",
)
"""Forces that do work on the moving bodies."""


@dataclass(frozen=True)
class Solution:
    """Motion and forces at one instant.

    Attributes
    ----------
    coordinate_accelerations : ndarray, shape (3,)
        Second derivatives of beta1, spin and rack displacement: rad/s², rad/s², m/s². The last is
        the prescribed one where the rack is not free.
    twist, acceleration : ndarray, shape (6, 6)
        Velocity and acceleration of the centre of mass, angular velocity and acceleration, of each
        body in the order of `oracle.constraints.BODIES`.
    multipliers : ndarray, shape (33,) or (34,)
        Of the joints' equations, and of the rack's motion if prescribed: N and N m.
    strut_slide_rate : float
        Rate of beta2, m/s, positive in bump.
    """

    coordinate_accelerations: Array
    twist: Array
    acceleration: Array
    multipliers: Array
    strut_slide_rate: float

    @property
    def beta1_acceleration(self):
        """Second derivative of the arm angle, rad/s²."""
        return float(self.coordinate_accelerations[0])

    @property
    def spin_acceleration(self):
        """Second derivative of the wheel's angle relative to the knuckle, rad/s²."""
        return float(self.coordinate_accelerations[1])

    @property
    def rack_acceleration(self):
        """Second derivative of the rack displacement, m/s²."""
        return float(self.coordinate_accelerations[2])


@dataclass(frozen=True)
class ReducedEquations:
    """The equations M q'' + B = Q of the three independent coordinates, at one instant.

    Attributes
    ----------
    mass_matrix : ndarray, shape (3, 3)
        M; kg m², and kg m and kg in the rack's row and column.
    inertial : ndarray, shape (3,)
        B, all that the accelerations at q'' = 0 and the gyroscopic moments contribute: N m, N m, N.
    applied : ndarray, shape (3,)
        Q, of all applied forces: N m, N m, N.
    jacobian : ndarray, shape (6, 6, 3)
        Twists of the bodies for unit rates of the coordinates.
    """

    mass_matrix: Array
    inertial: Array
    applied: Array
    jacobian: Array


def rate_rows(mechanism, pose):
    """Return what, times the twists, gives the rates of beta1, spin and rack, shape (3, 36)."""
    rows = np.zeros((3, 6, 6))
    axis = pose.rotation[KNUCKLE - 1] @ mechanism.spin_axis
    rows[0, ARM - 1, 3:] = -mechanism.hinge[0]
    rows[1, WHEEL - 1, 3:] = axis
    rows[1, KNUCKLE - 1, 3:] = -axis
    rows[2, RACK - 1, :3] = mechanism.rack_axis
    return rows.reshape(3, 36)


def solve_twist(mechanism, pose, beta1_rate, spin_rate, rack_rate=0.0):
    """Return the twists of the bodies, (6, 6), for rates of the coordinates: rad/s, rad/s, m/s."""
    rates = np.array([beta1_rate, spin_rate, rack_rate])
    return (_jacobian(mechanism, pose) @ rates).reshape(6, 6)


def solve_prescribed(
    mechanism, pose, beta1_rate, spin_rate, rack_velocity=0.0, *, rack_acceleration=0.0, **inputs
):
    """Solve the dynamics with the rack's motion prescribed (its displacement is the pose's).

    Rates are in rad/s, velocity and acceleration of the rack along its unit axis in m/s and m/s²,
    the inputs are those of `applied_wrenches`.
    """
    twist = solve_twist(mechanism, pose, beta1_rate, spin_rate, rack_velocity)
    return _solve(mechanism, pose, twist, inputs, rack_acceleration)


def solve_free(mechanism, pose, beta1_rate, spin_rate, rack_rate=0.0, **inputs):
    """Solve the dynamics with the rack free to slide; rates and inputs as `solve_prescribed`."""
    twist = solve_twist(mechanism, pose, beta1_rate, spin_rate, rack_rate)
    return _solve(mechanism, pose, twist, inputs, None)


def applied_wrenches(
    mechanism, pose, twist, *, road_height=0.0, road_velocity=0.0, strut_force=0.0, rack_force=0.0
):
    """Return the applied forces by their cause.

    Parameters
    ----------
    mechanism, pose, twist
        The suspension, its pose and the twists of its bodies, shape (6, 6).
    road_height, road_velocity : float
        z of the road under the wheel, m, and its rate, m/s.
    strut_force : float
        Actuator force that pushes knuckle and chassis apart along the strut, N.
    rack_force : float
        Force on the rack along its unit axis, N.

    Returns
    -------
    dict of ndarray, shape (6, 6)
        By `CAUSES`: force (N) and moment about the centre of mass (N m) on each body.
    """
    given = mechanism.parameters
    wrenches = {cause: np.zeros((6, 6)) for cause in CAUSES}
    wrenches["gravity"][:, 2] = -given["gravity"] * mechanism.masses

    seen = observe(mechanism, pose)
    slide_rate = _slide_rate(mechanism, pose, twist)
    strut = {
        "damper": damper_force(given, slide_rate),
        "friction": friction_force(given, slide_rate),
        "bump_stop": stop_force(given, "bump", seen.strut_length),
        "rebound_stop": stop_force(given, "rebound", seen.strut_length),
        "actuator": strut_force,
    }
    lower = mechanism.point(pose, "strut_lower", KNUCKLE)
    top = mechanism.point(pose, "strut_top", UPPER_STRUT)
    for cause, magnitude in strut.items():
        push = magnitude * seen.strut_direction
        wrenches[cause][KNUCKLE - 1] = _wrench(pose, KNUCKLE, lower, push)
        wrenches[cause][UPPER_STRUT - 1] = _wrench(pose, UPPER_STRUT, top, -push)

    # The spring's upper seat is on the chassis, which does not move.
    seat = mechanism.point(pose, "spring_seat", KNUCKLE)
    along = (seat - mechanism.points["spring_top"]) / seen.spring_length
    push = spring_force(given, seen.spring_length) * along
    wrenches["spring"][KNUCKLE - 1] = _wrench(pose, KNUCKLE, seat, push)

    deflection = given["tyre_free_height"] + road_height - pose.position[WHEEL - 1, 2]
    load = tyre_load(given, deflection, road_velocity - twist[WHEEL - 1, 2])
    axis = seen.spin_axis
    upright = (Z_AXIS - axis[2] * axis) / (1.0 - axis[2] ** 2)
    wrenches["tyre"][WHEEL - 1, :3] = load * upright

    wrenches["rack"][RACK - 1, :3] = rack_force * mechanism.rack_axis
    return wrenches


def _wrench(pose, body, place, force):
    """Return the force and its moment about the body's centre of mass, shape (6,)."""
    return np.concatenate((force, np.cross(place - pose.position[body - 1], force)))


def reduced_equations(mechanism, pose, beta1_rate, spin_rate, rack_rate=0.0, **inputs):
    """Project the equations of Newton and Euler onto the coordinates; arguments as `solve_free`."""
    jacobian = _jacobian(mechanism, pose)
    twist = (jacobian @ np.array([beta1_rate, spin_rate, rack_rate])).reshape(6, 6)
    drift = _solve_refined(
        _square(mechanism, pose),
        np.concatenate((-mechanism.joints.convective(pose, twist), np.zeros(3))),
    )
    wrenches = applied_wrenches(mechanism, pose, twist, **inputs)
    mass, gyroscopic = _inertia(mechanism, pose, twist)
    return ReducedEquations(
        mass_matrix=jacobian.T @ mass @ jacobian,
        inertial=jacobian.T @ (mass @ drift + gyroscopic),
        applied=jacobian.T @ np.sum(list(wrenches.values()), axis=0).ravel(),
        jacobian=jacobian.reshape(6, 6, 3),
    )


def _square(mechanism, pose):
    """Return the joints' Jacobian with the rate rows below it, shape (36, 36)."""
    _, constraint = mechanism.joints.evaluate(pose)
    return np.vstack((constraint, rate_rows(mechanism, pose)))


def _jacobian(mechanism, pose):
    """Return the twists for unit rates of the independent coordinates, shape (36, 3)."""
    return _solve_refined(_square(mechanism, pose), np.eye(36)[:, 33:])


def _inertia(mechanism, pose, twist):
    """Return the mass matrix (36, 36) and the gyroscopic wrenches w x I w, (36,)."""
    matrix = np.zeros((36, 36))
    gyroscopic = np.zeros(36)
    for body in range(6):
        start = 6 * body
        rotation = pose.rotation[body]
        tensor = rotation @ mechanism.inertias[body] @ rotation.T
        omega = twist[body, 3:]
        matrix[start : start + 3, start : start + 3] = mechanism.masses[body] * np.eye(3)
        matrix[start + 3 : start + 6, start + 3 : start + 6] = tensor
        gyroscopic[start + 3 : start + 6] = np.cross(omega, tensor @ omega)
    return matrix, gyroscopic


def _slide_rate(mechanism, pose, twist):
    """Return the rate of beta2, m/s: how fast knuckle and chassis approach along the strut."""
    arm = mechanism.point(pose, "strut_lower", KNUCKLE) - pose.position[KNUCKLE - 1]
    speed = twist[KNUCKLE - 1, :3] + np.cross(twist[KNUCKLE - 1, 3:], arm)
    span = pose.position[KNUCKLE - 1] + arm - mechanism.points["strut_top"]
    return float(-(span @ speed) / np.linalg.norm(span))


def _solve(mechanism, pose, twist, inputs, rack_acceleration):
    """Solve the accelerations and multipliers; the rack is free if its acceleration is None."""
    wrenches = applied_wrenches(mechanism, pose, twist, **inputs)
    _, constraint = mechanism.joints.evaluate(pose)
    drift = -mechanism.joints.convective(pose, twist)
    rows = rate_rows(mechanism, pose)
    if rack_acceleration is not None:
        constraint = np.vstack((constraint, rows[2]))
        drift = np.append(drift, rack_acceleration)
    mass, gyroscopic = _inertia(mechanism, pose, twist)
    applied = np.sum(list(wrenches.values()), axis=0).ravel()

    count = len(drift)
    matrix = np.block([[mass, constraint.T], [constraint, np.zeros((count, count))]])
    unknowns = _solve_refined(matrix, np.concatenate((applied - gyroscopic, drift)))
    acceleration = unknowns[:36].reshape(6, 6)
    multipliers = unknowns[36:]

    # The spin axis is fixed in the knuckle; its motion contributes nothing to spin'', since the
    # relative angular velocity is along it.
    coordinate_accelerations = rows @ unknowns[:36]

    return Solution(
        coordinate_accelerations=coordinate_accelerations,
        twist=twist,
        acceleration=acceleration,
        multipliers=multipliers,
        strut_slide_rate=_slide_rate(mechanism, pose, twist),
    )


def _solve_refined(matrix, right):
    """Solve a square system, with refinement by residuals in extended precision.

    Massless bodies leave the mass matrix singular, but the matrix of the equations of motion is
    not as long as the motions that the joints allow carry inertia. Where it is singular all the
    same, the solution of least norm is returned.
    """
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0], dtype=float)
    solution = inverse @ right
    for _ in range(2):
        residual = right - matrix.astype(np.longdouble) @ solution.astype(np.longdouble)
        solution = solution + inverse @ residual.astype(float)
    return solution
