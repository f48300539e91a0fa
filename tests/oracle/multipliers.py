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

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from oracle.constraints import ARM, KNUCKLE, RACK, UPPER_STRUT, WHEEL, Array, Pose
from oracle.laws import (
    damper_force,
    friction_force,
    spring_energy,
    spring_force,
    stop_energy,
    stop_force,
    tyre_load,
)
from oracle.newton import Z_AXIS, Mechanism, observe, solve_pose

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

RackMotion = Callable[[float], tuple[float, float, float]]


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
    rack_drive_force : float
        Force along the rack axis on the rack that makes it move as prescribed, N; zero where the
        rack is free.
    strut_slide_rate : float
        Rate of beta2, m/s, positive in bump.
    kinetic_energy : float
        In J.
    potential_energy : dict of float
        Of ``gravity`` (zero at z = 0), ``spring``, ``bump_stop``, ``rebound_stop`` and ``tyre``
        (half the rate times the square of the vertical deflection), J.
    power : dict of float
        Of all that does work on the moving bodies, W: the causes of `applied_wrenches`, ``rack``
        being the force on the rack, driving or given. The kinetic energy grows at the rate of their
        sum. Only those of gravity, spring and stops are minus the rates of the potential energies;
        the tyre is not since its force has a part across the wheel's travel.
    """

    coordinate_accelerations: Array
    twist: Array
    acceleration: Array
    multipliers: Array
    rack_drive_force: float
    strut_slide_rate: float
    kinetic_energy: float
    potential_energy: dict[str, float]
    power: dict[str, float]

    @property
    def beta1_acceleration(self) -> float:
        """Second derivative of the arm angle, rad/s²."""
        return float(self.coordinate_accelerations[0])

    @property
    def spin_acceleration(self) -> float:
        """Second derivative of the wheel's angle relative to the knuckle, rad/s²."""
        return float(self.coordinate_accelerations[1])

    @property
    def rack_acceleration(self) -> float:
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


def rate_rows(mechanism: Mechanism, pose: Pose) -> Array:
    """Return what, times the twists, gives the rates of beta1, spin and rack, shape (3, 36)."""
    rows = np.zeros((3, 6, 6))
    axis = pose.rotation[KNUCKLE - 1] @ mechanism.spin_axis
    rows[0, ARM - 1, 3:] = -mechanism.hinge[0]
    rows[1, WHEEL - 1, 3:] = axis
    rows[1, KNUCKLE - 1, 3:] = -axis
    rows[2, RACK - 1, :3] = mechanism.rack_axis
    return rows.reshape(3, 36)


def solve_twist(
    mechanism: Mechanism, pose: Pose, beta1_rate: float, spin_rate: float, rack_rate: float = 0.0
) -> Array:
    """Return the twists of the bodies, (6, 6), for rates of the coordinates: rad/s, rad/s, m/s."""
    rates = np.array([beta1_rate, spin_rate, rack_rate])
    twist: Array = (_jacobian(mechanism, pose) @ rates).reshape(6, 6)
    return twist


def solve_prescribed(
    mechanism: Mechanism,
    pose: Pose,
    beta1_rate: float,
    spin_rate: float,
    rack_velocity: float = 0.0,
    *,
    rack_acceleration: float = 0.0,
    **inputs: float,
) -> Solution:
    """Solve the dynamics with the rack's motion prescribed (its displacement is the pose's).

    Rates are in rad/s, velocity and acceleration of the rack along its unit axis in m/s and m/s²,
    the inputs are those of `applied_wrenches`.
    """
    twist = solve_twist(mechanism, pose, beta1_rate, spin_rate, rack_velocity)
    return _solve(mechanism, pose, twist, inputs, rack_acceleration)


def solve_free(
    mechanism: Mechanism,
    pose: Pose,
    beta1_rate: float,
    spin_rate: float,
    rack_rate: float = 0.0,
    **inputs: float,
) -> Solution:
    """Solve the dynamics with the rack free to slide; rates and inputs as `solve_prescribed`."""
    twist = solve_twist(mechanism, pose, beta1_rate, spin_rate, rack_rate)
    return _solve(mechanism, pose, twist, inputs, None)


