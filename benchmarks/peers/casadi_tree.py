"""CasADi: minimal coordinates with a hand-written closed form, derivatives by CasADi's AD.

Three formulations, from plain to expert:

- ``lagrange``: kinetic energy body by body, M(q) and the bias by AD of it, M solved;
- ``routh``: the wheel's spin eliminated by hand (it is cyclic) and knuckle and wheel taken as one
  body; one derivative of one effective inertia is left;
- ``implicit``: as ``routh``, with the closure differentiated by hand in the strut frame as this
  project's generator does it, and AD only for the rate of the effective inertia.

Each comes with the prepared constants as run-time inputs and as literal numbers. Rack displacement,
actuator force and road height are zero and left out, which favours this peer.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from .case import Array, parameters
from .compiled import BUILD, Source
from .geometry import prepared

_LOADS = (
    "spring_rate",
    "damper_rate",
    "tyre_rate",
    "tyre_free_height",
    "gravity",
    "control_arm_mass",
    "knuckle_mass",
    "wheel_mass",
    "wheel_inertia_spin",
    "wheel_inertia_diametral",
)


def numbers() -> dict[str, Array]:
    """Return all constants of the model as arrays by name, SI units."""
    given = parameters()
    values = {name: np.asarray(value, dtype=float) for name, value in vars(prepared()).items()}
    values |= {name: np.asarray(given[name]) for name in _LOADS}
    free_length = given["strut_length_max"] - given["spring_free_slide"]
    values["spring_free_length"] = np.asarray(free_length)
    return {name: np.where(abs(value) < 1e-15, 0.0, value) for name, value in values.items()}


def expert_numbers() -> dict[str, Array]:
    """Return the constants of ``routh``: knuckle and wheel as one body, the arm as a pendulum."""
    n = {name: np.array(value) for name, value in numbers().items()}
    masses = n["knuckle_mass"], n["wheel_mass"]
    centres = n.pop("knuckle_com"), n["wheel"]
    axis = n["spin_axis"]
    across = n.pop("wheel_inertia_diametral") * (np.eye(3) - np.outer(axis, axis))
    carried = [
        tensor + mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        for tensor, mass, centre in zip(
            (n.pop("knuckle_inertia"), across), masses, centres, strict=True
        )
    ]
    arm = n.pop("arm_com")
    n["carried_mass"] = np.asarray(sum(masses))
    n["carried_moment"] = sum(m * c for m, c in zip(masses, centres, strict=True))
    n["carried_inertia"] = sum(carried)
    n["arm_moment"] = n["control_arm_mass"] * arm[1:]
    n["arm_inertia"] = np.asarray(
        n["arm_inertia"][0, 0] + n["control_arm_mass"] * (arm[1:] @ arm[1:])
    )
    for name in ("control_arm_mass", "knuckle_mass", "wheel_mass", "wheel_inertia_spin"):
        del n[name]
    n["tyre_free_height"] = n["tyre_free_height"] - n.pop("foot_height")
    return n


@dataclass(frozen=True)
class Model:
    """A CasADi function of the right-hand side.

    Attributes
    ----------
    function : casadi.Function
        (state, constants) to the state's derivative.
    constants : ndarray
        Values of the second argument; empty where they are literal.
    seconds : float
        Time to set it up.
    """

    function: ca.Function
    constants: Array
    seconds: float


def build(formulation: str, *, literal: bool) -> Model:
    """Set up one formulation.

    Parameters
    ----------
    formulation : {"lagrange", "routh", "implicit"}
        See the module's docstring.
    literal : bool
        Whether the constants are folded in as numbers.

    Returns
    -------
    Model
        State: beta1, spin, their rates.
    """
    begin = time.perf_counter()
    equations, source = FORMULATIONS[formulation]
    values = source()
    symbols, given = as_symbols(values)
    constants = SimpleNamespace(**(as_literals(values) if literal else given))
    state = ca.SX.sym("x", 4)
    out = ca.cse(ca.simplify(equations(constants, state)))
    inputs = ca.SX(0, 1) if literal else symbols
    name = f"casadi_{formulation}_{'literal' if literal else 'inputs'}"
    function = ca.Function(name, [state, inputs], [out], ["x", "p"], ["ode"])
    flat = np.concatenate([np.ravel(value, order="F") for value in values.values()])
    return Model(function, np.zeros(0) if literal else flat, time.perf_counter() - begin)


def as_literals(values: dict[str, Array]) -> dict[str, Any]:
    """Return the constants as CasADi numbers."""
    return {name: ca.SX(ca.sparsify(ca.DM(value))) for name, value in values.items()}


def as_symbols(values: dict[str, Array]) -> tuple[Any, dict[str, Any]]:
    """Return a vector of symbols and the constants made of it."""
    sizes = [int(np.size(value)) for value in values.values()]
    vector = ca.SX.sym("p", sum(sizes))
    parts = ca.vertsplit(vector, [0, *np.cumsum(sizes).tolist()])
    named = {}
    for (name, value), part in zip(values.items(), parts, strict=True):
        named[name] = ca.reshape(part, np.shape(value)[0], -1) if np.ndim(value) > 1 else part
        if name.endswith("inertia") and np.ndim(value) > 1:
            named[name] = ca.tril2symm(ca.tril(named[name]))
    return vector, named


def kinematics(c: Any, beta1: Any) -> SimpleNamespace:
    """Return the closed form: points and directions as functions of the arm angle."""
    ball = c.arm_radius * ca.vertcat(0, ca.sin(beta1), ca.cos(beta1))
    span = ball - c.strut_top
    length = ca.sqrt(ca.sumsqr(span))
    along = span / length
    reach = c.tie_rod_inner - ball - c.rod[0] * along
    axial = ca.dot(reach, along)
    side = reach - axial * along
    normal = ca.cross(along, reach)
    squared = ca.sumsqr(side)
    needed = (squared + axial**2 + c.rod[1] ** 2 - c.rod_length_squared) / (2 * c.rod[1])
    root = c.branch * ca.sqrt(squared - needed**2)
    across = (needed * side + root * normal) / squared
    frame = ca.horzcat(along, across, ca.cross(along, across))
    lever = ca.vertcat(0, ca.sin(beta1), ca.cos(beta1))
    rod = ca.vertcat(axial, needed, -root)
    return SimpleNamespace(ball=ball, length=length, frame=frame, lever=lever, rod=rod)


def turn_rate(frame: Any, rate: Any) -> Any:
    """Return the angular velocity, in the frame's own axes, from the frame's rate."""
    return ca.vertcat(
        ca.dot(frame[:, 2], rate[:, 1]),
        ca.dot(frame[:, 0], rate[:, 2]),
        ca.dot(frame[:, 1], rate[:, 0]),
    )


def _places(c: Any, k: SimpleNamespace) -> tuple[Any, Any, Any]:
    """Return the centres of mass of arm, knuckle and wheel."""
    turned = ca.cross(ca.DM([1, 0, 0]), k.lever)
    arm = c.arm_com[0] * ca.DM([1, 0, 0]) + c.arm_com[1] * k.lever + c.arm_com[2] * turned
    return arm, k.ball + k.frame @ c.knuckle_com, k.ball + k.frame @ c.wheel


def _applied(c: Any, k: SimpleNamespace, beta1: Any, rate: Any) -> Any:
    """Return the generalised force of all but the inertia on beta1."""
    arm, knuckle, wheel = _places(c, k)
    weight = (
        c.control_arm_mass * arm + c.knuckle_mass * knuckle + c.wheel_mass * wheel
    ) * c.gravity
    gravity = -ca.dot(c.up, ca.jacobian(weight, beta1))
    return gravity + _strut_and_tyre(c, k, beta1, rate, ca.dot(c.up, wheel) + c.foot_height)


def _strut_and_tyre(c: Any, k: SimpleNamespace, beta1: Any, rate: Any, height: Any) -> Any:
    growth = ca.jacobian(k.length, beta1)
    strut = c.spring_rate * (c.spring_free_length - k.length) - c.damper_rate * growth * rate
    axis = k.frame @ c.spin_axis
    tilt = ca.dot(c.up, axis)
    wheel_rate = ca.jacobian(k.ball + k.frame @ c.wheel, beta1)
    lift = ca.dot(c.up - tilt * axis, wheel_rate) / (1 - tilt**2)
    return growth * strut - c.tyre_rate * (height - c.tyre_free_height) * lift


def _frame_rate(frame: Any, beta1: Any, seed: Any) -> Any:
    return ca.reshape(ca.jtimes(ca.vec(frame), beta1, seed), 3, 3)


def _mass_matrix(c: Any, k: SimpleNamespace, beta1: Any) -> tuple[Any, Any]:
    """Return the first element of the mass matrix and the spin's share in the second, by AD."""
    masses = c.control_arm_mass, c.knuckle_mass, c.wheel_mass
    mass = c.arm_inertia[0, 0]
    for weight, place in zip(masses, _places(c, k), strict=True):
        mass += weight * ca.sumsqr(ca.jacobian(place, beta1))
    omega = turn_rate(k.frame, _frame_rate(k.frame, beta1, 1))
    own = ca.dot(omega, c.spin_axis)
    mass += ca.dot(omega, c.knuckle_inertia @ omega)
    mass += c.wheel_inertia_diametral * (ca.sumsqr(omega) - own**2)
    return mass + c.wheel_inertia_spin * own**2, own


