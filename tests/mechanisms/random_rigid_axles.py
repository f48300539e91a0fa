"""Rigid axles of random rods, held against a continuation in maximal coordinates.

The beam hangs on its four rods, and its wheel centres are at given heights; a way goes straight
from the design position in the travels of the wheels.
"""

from dataclasses import dataclass, field

import numpy as np
from kintrafo import RigidAxle, RigidAxleModel
from kintrafo.core.errors import InputError
from oracle.continuation import Followed, Poses, Rods

AXLE = RigidAxle.load("rigid_axle")
# As for corners (`swinging`): poses, and parts of a way that are not judged.
SAME, BESIDE, LONGER = 1e-5, 1e-5, 0.02
# No way goes so far that the axle is inclined by 45 degrees [m].
FARTHEST = 0.5


@dataclass
class Judged:
    """Counts of many paths: compared ones, contradictions of the continuation, refused ones."""

    ways: int = 0
    positions: int = 0
    wrong: list[str] = field(default_factory=list)
    short: list[str] = field(default_factory=list)


def some_axles(random, count):
    """Return axles whose rods end a few millimetres, or a hand's width, from where they did."""
    found = []
    while len(found) < count:
        size = 10.0 ** random.uniform(0.5, 2.0)
        changes = {
            f"rods.{name}.{end}": (
                np.array(getattr(rod, end)) + random.normal(size=3) * size
            ).tolist()
            for name, rod in AXLE.rods.items()
            for end in ("chassis", "axle")
            if random.random() < 0.7
        }
        try:
            axle = AXLE.with_changes(changes)
            RigidAxleModel(axle)
        except InputError:  # such as rods that do not hold the axle
            continue
        found.append(axle)
    return found


def judged(axles, random):
    """Hold one random way of each axle against its continuation."""
    models = [RigidAxleModel(axle) for axle in axles]
    travels = random.uniform(-1.0, 1.0, (len(axles), 2))
    travels *= FARTHEST / np.abs(travels).max(axis=1)[:, None]
    parts = np.array(
        [model.farthest(*travel) for model, travel in zip(models, travels, strict=True)]
    )
    followed = _followed(axles, travels)
    found = Judged(ways=len(axles))
    for k, model in enumerate(models):
        if parts[k] > followed.reached[k] + BESIDE:
            text = f"{k}: {parts[k]:.6g} of the way is reported as reached, and the path ends at "
            found.wrong.append(f"{text}{followed.reached[k]:.6g}")
            continue
        if parts[k] < followed.reached[k] - LONGER:
            found.short.append(f"{k}: {parts[k]:.4g} and not {followed.reached[k]:.4g} of the way")
        shares = (1.0 - BESIDE) * parts[k] * random.uniform(size=6)
        states = model.states_at(*(shares * travels[k][:, None]))
        beams = model.evaluate("orientations", states)[:, model.equations.BODIES.index("beam")]
        for share, beam in zip(shares, beams, strict=True):
            pose = followed.at(np.array([k]), np.array([share]))
            off = float(np.abs(pose.rotation[0] - beam).max())
            found.positions += 1
            if off > SAME:
                found.wrong.append(
                    f"{k}: at {share:.6g} of the way the beam is turned by {off:.3g}"
                )
    return found


def _followed(axles, travels):
    """Follow the beams by their ways, which the parameter has from zero to one."""
    count = len(axles)
    center = np.array([axle.center for axle in axles])
    ends = [list(axle.ends().values()) for axle in axles]
    inner = np.array([[chassis for chassis, _ in rods] for rods in ends])
    outer = np.array([[on_axle for _, on_axle in rods] for rods in ends])
    wheels = np.array(
        [[axle.points(side)["wheel_center"] for side in ("left", "right")] for axle in axles]
    )

    def heights(some, at):
        return wheels[some, :, 2] + at[:, None] * travels[some]

    rods = Rods(
        outer - center[:, None],
        np.linalg.norm(outer - inner, axis=-1),
        lambda some, at: inner[some] + 0.0 * at[:, None, None],
        wheels - center[:, None],
        heights,
    )
    start = Poses(center, np.broadcast_to(np.eye(3), (count, 3, 3)))
    return Followed(rods, start, np.ones(count))
