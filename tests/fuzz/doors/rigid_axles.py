"""Rigid axles: rods and points moved, mirrored, swapped, in metres; computed positions.

Every position that comes back is measured: the lengths of the rods between the chassis and the
beam where the equations put it, axes that are orthonormal, and the heights that were asked for.
Loads that come back balance each other, and where they do not there is a reason.
"""

import numpy as np
from kintrafo import PositionError, RigidAxle, RigidAxleModel, characteristics, equilibrium, loads
from kintrafo.vehicle.assembly.by_wheel import flat

from ..attempts import WrongError

SHORT = 15
# Promised, as a part of the size; the file's own rounding is far less.
PROMISED = 1e-9
AXLE = RigidAxle.load("rigid_axle")
POINTS = ("wheel_center", "spring_top", "spring_seat", "damper_top", "damper_seat")


def attempt(random):
    axle = AXLE.with_changes(_changes(random))
    model = RigidAxleModel(axle)
    for _ in range(4):
        left, right = random.normal(size=2) * 10.0 ** random.uniform(-3.0, 0.0)
        part = model.farthest(left, right)
        if not 0.0 <= part <= 1.0:
            raise WrongError(f"{part} of the way to {left} m and {right} m")
        for share in (0.0, random.uniform(), 0.999):
            _check(model, share * part * left, share * part * right)
        if part < 0.99:
            try:
                model.states_at(left, right)
            except PositionError:
                continue
            raise WrongError(f"{left} m and {right} m, where {part} of the way is the most")
    curves = flat(characteristics.over(axle, "bump", [0.0]))
    if not np.isfinite(curves["axle_steer"]).all():
        raise WrongError(f"axle steer {curves['axle_steer'].values} at design")
    equilibrium(model)
    _check_loads(axle, random)


def _changes(random):
    """Change some points, each in one of the ways in which people do."""
    changes = {}
    names = [*AXLE.rods]
    for _ in range(random.integers(1, 4)):
        if random.random() < 0.7:
            name, end = random.choice(names), random.choice(["chassis", "axle"])
            place, here = f"rods.{name}.{end}", np.array(getattr(AXLE.rods[name], end))
        else:
            name = random.choice(POINTS)
            place, here = f"hardpoints.{name}", np.array(getattr(AXLE.hardpoints, name))
        other = AXLE.rods[random.choice(names)]
        beside = random.normal(size=3) * 10.0 ** random.uniform(-9.0, 1.5)
        changes[place] = [
            here + random.normal(size=3) * 10.0 ** random.uniform(0.0, 2.5),
            np.array(other.chassis) + beside,
            np.array(other.axle) + beside,
            here * random.choice([-1.0, 1.0], 3),
            here / 1000.0,
        ][random.integers(5)].tolist()
    if random.random() < 0.2:
        changes[f"rods.{random.choice(names)}"] = None
    if random.random() < 0.2:
        changes["rods.fifth"] = {
            end: (random.normal(size=3) * 500.0).tolist() for end in ("chassis", "axle")
        }
    if random.random() < 0.3:
        changes["damper.length_min_mm"] = float(random.uniform(100.0, 600.0))
    return changes


def _check(model, left, right):
    state, axle = model.states_at(left, right), model.axle
    place = model.equations.BODIES.index("beam")
    axes = model.evaluate("orientations", state)[place]
    gram = np.abs(axes @ axes.T - np.eye(3)).max()
    if not gram <= PROMISED:
        raise WrongError(f"axes are off by {gram}")
    com = axle.bodies.beam.centre_of_mass(axle.hardpoints)
    middle = model.evaluate("positions", state)[place]
    for name, (chassis, end) in axle.ends().items():
        length = np.linalg.norm(end - chassis)
        gap = np.linalg.norm(middle + axes @ (end - com) - chassis) - length
        if not abs(gap) <= PROMISED * max(length, 1.0):
            raise WrongError(f"{name} is {gap} m too long")
    for sign, travel in ((1.0, left), (-1.0, right)):
        hub = axle.center + sign * axle.half_track * np.array([0.0, 1.0, 0.0])
        height = (middle + axes @ (hub - com))[2]
        if not abs(height - axle.center[2] - travel) <= PROMISED:
            raise WrongError(f"{travel} m asked for, {height - axle.center[2]} m found")


def _check_loads(axle, random):
    cases = {f"case_{i}": {s: _forces(random) for s in ("left", "right")} for i in range(3)}
    found = loads.static(axle, cases, static_load=6000.0)
    for name in cases:
        here = found.sel(case=name)
        if str(here["reason"].values):
            if np.isfinite(here["force"]).any():
                raise WrongError(f"forces in {name}, which is not carried")
            continue
        largest = float(abs(here["force"]).max())
        for left in ("residual", "residual_moment", "holding_force"):
            # a missing force of 1e-7 N is looked for, whatever there is to carry
            if not float(abs(here[left]).max()) <= 1e-6 + PROMISED * largest:
                raise WrongError(f"{left} of {name}: {here[left].values}, of {largest} N")


def _forces(random):
    """Return what a case says of a wheel."""
    size = 10.0 ** random.uniform(-2.0, 1.0)
    case = {"contact_g": [*random.normal(size=2) * size, float(random.uniform(0.0, 2.0) * size)]}
    if random.random() < 0.2:
        case["contact_g"][2] = 0.0
        case["travel_mm"] = float(random.normal() * 100.0)
    if random.random() < 0.3:
        case["center_N"] = (random.normal(size=3) * 1e3 * size).tolist()
    return case