def lagrange(c: Any, state: Any) -> Any:
    """Return the state's derivative by Lagrange's equations of the second kind."""
    beta1, rates = ca.SX.sym("beta1"), ca.SX.sym("rates", 2)
    k = kinematics(c, beta1)
    mass, own = _mass_matrix(c, k, beta1)
    shared = c.wheel_inertia_spin * own
    matrix = ca.vertcat(ca.horzcat(mass, shared), ca.horzcat(shared, c.wheel_inertia_spin))
    squared = rates[0] ** 2
    bias = ca.jacobian(ca.vertcat(0.5 * mass, shared), beta1) * squared
    force = ca.vertcat(_applied(c, k, beta1, rates[0]), 0)
    return _at(state, beta1, rates, _solve(matrix, force - bias))


def routh(c: Any, state: Any) -> Any:
    """Return the state's derivative with the cyclic spin eliminated by hand."""
    beta1, rates = ca.SX.sym("beta1"), ca.SX.sym("rates", 2)
    k = kinematics(c, beta1)
    omega = turn_rate(k.frame, _frame_rate(k.frame, beta1, 1))
    speed = k.frame.T @ ca.jacobian(k.ball, beta1)
    inertia = (
        c.arm_inertia
        + c.carried_mass * c.arm_radius**2
        + 2 * ca.dot(speed, ca.cross(omega, c.carried_moment))
        + ca.dot(omega, c.carried_inertia @ omega)
    )
    own = ca.dot(omega, c.spin_axis)
    turned = ca.cross(ca.DM([1, 0, 0]), k.lever)
    moment = c.carried_mass * k.ball + k.frame @ c.carried_moment
    moment += c.arm_moment[0] * k.lever + c.arm_moment[1] * turned
    height = ca.dot(c.up, k.ball + k.frame @ c.wheel)
    force = _strut_and_tyre(c, k, beta1, rates[0], height)
    force -= c.gravity * ca.jacobian(ca.dot(c.up, moment), beta1)
    squared = rates[0] ** 2
    swing = (force - 0.5 * ca.jacobian(inertia, beta1) * squared) / inertia
    spin = -own * swing - ca.jacobian(own, beta1) * squared
    return _at(state, beta1, rates, ca.vertcat(swing, spin))


