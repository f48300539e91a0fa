"""Multi-link suspensions of random hardpoints, held against a continuation in maximal coordinates.

The knuckle hangs on its five links and on the rod of the height sensor, whose lever is the arm that
swings: six rods, and the way goes from the design position by the rack, and then by the lever.
"""

from dataclasses import astuple, dataclass, field

import numpy as np
from kintrafo import Model, PositionError, Suspension, travel_range
from kintrafo.core.errors import InputError
from kintrafo.vehicle.models.model_batch import ModelBatch
from kintrafo.vehicle.models.positions import AngleRange, arm_angles, arm_angles_of_batch
from kintrafo.vehicle.models.reach import at_rest
from oracle.continuation import Followed, Poses, Rods

CAR = Suspension.load("multi_link_car")
LINKS = ("front_upper_link", "rear_upper_link", "front_lower_link", "rear_lower_link", "tie_rod")
# The height sensor: its lever, and how far its tip is above the wheel [m].
LEVER, ABOVE = 0.5, 1.0
# Poses are those of the continuation by so much: beside a dead point both are as exact as the root
# of their rounding. Arm angles [rad] that are nearer to the end of a way are not judged, and ways
# of the continuation that end later by more than the last count as refused.
SAME, BESIDE, LONGER = 1e-5, 1e-5, 0.02
# What ends the range of a model though its loops close: guards of other things than the links.
OTHER_ENDS = ("right angle", "lies along", "coincide", "flat", "mass matrix")


@dataclass
class Judged:
    """Counts of outcomes for many suspensions.

    Attributes
    ----------
    sets, positions
        Suspensions that have a range, and positions in it that were held against the continuation.
    wrong
        What contradicts it.
    short
        Ways that it follows farther than the range goes.
    in_batches
        Suspensions whose positions were found as those of a batch, too.
    """

    sets: int = 0
    positions: int = 0
    wrong: list[str] = field(default_factory=list)
    short: list[str] = field(default_factory=list)
    in_batches: int = 0

    def __add__(self, other):
        return Judged(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))


def some_cars(random, count):
    """Return suspensions whose hardpoints are off, by a few millimetres or by a hand's width."""
    names = CAR.hardpoints.given()
    found = []
    while len(found) < count:
        size = 10.0 ** random.uniform(0.5, 2.0)
        moved = [name for name in names if random.random() < 0.6]
        changes = {
            f"hardpoints.{name}": (
                np.array(getattr(CAR.hardpoints, name)) + random.normal(size=3) * size
            ).tolist()
            for name in moved
        }
        try:
            found.append(CAR.with_changes(changes))
            Model(found[-1])
        except InputError:  # such as links that do not hold the knuckle
            del found[len(found) - 1 :]
    return found


@dataclass(frozen=True)
class Asked:
    """The range of heights of a model, and angles at which its heights are within that range."""

    model: Model
    reach: AngleRange
    angles: np.ndarray
    wrong: list[str]


def judged(cars, rack, random):
    """Hold the positions of suspensions with the rack displaced against their continuation."""
    asked = [found for car in cars if (found := _asked(Model(car), rack, random)) is not None]
    if not asked:
        return Judged()
    ways = Ways([one.model.suspension for one in asked], rack)
    found = Judged(sets=len(asked))
    for k, one in enumerate(asked):
        found.wrong += one.wrong
        found += ways.compared(k, one.model, one.angles)
        found.short += ways.longer(k, one.model, one.reach)
    return found + _in_a_batch([one.model for one in asked], ways, rack, random)


def _asked(model, rack, random):
    """Ask for heights within the range, and for some beyond, which are to be refused."""
    try:
        reach = travel_range(model, rack)
    except PositionError:
        return None
    low, high = reach.height
    parts = np.concatenate([[0.0, 1.0], random.uniform(size=6)])
    angles = arm_angles(model, np.clip(low + parts * (high - low), low, high), rack)
    wrong = []
    for height in (low - 1e-6, low - 0.01, low - 0.06, high + 1e-6, high + 0.01, high + 0.06):
        try:
            arm_angles(model, height, rack)
        except PositionError:
            continue
        wrong.append(f"a height of {height} m is answered, the range is {low} m to {high} m")
    return Asked(model, reach, angles, wrong)


def _in_a_batch(models, ways, rack, random):
    """Hold the positions of all as one batch against the continuation."""
    values = {
        f"hardpoints.{name}.{axis}": np.array(
            [getattr(model.suspension.hardpoints, name)[i] for model in models]
        )
        for name in CAR.hardpoints.given()
        for i, axis in enumerate("xyz")
    }
    batch = ModelBatch(models[0].suspension, values, free_rack=False)
    found = Judged()
    for travel in random.uniform(-0.1, 0.1, 3):
        angles, met = arm_angles_of_batch(batch, np.array([travel]), np.array([rack]))
        met &= batch.valid
        for k in np.flatnonzero(met):
            found.wrong += ways.compared(int(k), models[k], angles[k]).wrong
        found.in_batches += int(met.sum())
    return found


