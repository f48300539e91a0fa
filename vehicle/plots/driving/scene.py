"""Where everything is that is drawn of a car that drives."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ....core.vectors import cross, unit_vector
from ....systems.skeleton import Skeleton
from ...analysis.handling.car import DrivingCar, Run
from ...corner.corner import UP

Array = NDArray[np.float64]

WIDTH = 0.62
"""Width of a wheel, by its radius."""

# The outline of a body: forward of the front axle and above the road, by the wheelbase, and its
# width by the track.
_OUTLINE = np.array([
    (0.30, 0.09, 0.76), (0.32, 0.22, 0.76), (0.22, 0.28, 0.80), (-0.10, 0.34, 0.82),
    (-0.34, 0.53, 0.62), (-0.82, 0.53, 0.62), (-1.12, 0.36, 0.80), (-1.30, 0.33, 0.76),
    (-1.32, 0.12, 0.76),
])  # fmt: skip


@dataclass(frozen=True)
class DrivingScene:
    """A car in n positions, in the axes of the road [m].

    Attributes
    ----------
    times : ndarray, shape (n,)
        [s]
    parts : dict of str to ndarray, shape (n, points, 3)
        Points of links, arms and other parts between body and wheels.
    springs : list of ndarray, shape (n, 2, 3)
        Ends of springs and struts.
    outline : ndarray, shape (n, 2, points, 3)
        Of the body, on the left and on the right.
    centers, axes, spokes : ndarray, shape (n, 4, 3)
        Centres of wheels; unit vectors along their axes, to the left, and across them, which turn
        with them.
    radii : ndarray, shape (4,)
        Heights of the centres above the road at rest.
    contacts, forces : ndarray, shape (n, 4, 3)
        Lowest points of wheels, and the forces of the road on them [N].
    places : ndarray, shape (n, 2)
        Of the reference point on the road.
    cones : ndarray, shape (cones, 2)
    words : list of str
        Speed, lateral acceleration and steering wheel angle.
    """

    times: Array
    parts: dict[str, Array]
    springs: list[Array]
    outline: Array
    centers: Array
    axes: Array
    spokes: Array
    radii: Array
    contacts: Array
    forces: Array
    places: Array
    cones: Array
    words: list[str]


def scene_of(run: Run, rows: NDArray[np.intp], *, cones: xr.Dataset | None = None) -> DrivingScene:
    """Return the scene of a simulation.

    Parameters
    ----------
    run : Run
    rows : ndarray of int
        Which of its outputs.
    cones : xarray.Dataset, optional
    """
    car, motion = run.car, run.motion.isel(time=rows)
    states, inputs = run.states[rows], run.inputs[rows]
    skeleton = Skeleton(car.model)
    places = skeleton.places(states, inputs)
    spinning = _spinning(car)
    centers, axes, spokes = _wheels(car, spinning, states, inputs)
    contacts, forces = _forces(car, motion, centers, axes)
    hidden = {skeleton.ground, car.motion.body, *(car.model.equations.BODIES[i] for i in spinning)}

    def end(which: tuple[str, str]) -> Array:
        owner, point = which
        return places[owner][:, skeleton.bodies[owner].index(point)]

    pairs = [*skeleton.springs, *skeleton.guides]
    named = np.stack([motion["x"].values, motion["y"].values], axis=-1)
    travelled = car.motion.of(states, car.model.evaluate("rhs", states, inputs))
    own = np.stack([travelled["x"], travelled["y"]], axis=-1)
    # a manoeuvre counts from its own place, such as its first cones
    beside = np.zeros((0, 2)) if cones is None else np.stack([cones["x"], cones["y"]], axis=-1)
    return DrivingScene(
        times=motion["time"].values,
        parts={name: at for name, at in places.items() if name not in hidden},
        springs=[np.stack([end(a), end(b)], axis=1) for a, b in pairs],
        outline=_outline(car, spinning, states, inputs),
        centers=centers,
        axes=axes,
        spokes=spokes,
        radii=np.array(car.radii),
        contacts=contacts,
        forces=forces,
        places=own,
        cones=beside - (named - own)[0],
        words=_words(motion),
    )


def _spinning(car: DrivingCar) -> list[int]:
    """Return the bodies that the spins turn, and nothing else does."""
    model = car.model
    before = model.evaluate("orientations", model.design_state)
    found = []
    for spin in car.spins:
        state = model.design_state.copy()
        state[model.state_names.index(spin)] += 0.5 * np.pi
        changed = np.abs(model.evaluate("orientations", state) - before).max(axis=(1, 2))
        found.append(int(changed.argmax()))
    return found


def _wheels(
    car: DrivingCar, bodies: list[int], states: Array, inputs: Array
) -> tuple[Array, Array, Array]:
    """Return centres, axes and spokes of the wheels.

    The axis is that about which a quarter of a turn moves the wheel at design.
    """
    model = car.model
    design = model.evaluate("orientations", model.design_state)[bodies]
    axes = []
    for spin, body, start in zip(car.spins, bodies, design, strict=True):
        state = model.design_state.copy()
        state[model.state_names.index(spin)] += 0.5 * np.pi
        turn = model.evaluate("orientations", state)[body] @ start.T
        # of a quarter of a turn the antisymmetric part is the axis itself
        skew = 0.5 * (turn - turn.T)
        axis = start.T @ unit_vector(np.array([skew[2, 1], skew[0, 2], skew[1, 0]]))
        axes.append(np.sign(axis[1]) * axis)
    along = np.array(axes)
    across = cross(along, UP)
    across /= np.linalg.norm(across, axis=-1, keepdims=True)
    turned = model.evaluate("orientations", states, inputs)[:, bodies]
    centers = model.evaluate("positions", states, inputs)[:, bodies]
    return (
        centers,
        np.einsum("nwij,wj->nwi", turned, along),
        np.einsum("nwij,wj->nwi", turned, across),
    )


def _forces(
    car: DrivingCar, motion: xr.Dataset, centers: Array, axes: Array
) -> tuple[Array, Array]:
    """Return the lowest points of the wheels, and the forces of the road there."""
    forward = cross(axes, UP)
    forward = forward / np.linalg.norm(forward, axis=-1, keepdims=True)
    down = cross(forward, axes)
    contacts = centers - np.array(car.radii)[:, None] * down
    parts = [motion[name].transpose("time", ...).values[..., None] for name in ("fx", "fy", "fz")]
    return contacts, parts[0] * forward + parts[1] * cross(UP, forward) + parts[2] * UP


def _outline(car: DrivingCar, spinning: list[int], states: Array, inputs: Array) -> Array:
    """Return the outline of the body on both sides."""
    model = car.model
    row = model.equations.BODIES.index(car.motion.body)
    design = model.evaluate("positions", model.design_state)
    wheels = design[spinning]
    front = wheels[:2, 0].mean()
    half = 0.5 * np.ptp(wheels[:, 1]) * _OUTLINE[:, 2]
    ground = float((wheels[:, 2] - car.radii).mean())
    x, z = front + car.wheelbase * _OUTLINE[:, 0], ground + car.wheelbase * _OUTLINE[:, 1]
    sides = [np.stack([x, y, z], axis=-1) for y in (half, -half)]
    arms = np.array(sides) - design[row]
    turned = model.evaluate("orientations", states, inputs)[:, row]
    centers = model.evaluate("positions", states, inputs)[:, row]
    found: Array = centers[:, None, None] + np.einsum("nij,skj->nski", turned, arms)
    return found


def _words(motion: xr.Dataset) -> list[str]:
    def of(name: str) -> Any:
        return motion[name].values

    rows = zip(
        3.6 * of("speed"), of("lateral_acceleration"), np.degrees(of("steering_wheel_angle")),
        np.degrees(of("roll_angle")), strict=True,
    )  # fmt: skip
    return [
        f"{_plain(v, 1)} km/h    lateral {_plain(a, 1)} m/s²    steering wheel {_plain(s, 0)}°"
        f"    roll {_plain(r, 1)}°"
        for v, a, s, r in rows
    ]


def _plain(value: float, digits: int) -> str:
    """Return a number without a negative zero, with the minus sign of typesetting."""
    return f"{round(float(value), digits) + 0.0:.{digits}f}".replace("-", "−")
