"""Positions of all drawn points of a car in motion."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ....core.named_types import Array
from ....core.quantities import display_of, displayed
from ....core.vectors import cross, directions, unit_vector
from ....systems.skeleton import Skeleton
from ...analysis.run import MovingCar, Run
from ...corner.corner import UP

WIDTH = 0.62
"""Width of a wheel relative to its radius."""

LOOKED_AT = 0.45
"""Height of the middle of a view [m]."""

# The outline of a body: forward of the front axle and above the road, relative to the wheelbase,
# and its width relative to the track.
_OUTLINE = np.array([
    (0.30, 0.09, 0.76), (0.32, 0.22, 0.76), (0.22, 0.28, 0.80), (-0.10, 0.34, 0.82),
    (-0.34, 0.53, 0.62), (-0.82, 0.53, 0.62), (-1.12, 0.36, 0.80), (-1.30, 0.33, 0.76),
    (-1.32, 0.12, 0.76),
])  # fmt: skip
# The part of a body above a single wheel: forward of it and above the road, relative to its radius;
# and its sides, relative to the distance of the wheel from the middle.
_BLOCK = np.array([(1.5, 2.5), (1.5, 3.1), (-1.5, 3.1), (-1.5, 2.5)])
_BLOCK_SIDES = (1.0, 0.2)
# Distance of the drawn points of a road, and its length before the start and after the end [m].
_ALONG, _BEYOND = 0.05, 12.0


@dataclass(frozen=True)
class CarScene:
    """A car with w wheels in n positions, in the axes of the road [m]."""

    times: Array  # (n,) [s]
    # points of links, arms and other parts between body and wheels, (n, points, 3)
    parts: dict[str, Array]
    springs: list[Array]  # ends of springs and struts, (n, 2, 3)
    outline: Array  # outline of the body, on the left and on the right, (n, 2, points, 3)
    # centres of wheels; unit vectors along their axes, to the left, and across, (n, w, 3)
    centers: Array
    axes: Array
    spokes: Array
    radii: Array  # heights of the centres above the road at rest, (w,)
    # lowest points of wheels, and the forces of the road on them, (n, w, 3) [N]
    contacts: Array
    forces: Array
    places: Array  # positions of the reference point on the road, (n, 2)
    cones: Array  # (cones, 2)
    # the road under the left and the right wheels; empty for a level road, (m, 3)
    tracks: list[Array]
    words: list[str]  # numbers at each position, as text

    @property
    def has_body(self) -> bool:
        """Whether the scene shows a car with its body; it has none for an axle on a rig."""
        return bool(self.outline.size)

    @property
    def turns(self) -> bool:
        """Whether the path may be curved, unlike that along a road with heights."""
        return self.has_body and not self.tracks

    @property
    def size(self) -> float:
        """Half of the length that a view shows [m]."""
        if not self.has_body:
            return float(np.ptp(self.centers[0, :, 1]))
        around = self.outline[0].reshape(-1, 3)
        return float(max(0.5 * np.ptp(around[:, 0]), 0.9 * around[:, 2].max()))


def scene_of(run: Run, rows: NDArray[np.intp], *, cones: xr.Dataset | None = None) -> CarScene:
    """Return the scene of a simulation at some outputs."""
    car, motion = run.car, run.motion.isel(time=rows)
    states, inputs = run.states[rows], run.inputs[rows]
    skeleton = Skeleton(car.model)
    spinning = _spinning(car)
    hidden = {skeleton.ground, car.body, *(car.model.equations.BODIES[i] for i in spinning)}
    way = np.zeros(len(rows)) if run.way is None else run.way[rows]
    onward = way[:, None, None] * np.array([1.0, 0.0, 0.0])
    places = {name: at + onward for name, at in skeleton.places(states, inputs).items()}
    centers, axes, spokes = _wheels(car, spinning, states, inputs)
    if run.way is not None:
        spokes = _rolled(axes, spokes, way[:, None] / np.array(car.radii))
    centers = centers + onward
    contacts, forces = _forces(car, motion, centers, axes)

    def end(which: tuple[str, str]) -> Array:
        owner, point = which
        return places[owner][:, skeleton.bodies[owner].index(point)]

    pairs = [*skeleton.springs, *skeleton.guides]
    return CarScene(
        times=motion["time"].values,
        parts={name: at for name, at in places.items() if name not in hidden},
        springs=[np.stack([end(a), end(b)], axis=1) for a, b in pairs],
        outline=_outline(car, spinning, states, inputs) + onward[:, None],
        centers=centers,
        axes=axes,
        spokes=spokes,
        radii=np.array(car.radii),
        contacts=contacts,
        forces=forces,
        places=run.places[rows],
        cones=_beside(run, cones),
        tracks=_tracks(run, centers, rows),
        words=_words(motion),
    )


def _beside(run: Run, cones: xr.Dataset | None) -> Array:
    """Return the positions of cones relative to the start of the car, shape (cones, 2) [m]."""
    if cones is None:
        return np.zeros((0, 2))
    named = np.array([run.motion[name].values[0] for name in ("x", "y")])
    return np.stack([cones["x"], cones["y"]], axis=-1) - (named - run.places[0])


def _tracks(run: Run, centers: Array, rows: NDArray[np.intp]) -> list[Array]:
    """Return the road along the way of the wheels of each side; empty for a level road."""
    car, road = run.car, run.road
    if road is None:
        return []
    # a car that drives begins `lead` before the road; its heights are above `datum`
    before, datum = (road.lead, road.datum) if run.way is None else (0.0, 0.0)
    way = (run.places[:, 0] - run.places[0, 0] if run.way is None else run.way)[rows]
    at = centers[0] - way[0] * np.array([1.0, 0.0, 0.0])
    first, last = at[:, 0].min() - _BEYOND, at[:, 0].max() + way[-1] + _BEYOND
    along = np.arange(first, last, _ALONG)
    stations = road.spacing * np.arange(road.left.size)
    found = []
    for side, heights in (("left", road.left), ("right", road.right)):
        across = [y for wheel, y in zip(car.wheels, at[:, 1], strict=True) if wheel.endswith(side)]
        if across:
            z = np.interp(along - at[:, 0].max() - before, stations, heights - datum)
            y = np.full(along.size, float(np.mean(across)))
            found.append(np.stack([along, y, z], axis=-1))
    return found


def _spinning(car: MovingCar) -> list[int]:
    """Return the indices of the bodies that rotate with the spin angles of the wheels."""
    before = car.model.evaluate("orientations", car.model.design_state)
    changes = [np.abs(_turned(car, spin) - before).max(axis=(1, 2)) for spin in car.spins]
    return [int(change.argmax()) for change in changes]


def _turned(car: MovingCar, spin: str) -> Array:
    """Return the orientations at design with a wheel turned by a quarter, (bodies, 3, 3)."""
    state = car.model.design_state.copy()
    state[car.model.state_names.index(spin)] += 0.5 * np.pi
    return car.model.evaluate("orientations", state)


def _wheels(
    car: MovingCar, bodies: list[int], states: Array, inputs: Array
) -> tuple[Array, Array, Array]:
    """Return centres, axes and spokes of the wheels; axes from a quarter of a turn at design."""
    model = car.model
    design = model.evaluate("orientations", model.design_state)[bodies]
    axes = []
    for spin, body, start in zip(car.spins, bodies, design, strict=True):
        turn = _turned(car, spin)[body] @ start.T
        # the antisymmetric part of a quarter of a turn is the axis
        skew = 0.5 * (turn - turn.T)
        axis = start.T @ unit_vector(np.array([skew[2, 1], skew[0, 2], skew[1, 0]]))
        axes.append(np.sign(axis[1]) * axis)
    along = np.array(axes)
    across = directions(cross(along, UP))
    turned = model.evaluate("orientations", states, inputs)[:, bodies]
    return (
        model.evaluate("positions", states, inputs)[:, bodies],
        np.einsum("nwij,wj->nwi", turned, along),
        np.einsum("nwij,wj->nwi", turned, across),
    )


def _rolled(axes: Array, spokes: Array, angles: Array) -> Array:
    """Return spokes turned forward about the axes of their wheels, by (n, w) angles [rad]."""
    angles = angles[..., None]
    return np.cos(angles) * spokes + np.sin(angles) * cross(axes, spokes)


def _forces(car: MovingCar, motion: xr.Dataset, centers: Array, axes: Array) -> tuple[Array, Array]:
    """Return the lowest points of the wheels, and the forces of the road there."""
    forward = directions(cross(axes, UP))
    upward = cross(forward, axes)
    contacts = centers - np.array(car.radii)[:, None] * upward
    if not car.body:
        return contacts, np.zeros_like(contacts)
    if "fz" not in motion:
        # the force of a tyre is in the plane of the wheel, and acts at the height of the road
        contacts[..., 2] = _of_wheels(motion, "road")
        return contacts, _of_wheels(motion, "load")[..., None] * upward
    parts = [_of_wheels(motion, name)[..., None] for name in ("fx", "fy", "fz")]
    return contacts, parts[0] * forward + parts[1] * cross(UP, forward) + parts[2] * UP


def _of_wheels(motion: xr.Dataset, name: str) -> Array:
    """Return a variable of one or more wheels as (n, w)."""
    values = motion[name].transpose("time", ...).values
    return np.asarray(values, dtype=float).reshape(len(values), -1)


def _outline(car: MovingCar, spinning: list[int], states: Array, inputs: Array) -> Array:
    """Return the outline of the body on both sides; without points if there is no body."""
    if not car.body:
        return np.zeros((len(states), 2, 0, 3))
    model = car.model
    row = model.equations.BODIES.index(car.body)
    design = model.evaluate("positions", model.design_state)
    wheels = design[spinning]
    ground = float((wheels[:, 2] - car.radii).mean())
    if len(wheels) == 1:
        center, radius = wheels[0], car.radii[0]
        x, z = center[0] + radius * _BLOCK[:, 0], ground + radius * _BLOCK[:, 1]
        widths = [np.full(len(x), share * center[1]) for share in _BLOCK_SIDES]
        widths.sort(key=lambda y: -y[0])
    else:
        ends = [wheels[[name.startswith(end) for name in car.wheels], 0] for end in _ENDS]
        front, rear = (float(end.mean()) for end in ends)
        half = 0.5 * np.ptp(wheels[:, 1]) * _OUTLINE[:, 2]
        x = front + (front - rear) * _OUTLINE[:, 0]
        z = ground + (front - rear) * _OUTLINE[:, 1]
        widths = [half, -half]
    arms = np.array([np.stack([x, y, z], axis=-1) for y in widths]) - design[row]
    turned = model.evaluate("orientations", states, inputs)[:, row]
    centers = model.evaluate("positions", states, inputs)[:, row]
    return centers[:, None, None] + np.einsum("nij,skj->nski", turned, arms)


_ENDS = ("front", "rear")
_UNITS = {"deg": "°", "m/s^2": " m/s²"}
# Numbers shown with a motion, if it has them: words, and decimals.
_READ = {
    "speed": ("", 1),
    "lateral_acceleration": ("lateral ", 1),
    "steering_wheel_angle": ("steering wheel ", 0),
    "roll_angle": ("roll ", 1),
    "body_acceleration": ("body ", 1),
}


def _words(motion: xr.Dataset) -> list[str]:
    columns = []
    for name, (words, digits) in _READ.items():
        if name in motion:
            unit = _UNITS.get(unit := display_of(motion[name].attrs).units, f" {unit}")
            # without a negative zero, with the minus sign of typesetting
            texts = (f"{round(float(v), digits) + 0.0:.{digits}f}" for v in displayed(motion[name]))
            columns.append([f"{words}{text.replace('-', '−')}{unit}" for text in texts])
    return ["    ".join(row) for row in zip(*columns, strict=True)]