def implicit(c: Any, state: Any) -> Any:
    """Return the state's derivative with the closure differentiated by hand."""
    k = kinematics(c, state[0])
    turned = ca.cross(ca.DM([1, 0, 0]), k.lever)
    values = ca.vertcat(-c.arm_radius * (k.frame.T @ turned), k.length, k.rod)
    shape = ca.SX.sym("shape", 7)
    inertia, omega = _effective_inertia(c, shape)
    own = ca.dot(omega, c.spin_axis)
    speed, rod = shape[:3], shape[4:]
    turning = omega * c.rod[0]
    end = speed + ca.vertcat(0, turning[2], -turning[1])
    pull = ca.SX.sym("pull", 3)  # second derivative of the ball joint, strut frame
    change = ca.vertcat(pull - ca.cross(omega, speed), speed[0], -end - ca.cross(omega, rod))
    rates = ca.jtimes(ca.vertcat(0.5 * inertia, own), shape, change)
    solved = [values, -(k.frame.T @ k.ball)]
    inertia, omega, own, rates = ca.substitute([inertia, omega, own, rates], [shape, pull], solved)
    force = _local_forces(c, k, values[:3], omega, state[2])
    arm = c.arm_moment[1] * k.lever - c.arm_moment[0] * turned
    force -= c.gravity * ca.dot(c.up, arm)
    squared = state[2] ** 2
    swing = (force - rates[0] * squared) / inertia
    return ca.vertcat(state[2:], swing, -own * swing - rates[1] * squared)