def applied_wrenches(
    mechanism: Mechanism,
    pose: Pose,
    twist: Array,
    *,
    road_height: float = 0.0,
    road_velocity: float = 0.0,
    strut_force: float = 0.0,
    rack_force: float = 0.0,
) -> dict[str, Array]:
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


def _wrench(pose: Pose, body: int, place: Array, force: Array) -> Array:
    """Return the force and its moment about the body's centre of mass, shape (6,)."""
    return np.concatenate((force, np.cross(place - pose.position[body - 1], force)))


def reduced_equations(
    mechanism: Mechanism,
    pose: Pose,
    beta1_rate: float,
    spin_rate: float,
    rack_rate: float = 0.0,
    **inputs: float,
) -> ReducedEquations:
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


@dataclass(frozen=True)
class Trajectory:
    """A motion in time.

    Attributes
    ----------
    time : ndarray, shape (n,)
        In s.
    coordinates, rates : ndarray, shape (n, 3)
        beta1, spin, rack displacement, rad, rad, m, and their time derivatives.
    work : ndarray, shape (n,)
        Work done on the moving bodies since the start, J.
    poses, solutions : list
        At the times.
    """

    time: Array
    coordinates: Array
    rates: Array
    work: Array
    poses: list[Pose]
    solutions: list[Solution]


def _at_rest(_time: float) -> tuple[float, float, float]:
    """Hold the rack at design."""
    return 0.0, 0.0, 0.0


def simulate(
    mechanism: Mechanism,
    time: npt.ArrayLike,
    coordinates: tuple[float, float, float],
    rates: tuple[float, float, float],
    *,
    rack_motion: RackMotion | None = _at_rest,
    rtol: float = 1e-12,
    **inputs: Callable[[float], float],
) -> Trajectory:
    """Integrate the independent coordinates with DOP853.

    Parameters
    ----------
    mechanism : Mechanism
        The suspension.
    time : array_like, shape (n,)
        Increasing times at which the result is wanted, the first is the start, s.
    coordinates, rates : tuple of float
        Initial beta1, spin and rack displacement and their rates; the rack's are only used where
        the rack is free.
    rack_motion : callable or None
        Displacement, velocity and acceleration of the rack over time; None for a free rack.
    rtol : float
        Relative tolerance; the absolute tolerances are the same for angles and rates, and a
        hundredth of it for the rack.
    inputs : callable
        Those of `applied_wrenches` over time; `rack_force` only for a free rack.
    """
    times = np.asarray(time, dtype=float)
    nearby = mechanism.design

    def instant(t: float, state: Array) -> tuple[Pose, Solution, float, float]:
        nonlocal nearby
        beta1, spin, rack, beta1_rate, spin_rate, rack_rate = state[:6]
        acceleration = None
        if rack_motion is not None:
            rack, rack_rate, acceleration = rack_motion(t)
        pose = nearby = solve_pose(mechanism, beta1, rack, spin, nearby)
        twist = solve_twist(mechanism, pose, beta1_rate, spin_rate, rack_rate)
        now = {name: value(t) for name, value in inputs.items()}
        return pose, _solve(mechanism, pose, twist, now, acceleration), rack, rack_rate

    def derivative(t: float, state: Array) -> Array:
        _, solution, _, _ = instant(t, state)
        change = np.concatenate(
            (state[3:6], solution.coordinate_accelerations, [sum(solution.power.values())])
        )
        if rack_motion is not None:
            change[[2, 5]] = 0.0
        return change

    initial = np.array([*coordinates, *rates, 0.0])
    tolerance = rtol * np.array([1.0, 1.0, 0.01, 1.0, 1.0, 0.01, 100.0])
    result = solve_ivp(
        derivative,
        (times[0], times[-1]),
        initial,
        method="DOP853",
        t_eval=times,
        rtol=rtol,
        atol=tolerance,
    )
    if not result.success:
        raise RuntimeError(result.message)
    instants = [instant(t, state) for t, state in zip(times, result.y.T, strict=True)]
    rack_states = np.array([(rack, rate) for _, _, rack, rate in instants])
    return Trajectory(
        time=times,
        coordinates=np.column_stack((result.y[:2].T, rack_states[:, 0])),
        rates=np.column_stack((result.y[3:5].T, rack_states[:, 1])),
        work=result.y[6],
        poses=[pose for pose, _, _, _ in instants],
        solutions=[solution for _, solution, _, _ in instants],
    )


