"""Mechanisms of random dimensions, and where their paths lead: in maximal coordinates.

A path is followed from the design position in short steps, each along the tangent of all joints'
equations and corrected by Newton's method (`Follower`). Only the declaration is read. The least
singular value of those equations measures how regular a path is.
"""

from collections.abc import Callable
from dataclasses import astuple, dataclass

import numpy as np
from kintrafo.generator import Formulation, Prismatic, Revolute, Universal
from kintrafo.generator.mechanisms.chains import AXES, PLACES, SEVEN_HINGES
from kintrafo.generator.mechanisms.held_by_rods import MODELS
from oracle.constraints import perpendiculars, skew
from oracle.maximal import Motion, Oracle
from scipy.linalg import svd
from scipy.spatial.transform import Rotation
from support.placements import Placements

from mechanisms import iterated_loops
from mechanisms.every_closed_form import askew

STEP = 0.05
"""Longest step of a coordinate, rad or m."""

REGULAR = 2e-3
"""Least singular value of a regular position, of the greatest (lengths in its unit)."""

SINGULAR = 1e-5
"""The same of a position that no path passes: it may be that of two branches."""


class Follower:
    """A mechanism on its way along a path.

    All joints are made of three kinds of equations between a first body and a second: points meet,
    directions stay square, a point stays on a plane. A driven hinge keeps a direction of its first
    body square that turns with the coordinate, a driven guide has a plane that moves with it.

    Attributes
    ----------
    coordinates
        Of the independent and prescribed joints, in this order.
    motion
        Where all bodies are.
    least
        The least singular value of the equations so far, of the greatest.
    """

    def __init__(self, model, parameters):
        self._oracle = oracle = Oracle(model, parameters)
        self._centers = oracle.centers
        count = len(oracle.bodies)
        upright = np.broadcast_to(np.eye(3), (count, 3, 3))
        self.motion = Motion(oracle.centers.copy(), upright.copy(), np.zeros((count, 6)))
        self.least = np.inf
        self._points = []
        self._squares = []
        self._planes = []
        for joint in model.mechanism.joints:
            self._add(joint)
        self._driven = list(model.driven)
        start = [oracle.driven(self.motion, joint.name).value[0] for joint in self._driven]
        self.coordinates = self._design = np.array(start)
        for joint in self._driven:
            self._drive(joint)
        self._size = np.sqrt(np.mean(np.sum((self._centers - self._centers[0]) ** 2, axis=1)))

    def _add(self, joint):
        """Add what a joint holds."""
        oracle = self._oracle
        i, j = (oracle.index[body] for body in joint.bodies)
        if isinstance(joint, Prismatic):
            along, place = oracle.along(joint.direction), self._centers[j]
            x, y, z = np.eye(3)
            self._squares += [(i, j, *pair) for pair in ((x, y), (y, z), (z, x))]
            self._planes += [(i, j, place, v) for v in perpendiculars(along)]
            return
        at = joint.axis.through if isinstance(joint, Revolute) else joint.center
        self._points.append((i, j, oracle.place(at)))
        if isinstance(joint, Revolute):
            axis = oracle.axis(joint.axis)
            self._squares += [(i, j, v, axis) for v in perpendiculars(axis)]
        elif isinstance(joint, Universal):
            first = oracle.along(joint.first_axis)
            self._squares.append((i, j, first, np.cross(first, oracle.axis(joint.shaft))))

    def _drive(self, joint):
        """Add the equation of a driven joint, behind all others of its kind."""
        i, j = (self._oracle.index[body] for body in joint.bodies)
        if isinstance(joint, Prismatic):
            along = self._oracle.along(joint.direction)
            self._planes.append((i, j, self._centers[j], along))
        else:
            start, _ = perpendiculars(self._axis(joint))
            self._squares.append((i, j, np.cross(self._axis(joint), start), start))

    def _axis(self, joint):
        """Return the axis of a driven hinge, in the sense in which its angle counts."""
        axis = self._oracle.axis(joint.axis)
        if joint.angle_to is None:
            return axis
        reference = self._oracle.along(joint.angle_from)
        arm = self._oracle.place(joint.angle_to) - self._oracle.place(joint.axis.through)
        return axis * np.sign(axis @ np.cross(reference, arm))

    def go(self, to):
        """Go straight to other coordinates; return whether the whole way is regular."""
        start, part = self.coordinates, 0.0
        most = STEP / max(np.abs(to - start).max(), STEP)
        size = most
        while part < 1.0:
            target = min(1.0, part + size)
            there = self._step(start + target * (to - start))
            if there is None:
                size /= 2.0
                if size < 1e-3 * most:
                    return False
                continue
            self.motion, self.coordinates = there, start + target * (to - start)
            part, size = target, min(most, 2.0 * size)
            if self.least < SINGULAR:
                return False
        return True

    def _step(self, coordinates):
        """Return the position of other coordinates nearby, None where that is not near."""
        motion, first = self.motion, 0.0
        misfit, rows = self._equations(motion, coordinates)
        left, values, right = svd(rows, full_matrices=False)
        self.least = min(self.least, values[-1] / values[0])
        inverse = right.T @ (left.T / np.maximum(values, 1e-9 * values[0])[:, None])
        for i in range(30):
            correction = -inverse @ misfit
            length = float(np.abs(correction).max())
            first = length if i == 0 else first
            if first > 0.1 or (i > 0 and length > 0.2 * first + 1e-12):
                return None
            motion = self._moved(motion, correction)
            misfit = self._misfits(motion, coordinates)
            if length < 1e-12:
                return motion if np.abs(misfit).max() < 1e-11 else None
        return None

    def _misfits(self, motion, coordinates):
        return self._equations(motion, coordinates)[0]

    def _equations(self, motion, coordinates):
        """Return what a position leaves of the equations, and how that changes.

        Lengths are in units of the mechanism's.
        """
        x, turned, size = motion.position, motion.rotation, self._size
        squares, offsets = list(self._squares), np.zeros(len(self._planes))
        slides = [joint for joint in self._driven if isinstance(joint, Prismatic)]
        turns = [joint for joint in self._driven if not isinstance(joint, Prismatic)]
        for joint, start, now in zip(self._driven, self._design, coordinates, strict=True):
            if isinstance(joint, Prismatic):
                offsets[len(offsets) - len(slides) + slides.index(joint)] = now - start
            else:
                place = len(squares) - len(turns) + turns.index(joint)
                i, j, across, mark = squares[place]
                turn = Rotation.from_rotvec((now - start) * self._axis(joint))
                squares[place] = i, j, turn.apply(across), mark
        values, rows = [], []

        def row(i, j, *parts):
            line = np.zeros((len(x), 6))
            line[i, :3], line[i, 3:], line[j, :3], line[j, 3:] = parts
            rows.append(line[1:].ravel())

        for i, j, at in self._points:
            one, two = turned[i] @ (at - self._centers[i]), turned[j] @ (at - self._centers[j])
            values += list((x[j] + two - x[i] - one) / size)
            lines = np.zeros((3, len(x), 6))
            lines[:, i, :3], lines[:, i, 3:] = -np.eye(3), skew(one) / size
            lines[:, j, :3], lines[:, j, 3:] = np.eye(3), -skew(two) / size
            rows += list(lines[:, 1:].reshape(3, -1))
        for i, j, a, b in squares:
            one, two = turned[i] @ a, turned[j] @ b
            values.append(one @ two)
            turning = _cross(one, two)
            row(i, j, np.zeros(3), turning, np.zeros(3), -turning)
        for (i, j, at, normal), offset in zip(self._planes, offsets, strict=True):
            one, two = turned[i] @ (at - self._centers[i]), turned[j] @ (at - self._centers[j])
            n, way = turned[i] @ normal, x[j] + two - x[i] - one
            values.append((n @ way - offset) / size)
            turning = (_cross(n, way) - _cross(one, n)) / size
            row(i, j, -n, turning, n, _cross(two, n) / size)
        return np.array(values), np.array(rows)

    def _moved(self, motion, twists):
        """Return a position after small motions of all bodies but the ground."""
        moved = twists.reshape(-1, 6)
        position, rotation = motion.position.copy(), motion.rotation.copy()
        position[1:] += self._size * moved[:, :3]
        rotation[1:] = Rotation.from_rotvec(moved[:, 3:]).as_matrix() @ rotation[1:]
        return Motion(position, rotation, motion.twist)


