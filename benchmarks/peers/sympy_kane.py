"""SymPy: KanesMethod on the spanning tree with dependent coordinates and speeds, printed to C.

The tree: the arm on its hinge; the strut on a universal joint (x, then z of the hinge frame), the
knuckle sliding and turning on it, the wheel spinning on the knuckle. The ball joint (three
equations) and the tie rod's length (one) make four of the six coordinates dependent. Mass matrix
and forcing vector are printed after common subexpression elimination; the six equations, which
KanesMethod leaves to the user, are solved by elimination with pivoting in C.
"""

import time
from types import SimpleNamespace
from typing import Any

import numpy as np
import sympy as sm
import sympy.physics.mechanics as me

from .casadi_tree import numbers
from .case import Array, Instant, car
from .compiled import Source
from .geometry import prepared, strut_frame

ACCELERATIONS = slice(6, 12)
"""Where the accelerations are in the output: beta1, spin, two angles, slide, turn."""

_SOLVE = """
static void kt_solve(double a[6][6], double *b) {
    for (int k = 0; k < 6; ++k) {
        int best = k;
        for (int i = k + 1; i < 6; ++i) if (fabs(a[i][k]) > fabs(a[best][k])) best = i;
        if (best != k) {
            for (int j = k; j < 6; ++j) {
                const double t = a[k][j]; a[k][j] = a[best][j]; a[best][j] = t;
            }
            const double t = b[k]; b[k] = b[best]; b[best] = t;
        }
        const double inverse = 1.0 / a[k][k];
        for (int i = k + 1; i < 6; ++i) {
            const double f = a[i][k] * inverse;
            for (int j = k + 1; j < 6; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (int i = 5; i >= 0; --i) {
        for (int j = i + 1; j < 6; ++j) b[i] -= a[i][j] * b[j];
        b[i] /= a[i][i];
    }
}
"""


def constants() -> Array:
    """Return the values of the model's parameters, flat."""
    return np.concatenate([np.ravel(value) for value in numbers().values()])


def build(*, literal: bool) -> tuple[Source, float, float]:
    """Derive the equations and print them.

    Parameters
    ----------
    literal : bool
        Whether the constants are folded in as numbers.

    Returns
    -------
    source : Source
        State: six coordinates, six speeds.
    derive_seconds, print_seconds : float
        Time of KanesMethod, and of elimination of common subexpressions and printing.
    """
    begin = time.perf_counter()
    values = numbers()
    symbols, given = _as_symbols(values)
    if literal:
        given = SimpleNamespace(**{name: _numeric(value) for name, value in values.items()})
    coordinates, speeds = me.dynamicsymbols("q:6"), me.dynamicsymbols("u:6")
    mass, forcing = _kane(given, coordinates, speeds)
    derived = time.perf_counter()
    states = sm.symbols("x:12")
    named = dict(zip([*coordinates, *speeds], states, strict=True))
    flat = [entry.xreplace(named) for entry in [*mass, *forcing]]
    code = _print(flat, () if literal else symbols, states)
    name = f"sympy_kane_{'literal' if literal else 'inputs'}"
    printed = time.perf_counter()
    source = Source(name, code, 12, 12, ACCELERATIONS, is_derivative=True)
    return source, derived - begin, printed - derived


def state(instant: Instant) -> Array:
    """Return this model's state from the oracle's pose and twist, shape (12,)."""
    c, hinge = prepared(), car().hinge
    knuckle = hinge @ instant.pose.rotation[1] @ hinge.T
    frame = knuckle @ _design_axes()
    along = frame[:, 1]
    first = np.arctan2(along[2], along[1])
    second = np.arcsin(-along[0])
    ball = c.arm_radius * np.array([0.0, np.sin(instant.state[0]), np.cos(instant.state[0])])
    length = np.linalg.norm(ball - c.strut_top)
    tree = _rotation_x(first) @ _rotation_z(second)
    turn = tree.T @ frame
    angle = np.arctan2(turn[0, 2], turn[2, 2])
    coordinates = np.array([*instant.state[:2], first, second, length, angle])
    omega = hinge @ instant.twist[1, 3:]
    axes = np.array([[1.0, 0.0, 0.0], _rotation_x(first)[:, 2], along]).T
    rates = np.linalg.solve(axes, omega)
    lever = np.array([0.0, np.cos(instant.state[0]), -np.sin(instant.state[0])])
    speed = along @ lever * c.arm_radius * instant.state[2]
    return np.array([*coordinates, *instant.state[2:], rates[0], rates[1], speed, rates[2]])