class Ways:
    """The continuation of the knuckles, by the rack and then by the arm both ways.

    Parameters
    ----------
    cars : list of Suspension
    rack : float
        [m]
    """

    def __init__(self, cars, rack):
        count = len(cars)
        points = [car.hardpoints for car in cars]
        center = np.array([p.metres("wheel_center") for p in points])
        outer = _ends(points, "outer") - center[:, None]
        tip = center + np.array([0.0, 0.0, ABOVE])
        side = np.array([car.vehicle.sign for car in cars])
        hinge = tip - side[:, None] * np.array([0.0, LEVER, 0.0])
        inner = np.concatenate([_ends(points, "inner"), tip[:, None]], axis=1)
        outer = np.concatenate([outer, np.zeros((count, 1, 3))], axis=1)
        axis = np.array([car.rack.axis for car in cars])
        axis /= np.linalg.norm(axis, axis=1)[:, None]
        length = np.linalg.norm(outer + center[:, None] - inner, axis=-1)

        def rods(rack_at, angle_at):
            def ends(some, at):
                found = inner[some].copy()
                found[:, 4] += rack_at(at)[:, None] * axis[some]
                angle = angle_at(at)
                lever = np.stack([0.0 * angle, side[some] * np.cos(angle), -np.sin(angle)], axis=-1)
                found[:, 5] = hinge[some] + LEVER * lever
                return found

            none = np.empty((count, 0, 3))
            return Rods(outer, length, ends, none, lambda some, _: np.empty((some.size, 0)))

        start = Poses(center, np.broadcast_to(np.eye(3), (count, 3, 3)))
        everyone, whole = np.arange(count), np.full(count, rack)
        by_rack = Followed(rods(lambda at: at, lambda at: 0.0 * at), start, whole)
        self.arrived = by_rack.reached == rack
        begin = by_rack.at(everyone, by_rack.reached)
        swinging = rods(lambda at: 0.0 * at + rack, lambda at: at)
        ends = np.where(self.arrived, 0.5 * np.pi, 0.0)
        self._ways = {s: Followed(swinging, begin, s * ends) for s in (1.0, -1.0)}
        self._rack = rack

    def compared(self, k, model, angles):
        """Hold positions of a suspension at arm angles against its ways."""
        found = Judged(positions=len(angles))
        if not self.arrived[k]:
            found.wrong.append(f"{k}: the rack does not get to {self._rack} m")
            return found
        states, inputs = at_rest(model, angles, self._rack)
        turned = model.evaluate("orientations", states, inputs)
        turned = turned[:, model.equations.BODIES.index("knuckle")]
        for angle, rotation in zip(angles - model.design_state[0], turned, strict=True):
            way = self._ways[1.0 if angle >= 0.0 else -1.0]
            reached = abs(way.reached[k])
            if abs(angle) > reached - BESIDE:
                if abs(angle) > reached + BESIDE:
                    text = f"{k}: answered at {angle:.6g} rad, the way ends at {reached:.6g} rad"
                    found.wrong.append(text)
                continue
            pose = way.at(np.array([k]), np.array([angle]))
            off = float(np.abs(pose.rotation[0] - rotation).max())
            if off > SAME:
                found.wrong.append(f"{k}: at {angle:.6g} rad the knuckle is turned by {off:.3g}")
        return found

    def longer(self, k, model, reach):
        """Return how much farther than a range the ways go, if the links limit the range."""
        found = []
        limits = (reach.lower_limit, 1.0), (reach.upper_limit, -1.0)
        for (limit, sense), end in zip(limits, reach.arm_angle, strict=True):
            swung, farther = abs(end - model.design_state[0]), self.monotone(k, sense)
            if farther > swung + LONGER and not any(words in limit for words in OTHER_ENDS):
                found.append(f"{k}: {swung:.4f} rad and not {farther:.4f}: {limit[:80]}")
        return found

    def monotone(self, k, sense):
        """Return how far the arm swings until the wheel turns back, or the way ends [rad]."""
        places, heights = self._ways[sense].heights(k, np.zeros(3))
        places, first = np.unique(np.abs(places), return_index=True)
        against = np.flatnonzero(np.diff(sense * heights[first]) >= 0.0)
        return float(places[against[0]] if against.size else places[-1])


def _ends(points, which):
    return np.array([[p.metres(f"{link}_{which}") for link in LINKS] for p in points])