def _effective_inertia(c: Any, shape: Any) -> tuple[Any, Any]:
    """Return inertia and angular velocity for unit rate, of what the strut frame sees.

    The shape is the ball joint's velocity, the strut's length and the vector from the foot of the
    tie rod's outer end on the strut axis to its inner end.
    """
    speed, length, axial, needed, root = shape[:3], shape[3], shape[4], shape[5], -shape[6]
    second, third = -speed[2] / length, speed[1] / length
    d1, d2 = c.rod[0], c.rod[1]
    first = axial * (speed[0] - third * d2) - (d2 - needed) * (speed[1] + third * d1)
    first = (first - root * (speed[2] - second * d1)) / (root * d2)
    omega = ca.vertcat(first, second, third)
    inertia = (
        c.arm_inertia
        + c.carried_mass * c.arm_radius**2
        + 2 * ca.dot(speed, ca.cross(omega, c.carried_moment))
        + ca.dot(omega, c.carried_inertia @ omega)
    )
    return inertia, omega


def _local_forces(c: Any, k: SimpleNamespace, speed: Any, omega: Any, rate: Any) -> Any:
    """Return the generalised force of strut, tyre and the knuckle's weight, strut frame."""
    up = k.frame.T @ c.up
    growth = speed[0]
    strut = c.spring_rate * (c.spring_free_length - k.length) - c.damper_rate * growth * rate
    tilt = ca.dot(up, c.spin_axis)
    wheel_rate = speed + ca.cross(omega, c.wheel)
    lift = ca.dot(up - tilt * c.spin_axis, wheel_rate) / (1 - tilt**2)
    height = ca.dot(c.up, k.ball) + ca.dot(up, c.wheel)
    weight = ca.dot(up, c.carried_mass * speed + ca.cross(omega, c.carried_moment))
    tyre = c.tyre_rate * (height - c.tyre_free_height)
    return growth * strut - tyre * lift - c.gravity * weight


def _solve(matrix: Any, right: Any) -> Any:
    """Solve two symmetric equations by hand."""
    determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] ** 2
    first = matrix[1, 1] * right[0] - matrix[0, 1] * right[1]
    second = matrix[0, 0] * right[1] - matrix[0, 1] * right[0]
    return ca.vertcat(first, second) / determinant


def _at(state: Any, beta1: Any, rates: Any, accelerations: Any) -> Any:
    """Return the state's derivative in terms of the state."""
    put = ca.substitute([accelerations], [beta1, rates], [state[0], state[2:]])[0]
    return ca.vertcat(state[2:], put)


FORMULATIONS: dict[str, tuple[Callable[[Any, Any], Any], Callable[[], dict[str, Array]]]] = {
    "lagrange": (lagrange, numbers),
    "routh": (routh, expert_numbers),
    "implicit": (implicit, expert_numbers),
}


def generated(function: ca.Function, *, with_derivatives: bool = False) -> tuple[Path, float]:
    """Write the C code of a function; return the file and the time it took, s."""
    begin = time.perf_counter()
    BUILD.mkdir(parents=True, exist_ok=True)
    generator = ca.CodeGenerator(f"{function.name()}.c", {"with_header": False})
    generator.add(function, with_derivatives)
    generator.generate(f"{BUILD}/")
    return BUILD / f"{function.name()}.c", time.perf_counter() - begin


def source(
    function: ca.Function, fed_back: slice, *, starts_with_beta1: bool
) -> tuple[Source, float]:
    """Return a function of (state, constants) as C with the adapter, and the time it took, s."""
    path, seconds = generated(function)
    name = function.name()
    adapter = f"""
KT_RHS(const double *p, const double *x, double *out) {{
    const double *arg[{function.sz_arg()}] = {{x, p}};
    double *res[{function.sz_res()}] = {{out}};
    double w[{max(1, function.sz_w())}];
    casadi_int iw[{max(1, function.sz_iw())}];
    {name}(arg, res, iw, w, 0);
}}
"""
    states, outputs = function.size1_in(0), function.size1_out(0)
    code = path.read_text() + adapter
    return Source(name, code, states, outputs, fed_back, is_derivative=starts_with_beta1), seconds