def _design_axes() -> Array:
    """Return the knuckle's axes at design, by columns in the hinge frame: y along the strut."""
    along, across, third = strut_frame() @ car().hinge.T
    return np.array([third, along, across]).T


def _rotation_x(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _rotation_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _numeric(value: Array) -> Any:
    if value.ndim:
        return np.vectorize(lambda x: sm.Float(x) if x else sm.S.Zero, otypes=[object])(value)
    return sm.Float(float(value)) if value else sm.S.Zero


def _as_symbols(values: dict[str, Array]) -> tuple[Any, SimpleNamespace]:
    """Return all parameters as a flat tuple of symbols and by name; inertias are symmetric."""
    flat = sm.symbols(f"p:{sum(value.size for value in values.values())}")
    named, at = {}, 0
    for name, value in values.items():
        part = np.array(flat[at : at + value.size], dtype=object).reshape(value.shape)
        at += value.size
        if value.ndim == 2:
            part = np.array([[part[max(i, j), min(i, j)] for j in range(3)] for i in range(3)])
        named[name] = part if value.ndim else part[()]
    return flat, SimpleNamespace(**named)


def _vector(frame: Any, components: Any) -> Any:
    return components[0] * frame.x + components[1] * frame.y + components[2] * frame.z


def _strut_vector(frame: Any, components: Any) -> Any:
    """Return a vector of the strut frame: along, across, third are y, z, x of the knuckle."""
    return components[0] * frame.y + components[1] * frame.z + components[2] * frame.x


def _frames(q: Any, u: Any) -> SimpleNamespace:
    world, arm, fork, strut, knuckle = (
        me.ReferenceFrame(name) for name in ("N", "A", "F", "S", "K")
    )
    # The lever is the arm's z axis, turned from the world's z towards y.
    arm.orient_axis(world, -world.x, q[0])
    arm.set_ang_vel(world, -u[0] * world.x)
    fork.orient_axis(world, world.x, q[2])
    fork.set_ang_vel(world, u[2] * world.x)
    strut.orient_axis(fork, fork.z, q[3])
    strut.set_ang_vel(fork, u[3] * fork.z)
    knuckle.orient_axis(strut, strut.y, q[5])
    knuckle.set_ang_vel(strut, u[5] * strut.y)
    return SimpleNamespace(world=world, arm=arm, strut=strut, knuckle=knuckle)


def _kane(c: SimpleNamespace, q: Any, u: Any) -> tuple[Any, Any]:
    """Return KanesMethod's mass matrix (6, 6) and forcing vector of the six speeds."""
    f = _frames(q, u)
    points, bodies, loads = _bodies(c, f, q, u)
    loop = points.ball - points.arm_ball
    rod = points.rod - _vector(f.world, c.tie_rod_inner)
    gaps = [*loop.to_matrix(f.world), (rod.dot(rod) - c.rod_length_squared) / 2]
    closing = points.ball_speed - points.arm_ball_speed
    closing_rates = [*closing.to_matrix(f.world), rod.dot(points.rod_speed)]
    kinematic = [a.diff(me.dynamicsymbols._t) - b for a, b in zip(q, u, strict=True)]  # noqa: SLF001 (time has no public name there)
    method = me.KanesMethod(
        f.world,
        q_ind=q[:2],
        u_ind=u[:2],
        kd_eqs=kinematic,
        q_dependent=q[2:],
        u_dependent=u[2:],
        configuration_constraints=gaps,
        velocity_constraints=closing_rates,
    )
    method.kanes_equations(bodies, loads)
    return method.mass_matrix, method.forcing


def _bodies(c: SimpleNamespace, f: SimpleNamespace, q: Any, u: Any) -> tuple[Any, Any, Any]:
    world, knuckle = f.world, f.knuckle
    origin = me.Point("O")
    origin.set_vel(world, 0)
    # The arm's axes: hinge, across (opposite sense), lever.
    arm_vector = c.arm_com[0] * f.arm.x - c.arm_com[2] * f.arm.y + c.arm_com[1] * f.arm.z
    arm_centre = origin.locatenew("Ac", arm_vector)
    arm_centre.v2pt_theory(origin, world, f.arm)
    arm_ball = origin.locatenew("Ab", c.arm_radius * f.arm.z)
    arm_ball.v2pt_theory(origin, world, f.arm)
    top = origin.locatenew("C", _vector(world, c.strut_top))
    top.set_vel(world, 0)
    ball = top.locatenew("B", q[4] * f.strut.y)
    turning = f.strut.ang_vel_in(world).cross(q[4] * f.strut.y)
    ball.set_vel(world, u[4] * f.strut.y + turning)
    centre, wheel, rod = (
        ball.locatenew(name, _strut_vector(knuckle, arm))
        for name, arm in (
            ("Kc", c.knuckle_com),
            ("G", c.wheel),
            ("D", [*c.rod, sm.S.Zero]),
        )
    )
    for point in (centre, wheel, rod):
        point.v2pt_theory(ball, world, knuckle)
    axis = _strut_vector(knuckle, c.spin_axis)
    bodies = _rigid_bodies(c, f, (arm_centre, centre, wheel), axis, u)
    points = SimpleNamespace(
        ball=ball.pos_from(origin),
        arm_ball=arm_ball.pos_from(origin),
        rod=rod.pos_from(origin),
        ball_speed=ball.vel(world),
        arm_ball_speed=arm_ball.vel(world),
        rod_speed=rod.vel(world),
    )
    loads = _loads(c, f, bodies, (ball, wheel, origin), axis, q, u)
    return points, bodies, loads


def _rigid_bodies(c: Any, f: Any, centres: Any, axis: Any, u: Any) -> list[Any]:
    """Return arm, knuckle and wheel.

    The wheel is a body of revolution: its frame need not turn by the spin angle, only its angular
    velocity must contain it. An own frame with the spin as a simple rotation would be equivalent.
    """
    arm, knuckle = f.arm, f.knuckle
    t, k = c.arm_inertia, c.knuckle_inertia
    tensor = me.inertia(arm, t[0, 0], t[2, 2], t[1, 1], -t[0, 2], -t[1, 2], t[0, 1])
    own = me.inertia(knuckle, k[2, 2], k[0, 0], k[1, 1], k[0, 2], k[0, 1], k[1, 2])
    wheel = me.ReferenceFrame("W")
    wheel.orient_dcm(knuckle, sm.eye(3))
    wheel.set_ang_vel(knuckle, u[1] * axis)
    across, spin = c.wheel_inertia_diametral, c.wheel_inertia_spin
    round_tensor = me.inertia(knuckle, across, across, across)
    round_tensor += (spin - across) * me.outer(axis, axis)
    return [
        me.RigidBody("arm", centres[0], arm, c.control_arm_mass, (tensor, centres[0])),
        me.RigidBody("knuckle", centres[1], knuckle, c.knuckle_mass, (own, centres[1])),
        me.RigidBody("wheel", centres[2], wheel, c.wheel_mass, (round_tensor, centres[2])),
    ]


def _loads(c: Any, f: Any, bodies: Any, points: Any, axis: Any, q: Any, u: Any) -> list[Any]:
    ball, wheel, origin = points
    up = _vector(f.world, c.up)
    loads = [(body.masscenter, -body.mass * c.gravity * up) for body in bodies]
    strut = c.spring_rate * (c.spring_free_length - q[4]) - c.damper_rate * u[4]
    loads.append((ball, strut * f.strut.y))
    tilt = up.dot(axis)
    height = c.foot_height + wheel.pos_from(origin).dot(up)
    pull = -c.tyre_rate * (height - c.tyre_free_height) / (1 - tilt**2)
    return [*loads, (wheel, pull * (up - tilt * axis))]


def _print(flat: list[Any], symbols: Any, states: Any) -> str:
    """Return C of mass matrix and forcing, solved."""
    shared, reduced = sm.cse(flat, symbols=sm.numbered_symbols("t"))
    lines = [f"const double {symbol} = p[{i}];" for i, symbol in enumerate(symbols)]
    lines += [f"const double {symbol} = x[{i}];" for i, symbol in enumerate(states)]
    lines += [f"const double {name} = {_c(value)};" for name, value in shared]
    lines += [f"a[{i // 6}][{i % 6}] = {_c(value)};" for i, value in enumerate(reduced[:36])]
    lines += [f"b[{i}] = {_c(value)};" for i, value in enumerate(reduced[36:])]
    body = "\n    ".join(lines)
    return f"""#include <math.h>
{_SOLVE}
KT_RHS(const double *p, const double *x, double *out) {{
    double a[6][6], b[6];
    {body}
    kt_solve(a, b);
    for (int i = 0; i < 6; ++i) {{ out[i] = x[6 + i]; out[6 + i] = b[i]; }}
}}
"""


def _c(expression: Any) -> str:
    """Return C without calls of pow for whole exponents."""
    products = expression.replace(
        lambda e: e.is_Pow and e.exp.is_Integer and 1 < e.exp < 5,
        lambda e: sm.Mul(*[e.base] * int(e.exp), evaluate=False),
    )
    return str(sm.ccode(products))
