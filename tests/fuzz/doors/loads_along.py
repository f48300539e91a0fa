"""Loads along motions of all kinds and of rigid axles: equilibrium of parts with inertia.

A suspension with hardpoints, masses and rates beside those of the file is dropped or kicked over a
road, its rack moving. The loads that are listed on a part, its inertia among them, are summed
anew, about the origin; what the chassis carries is what acts from outside less the momentum of all
parts. Inertia itself is held against differences of velocities between outputs.
"""

import numpy as np
from kintrafo import Model, RigidAxle, RigidAxleModel, Suspension, loads, simulate

from ..attempts import WrongError

SHORT = 3
SECONDS = 60.0
CARS = {
    name: Suspension.load(name)
    for name in (
        "reference_car", "offset_strut_car", "double_wishbone_car", "push_rod_car",
        "pull_rod_car", "multi_link_car", "trailing_arm_car",
    )
}  # fmt: skip
RIGID = RigidAxle.load("rigid_axle")
# Outputs so far apart [s]: a difference of velocities over both sides errs by its square.
_BESIDE = 1e-5
# Sums of some tens of loads, each rounded to 1e-16 of joints that carry some 1e5 of themselves.
_CLOSE = 1e-9


def attempt(random):
    model, start, inputs = _drawn(random)
    middle = np.sort(random.uniform(0.01, 0.09, 4))
    times = np.unique(np.concatenate([middle - _BESIDE, middle, middle + _BESIDE]))
    motion = simulate(model, (0.0, 0.1), start, inputs=inputs, t_eval=times, rtol=1e-9, atol=1e-11)
    found = loads.along(model, motion)
    _check_sums(found)
    _check_inertia(model, motion, found, np.searchsorted(times, middle))


def _drawn(random):
    """Return what moves, from where, and its inputs."""
    if random.random() < 0.2:
        model = RigidAxleModel(RIGID.with_changes({"bodies.beam.mass_kg": random.uniform(20, 90)}))
        start = np.array(model.design_state)
        half = start.size // 2
        start[:2] += random.uniform(-0.02, 0.02, 2)
        start[half:] += random.normal(size=half) * [0.3, 0.3, 30.0, 30.0]
        return model, start, {"left_road_height": _road(random)}
    car = CARS[random.choice(list(CARS))]
    changes = {
        f"hardpoints.{name}": (
            np.array(getattr(car.hardpoints, name)) + random.uniform(-5.0, 5.0, 3)
        ).tolist()
        for name in car.hardpoints.given()
        if random.random() < 0.2
    }
    if random.random() < 0.5:
        changes["bodies.wheel.mass_kg"] = float(random.uniform(5.0, 60.0))
    # equations whose rack has a mass are those of struts
    free = car.suspension == "macpherson" and random.random() < 0.5
    if free:
        changes |= {"bodies.rack.mass_kg": float(random.uniform(1.0, 9.0))}
    model = Model(car.with_changes(changes), free_rack=free)
    start = np.array(model.design_state)
    half = start.size // 2
    start[0] += random.uniform(-0.05, 0.05)
    start[half:] += random.normal(size=half) * 10.0 ** random.uniform(-1.0, 0.5)
    inputs = {"road_height": _road(random)}
    if car.steered() and not free:
        inputs["rack_position"] = _road(random)
    elif free:
        push = random.normal() * 300.0
        inputs["rack_force"] = lambda t: push * np.sin(40.0 * t)
    return model, start, inputs


def _road(random):
    size, pace = random.uniform(0.0, 0.01), random.uniform(5.0, 60.0)
    return lambda t: size * np.sin(pace * t) ** 2


def _check_sums(found):
    force, at = found["force"].values, found["at"].values
    moment = found["moment"].values + np.cross(at, force)
    largest = float(np.abs(force).max() + np.abs(moment).max())
    by = [str(name) for name in found["by"].values]
    outside = np.array([n.startswith(("gravity", "inertia", "road", "input")) for n in by])
    for part in np.unique(found["part"].values):
        own = (found["part"] == part).values
        left = np.concatenate([force[:, own].sum(1), moment[:, own].sum(1)], axis=-1)
        if part == "chassis":
            acting = outside & (found["part"] != "chassis").values
            both = [force[:, acting].sum(1), moment[:, acting].sum(1)]
            left = left - np.concatenate(both, axis=-1)
        if not np.abs(left).max() <= _CLOSE * largest:
            raise WrongError(f"{part} has {np.abs(left).max()} left, of {largest}")


def _check_inertia(model, motion, found, which):
    """Hold the inertia of each part against differences of the velocity of its centre of mass."""
    velocities = model.evaluate("velocities", motion.y.T, motion.inputs)[..., 3:]
    rates = (velocities[which + 1] - velocities[which - 1]) / (2.0 * _BESIDE)
    own = np.flatnonzero((found["by"] == "inertia").values)
    names = {"wheel_left": "left_wheel", "wheel_right": "right_wheel"}
    for load in own:
        part = str(found["part"].values[load])
        body = model.equations.BODIES.index(names.get(part, part))
        masses = model.parameters
        mass = masses.get(f"{part}_mass", masses.get(f"{names.get(part, part)}_mass"))
        mass = masses["wheel_mass"] if mass is None else mass
        expected = -mass * rates[:, body]
        here = found["force"].values[which, load]
        scale = mass * (10.0 + np.abs(rates[:, body]).max())
        # a stop that begins to act between the outputs, or friction, leaves one of them out
        off = np.sort(np.abs(here - expected).max(axis=-1) / scale)
        if not off[1] <= 1e-4:
            raise WrongError(f"inertia of {part}: {here}, by differences {expected}")