def _square(mechanism: Mechanism, pose: Pose) -> Array:
    """Return the joints' Jacobian with the rate rows below it, shape (36, 36)."""
    _, constraint = mechanism.joints.evaluate(pose)
    return np.vstack((constraint, rate_rows(mechanism, pose)))


def _jacobian(mechanism: Mechanism, pose: Pose) -> Array:
    """Return the twists for unit rates of the independent coordinates, shape (36, 3)."""
    return _solve_refined(_square(mechanism, pose), np.eye(36)[:, 33:])


def _inertia(mechanism: Mechanism, pose: Pose, twist: Array) -> tuple[Array, Array]:
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


def _slide_rate(mechanism: Mechanism, pose: Pose, twist: Array) -> float:
    """Return the rate of beta2, m/s: how fast knuckle and chassis approach along the strut."""
    arm = mechanism.point(pose, "strut_lower", KNUCKLE) - pose.position[KNUCKLE - 1]
    speed = twist[KNUCKLE - 1, :3] + np.cross(twist[KNUCKLE - 1, 3:], arm)
    span = pose.position[KNUCKLE - 1] + arm - mechanism.points["strut_top"]
    return float(-(span @ speed) / np.linalg.norm(span))


def _solve(
    mechanism: Mechanism,
    pose: Pose,
    twist: Array,
    inputs: Mapping[str, float],
    rack_acceleration: float | None,
) -> Solution:
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

    drive_force = 0.0
    power = {cause: float(np.sum(wrench * twist)) for cause, wrench in wrenches.items()}
    if rack_acceleration is not None:
        drive_force = float(-multipliers[-1])
        power["rack"] += drive_force * float(mechanism.rack_axis @ twist[RACK - 1, :3])

    given = mechanism.parameters
    seen = observe(mechanism, pose)
    height = pose.position[WHEEL - 1, 2] - inputs.get("road_height", 0.0)
    return Solution(
        coordinate_accelerations=coordinate_accelerations,
        twist=twist,
        acceleration=acceleration,
        multipliers=multipliers,
        rack_drive_force=drive_force,
        strut_slide_rate=_slide_rate(mechanism, pose, twist),
        kinetic_energy=float(0.5 * twist.ravel() @ mass @ twist.ravel()),
        potential_energy={
            "gravity": float(given["gravity"] * mechanism.masses @ pose.position[:, 2]),
            "spring": spring_energy(given, seen.spring_length),
            "bump_stop": stop_energy(given, "bump", seen.strut_length),
            "rebound_stop": stop_energy(given, "rebound", seen.strut_length),
            "tyre": 0.5 * given["tyre_rate"] * float(height - given["tyre_free_height"]) ** 2,
        },
        power=power,
    )


def _solve_refined(matrix: Array, right: Array) -> Array:
    """Solve a square system, with refinement by residuals in extended precision.

    Massless bodies leave the mass matrix singular, but the matrix of the equations of motion is
    not as long as the motions that the joints allow carry inertia. Where it is singular all the
    same, the solution of least norm is returned.
    """
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0], dtype=float)
    solution: Array = inverse @ right
    for _ in range(2):
        residual = right - matrix.astype(np.longdouble) @ solution.astype(np.longdouble)
        solution = solution + inverse @ residual.astype(float)
    return solution
