"""The search for a stable state of rest of equations of motion, with any number of coordinates.

At rest the generalised forces of the coordinates that move the wheels are zero, and restoring
nearby. `nearest` searches the whole range of one coordinate, `settled` starts from a nearby
position with any number of them.

The search of load cases (`analysis.loads.static_equilibrium`) has other forces: virtual work of the
loads on the wheels, for many cases on one grid, down to a known rounding. Here any input of the
equations acts (actuators, roads, forces of a program), and the range of one wheel is also searched
for two roots within one step of the grid. `kintrafo.rest` has constant inputs; here the road under
a wheel with a given load follows the wheel, and an unstable state is no solution.
"""

from collections.abc import Callable

import numpy as np

from ...core.named_types import Array, ArrayLike
from ...equations.errors import ModelError
from ..models.positions import road_below
from ..models.reach import AngleRange, PositionError, refuse_beyond
from .assembly import Assembly
from .rig import RestConditions

Forces = Callable[[ArrayLike], Array]

# Step of the grid on which an equilibrium of one coordinate is searched [rad].
_STEP = np.deg2rad(0.5)
_EPSILON = float(np.finfo(np.float64).eps)
# Residual forces at rest, over the stiffness times a metre or a radian.
_AT_REST = 1e-9


def at(assembly: Assembly, held: RestConditions, coordinates: ArrayLike) -> tuple[Array, Array]:
    """Return states and inputs at rest, (..., states) and (..., inputs).

    `coordinates` are values of `Assembly.coordinates`.
    """
    model = assembly.model
    states, inputs = assembly.at_rest(np.asarray(coordinates, dtype=float), held.rack)
    for i, wheel in enumerate(assembly.wheels):
        names = assembly.names_of(wheel)
        road = inputs[..., model.input_names.index(names.road)]
        if wheel in held.loads:
            height = model.signal(f"{names.signals}wheel_center_z", states, inputs)
            road[...] = road_below(height, assembly.tyres[i], held.loads[wheel])
        else:
            road[...] = held.roads.get(wheel, 0.0)
        inputs[..., model.input_names.index(names.actuator)] = held.actuators.get(wheel, 0.0)
    for name, value in held.inputs.items():
        inputs[..., model.input_names.index(name)] = value
    return states, inputs


def forces_of(assembly: Assembly, held: RestConditions) -> Forces:
    """Return the function of the coordinates at rest that yields their generalised forces."""
    model = assembly.model
    rows = [model.state_names.index(name) for name in assembly.coordinates]

    def forces(coordinates: ArrayLike) -> Array:
        return model.evaluate("forces", *at(assembly, held, coordinates))[..., rows]

    return forces


def settled(assembly: Assembly, held: RestConditions, near: Array, message: str) -> Array:
    """Return the coordinates of a stable state of rest, searched from those in `near`.

    Raises `PositionError` with `message` if there is none, or if a length is beyond its limits in
    the file there.
    """
    from scipy.optimize import root  # noqa: PLC0415 (slow to import)

    forces = forces_of(assembly, held)
    try:
        found = np.asarray(root(forces, near, options={"xtol": 1e-14}).x)
        left, slopes = forces(found), _slopes(forces, found)
    except ModelError:
        raise PositionError(message) from None
    # forces are rounded to the stiffness times the rounding of a coordinate
    small = _AT_REST * max(float(np.abs(slopes).max()), 1.0)
    if not np.abs(left).max() <= small or not (np.linalg.eigvals(slopes).real < 0.0).all():
        raise PositionError(message)
    refuse_beyond(assembly.model, *at(assembly, held, found))
    return found


def _slopes(forces: Forces, coordinates: Array, step: float = 1e-6) -> Array:
    """Return the derivatives of the forces with respect to the coordinates."""
    columns = [
        forces(coordinates + d) - forces(coordinates - d) for d in step * np.eye(len(coordinates))
    ]
    return np.stack(columns, -1) / (2.0 * step)


def nearest(moment: Callable[[ArrayLike], Array], reach: AngleRange, design: float) -> float:
    """Return the arm angle nearest to design at which a moment is zero and restoring [rad].

    `moment` is the moment about the arm's hinge as a function of the arm angle, `reach` the
    searched range. Raises `PositionError` if there is none; the message has the moments at the
    ends.
    """
    from scipy.optimize import brentq  # noqa: PLC0415 (slow to import)

    low, high = reach.arm_angle
    grid = np.linspace(low, high, 1 + round(abs(high - low) / _STEP))
    grid, values = _with_dips(moment, grid, moment(grid))
    # from low to high wheel position the angle falls: a stable moment changes from minus to plus
    stable = np.flatnonzero((values[:-1] <= 0.0) & (values[1:] > 0.0))
    if stable.size == 0:
        message = (
            "no stable equilibrium between wheel heights "
            f"{reach.height[0] * 1e3:.1f} mm and {reach.height[1] * 1e3:.1f} mm: the moment about "
            f"the arm's hinge is {values[0]:.4g} N m at the lower and {values[-1]:.4g} N m at the "
            "upper end. Check the spring's rate and free state, tyre rate and free height, or the "
            "wheel load."
        )
        raise PositionError(message)
    closest = stable[np.argmin(np.abs(grid[stable] - design))]
    ends = float(grid[closest]), float(grid[closest + 1])
    return float(brentq(lambda a: float(moment(a)), *ends, xtol=1e-15, rtol=4 * _EPSILON))


def _with_dips(
    moment: Callable[[ArrayLike], Array], grid: Array, values: Array
) -> tuple[Array, Array]:
    """Return a grid and values with further points between two roots within one step.

    Two roots within a step leave no change of sign, but a minimum of the amount beside them.
    """
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 (slow to import)

    amounts = np.abs(values)
    lower = (amounts[1:-1] <= amounts[:-2]) & (amounts[1:-1] <= amounts[2:])
    signs = np.sign(values)
    same = (signs[1:-1] != 0.0) & (signs[:-2] == signs[1:-1]) & (signs[1:-1] == signs[2:])
    added = []
    for place in np.flatnonzero(lower & same):
        sign = np.sign(values[place])
        least = minimize_scalar(
            lambda a, sign=sign: float(sign * moment(a)),
            bounds=(min(grid[place], grid[place + 2]), max(grid[place], grid[place + 2])),
            method="bounded",
            options={"xatol": 1e-9},
        )
        if least.fun <= 0.0:
            added.append(float(least.x))
    falling = grid[0] > grid[-1]
    together = np.sort(np.concatenate((grid, added)))
    together = together[::-1] if falling else together
    return together, moment(together) if added else values