def _cross(a, b):
    """Return the vector product of two vectors; NumPy's takes ten times as long."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


# -- mechanisms of random dimensions --------------------------------------------------------------


@dataclass(frozen=True)
class Family:
    """Mechanisms that differ by their dimensions.

    Attributes
    ----------
    title
        In a table.
    vary
        Draws the parameters that differ from the declared ones.
    reach
        How far each driven coordinate may go from its design position, rad or m.
    quick
        Whether it is soon derived.
    """

    title: str
    model: Formulation
    vary: Callable[[np.random.Generator], dict[str, float]]
    reach: tuple[float, ...]
    quick: bool = True

    def parameters(self, random):
        """Draw all parameters."""
        return {p.name: p.default for p in self.model.mechanism.parameters} | self.vary(random)

    def target(self, random):
        """Draw how far the driven coordinates go."""
        return np.array(self.reach) * random.uniform(-1.0, 1.0, len(self.reach))


def named(places):
    """Return the components of points or directions as parameters."""
    return {
        f"{n}_{a}": float(c) for n, at in places.items() for a, c in zip("xyz", at, strict=True)
    }


def _plane(names, size):
    """Draw pins anywhere in a square of the plane."""
    return lambda random: named({f"{n}_at": askew(*random.uniform(0.0, size, 2)) for n in names})


def _near(model, spread):
    """Draw pins of a planar mechanism not far from the declared ones, in the plane."""
    defaults = {p.name: p.default for p in model.mechanism.parameters}
    x, y = (np.array(askew(*e)) - askew(0.0, 0.0) for e in ((1.0, 0.0), (0.0, 1.0)))

    def vary(random):
        declared = {n: [defaults[f"{n}_at_{a}"] for a in "xyz"] for n in _pins(model)}
        moved = {
            f"{n}_at": at + np.array([x, y]).T @ random.uniform(-spread, spread, 2)
            for n, at in declared.items()
        }
        return named(moved)

    return vary


def _pins(model):
    return [joint.name for joint in model.mechanism.joints]


def _ring(count, spread):
    """Draw a ring of hinges not far from the declared one."""

    def vary(random):
        places = np.array(PLACES[:count]) + spread * random.uniform(-0.2, 0.2, (count, 3))
        axes = np.array(AXES[:count]) + spread * random.normal(size=(count, 3))
        return named({f"place_{i}": p for i, p in enumerate(places)}) | named(
            {f"axis_{i}": a for i, a in enumerate(axes)}
        )

    return vary


def _meeting(random):
    axes = random.normal(size=(4, 3))
    return named({f"axis_{i}": a for i, a in enumerate(axes)}) | named(
        {f"place_{i}": 0.2 * a / np.linalg.norm(a) for i, a in enumerate(axes)}
    )


def _bent(random):
    axes = iterated_loops.hooke_axes(random.uniform(-1.3, 1.3))
    return named({f"axis_{i}": a for i, a in enumerate(axes)}) | named(
        {f"place_{i}": 0.2 * np.array(a) for i, a in enumerate(axes)}
    )


def _bennett(random):
    twist, other = random.uniform(0.3, 1.5, 2)
    model = iterated_loops.bennett(0.3, twist, other, random.uniform(0.5, 2.5))
    wanted = ("place", "axis")
    return {p.name: p.default for p in model.mechanism.parameters if p.name.startswith(wanted)}


def _links(random):
    """Draw the hardpoints of a suspension, each within 30 mm."""
    defaults = {p.name: p.default for p in MODELS[0].mechanism.parameters}
    ends = ("_inner", "_outer", "_rear", "_front", "_joint")
    points = [n for n in defaults if n[-2:] in ("_x", "_y", "_z") and n[:-2].endswith(ends)]
    return {n: defaults[n] + random.uniform(-0.03, 0.03) for n in points}


FAMILIES = (
    Family(
        "planar four-bar driven at its knee",
        iterated_loops.FOUR_BAR_AT_ITS_KNEE,
        _plane(_pins(iterated_loops.FOUR_BAR_AT_ITS_KNEE), 0.4),
        (2.0 * np.pi,),
    ),
    Family(
        "Stephenson driven from its far side",
        iterated_loops.STEPHENSON,
        _plane(_pins(iterated_loops.STEPHENSON), 0.5),
        (np.pi,),
    ),
    Family(
        "two of them in a row",
        iterated_loops.IN_A_ROW,
        _near(iterated_loops.IN_A_ROW, 0.05),
        (0.8,),
        quick=False,
    ),
    Family(
        "planar 3-RRR",
        iterated_loops.THREE_RRR,
        _plane(_pins(iterated_loops.THREE_RRR), 0.5),
        (1.2,) * 3,
        quick=False,
    ),
    Family("Hooke joint of hinges", iterated_loops.HOOKE, _bent, (4.0 * np.pi,)),
    Family("spherical four-bar", iterated_loops.SPHERICAL, _meeting, (2.0 * np.pi,)),
    Family("Bennett", iterated_loops.BENNETT, _bennett, (2.0 * np.pi,)),
    Family("ball joint in a ring of hinges", iterated_loops.BALL_RING, _ring(5, 0.5), (np.pi,)),
    Family("ring of seven hinges", SEVEN_HINGES, _ring(7, 0.5), (np.pi,), quick=False),
    Family("carrier on three rods", MODELS[0], _links, (1.2, 0.0, 0.15), quick=False),
)


# -- positions on regular paths -------------------------------------------------------------------


@dataclass(frozen=True)
class Trial:
    """A position that a regular path reaches.

    Attributes
    ----------
    parameters
        Of the mechanism.
    coordinates
        Of the position, in the order of the independent and prescribed joints.
    motion
        Where the path leads.
    least
        The least singular value on the way, of the greatest.
    """

    parameters: dict[str, float]
    coordinates: np.ndarray
    motion: Motion
    least: float


def trials(family, random, along=4):
    """Yield positions on a straight path of a mechanism, as far as it is regular.

    Parameters
    ----------
    along
        How many there are on the whole way.
    """
    parameters = family.parameters(random)
    follower = Follower(family.model, parameters)
    start, target = follower.coordinates, family.target(random)
    for part in np.arange(1, along + 1) / along:
        if not follower.go(start + part * target):
            return
        yield Trial(parameters, follower.coordinates, follower.motion, follower.least)


@dataclass
class Judged:
    """Results at positions on paths.

    Attributes
    ----------
    mechanisms, reached
        Mechanisms that move, and positions that paths reach.
    regular, answered
        Positions on regular paths, and those of them that are answered.
    wrong
        Answers that are elsewhere than where the path leads, regular or not.
    """

    mechanisms: int = 0
    reached: int = 0
    regular: int = 0
    answered: int = 0
    wrong: int = 0

    def __add__(self, other):
        return Judged(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))


def judged(family, random):
    """Ask the emitted code for the positions on one path of one mechanism."""
    found = list(trials(family, random))
    if not found:
        return Judged()
    coordinates = np.array([trial.coordinates for trial in found])
    placements = Placements.of(family.model)
    answered, places, rotations = placements.at(found[0].parameters, coordinates)
    off = [
        max(
            np.abs(trial.motion.position[1:] - at).max(),
            np.abs(trial.motion.rotation[1:] - turned).max(),
        )
        for trial, at, turned in zip(found, places, rotations, strict=True)
    ]
    regular = np.array([trial.least > REGULAR for trial in found])
    # next to a dead point both are as exact as the root of their rounding
    wrong = answered & (np.array(off) > 1e-5)
    return Judged(
        1, len(found), int(regular.sum()), int((regular & answered).sum()), int(wrong.sum())
    )
