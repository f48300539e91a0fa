"""Axles with different sides, with and without a bar: curves and loads against single sides.

The sides are of one kind, mirror images or not, each with hardpoints of its own. A wheel in roll or
in bump is where a root finder puts a wheel carrier on rods of fixed lengths, which shares nothing
with the equations; the line through both wheel centres is inclined by the roll that was asked for.
Loads of an axle without a bar are those of each side alone, and with a bar all that are listed
balance each other on every part.
"""

import numpy as np
from cars.axles import BAR_OF_STRUTS
from kintrafo import Axle, Suspension, characteristics, loads
from kintrafo.vehicle.assembly import motions
from kintrafo.vehicle.assembly.by_wheel import flat
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from ..attempts import WrongError

SHORT = 3
SECONDS = 60.0
CARS = tuple(
    Suspension.load(name)
    for name in ("reference_car", "double_wishbone_car", "push_rod_car", "multi_link_car")
)
BAR = BAR_OF_STRUTS | {"link_on": "knuckle", "rate_Nm_per_deg": 30.0}
LINKS = ("front_upper_link", "rear_upper_link", "front_lower_link", "rear_lower_link")
# Positions of both programs are rounded by some 1e-12 of a metre and of a radian.
CLOSE = 1e-9


def attempt(random):
    car = CARS[random.integers(len(CARS))]
    right = moved(random, car)
    left = right.mirrored() if random.random() < 0.3 else moved(random, car).mirrored()
    bar = {"anti_roll_bar": BAR} if random.random() < 0.5 else {}
    axle = Axle.from_dict({"axle": car.vehicle.end or "front", "right": right, "left": left} | bar)
    rack = float(random.uniform(-0.01, 0.01))
    angle = float(np.deg2rad(random.uniform(-4.0, 4.0)))
    travels = [float(each[0]) for each in motions.opposite(axle, np.array([angle]), rack)]
    in_roll = flat(characteristics.over(axle, "roll", [angle], rack_position=rack))
    centers = [
        _check_wheel(side, in_roll, travel, rack)
        for side, travel in zip((left, right), travels, strict=True)
    ]
    design = left.hardpoints.metres("wheel_center") - right.hardpoints.metres("wheel_center")
    turned = _inclination(design) - _inclination(centers[0] - centers[1])
    if not abs(turned - angle) <= CLOSE:
        raise WrongError(f"the line is inclined by {turned} rad, and {angle} rad were asked for")
    travel = float(random.uniform(-0.03, 0.03))
    in_bump = flat(characteristics.over(axle, "bump", [travel], rack_position=rack))
    for side in (left, right):
        _check_wheel(side, in_bump, travel, rack)
    _check_loads(axle, random, rack)


def moved(random, car):
    """Return a car whose hardpoints are some millimetres beside."""
    size = 10.0 ** random.uniform(-1.0, 1.0)
    return car.with_changes(
        {
            f"hardpoints.{name}": (np.array(getattr(car.hardpoints, name))
                                   + random.uniform(-size, size, 3)).tolist()
            for name in car.hardpoints.given()
            if random.random() < 0.4 and not name.startswith("rocker")
        }
        | {"wheel.camber_deg": float(random.uniform(-2.0, 1.0)),
           "wheel.toe_deg": float(random.uniform(-0.5, 0.5))}
    )  # fmt: skip


def _inclination(line):
    return float(np.arcsin(line[2] / np.linalg.norm(line)))


# -- a wheel carrier on rods ----------------------------------------------------------------------


def _check_wheel(car, found, travel, rack):
    """Hold camber and toe against the wheel carrier on its rods; return its wheel centre."""
    center, axis = _carrier(car, travel, rack)
    s, side = car.vehicle.sign, car.vehicle.side
    n = s * axis
    expected = {"camber": np.arctan2(-n[2], s * n[1]), "toe": np.arctan2(n[0], s * n[1])}
    for name, value in expected.items():
        here = float(found[f"{name}_{side}"][0])
        if not abs(here - value) <= CLOSE:
            raise WrongError(f"{name} {here} of the {side} wheel at {travel} m, on rods {value}")
    return center


def _carrier(car, travel, rack):
    """Return wheel centre and spin axis where rods of fixed lengths have a carrier."""
    points = car.hardpoints
    at = {name: points.metres(name) for name in (*points.given(), *points.STAND_INS)}
    axis = np.array(car.rack.axis) / np.linalg.norm(car.rack.axis)
    rods, strut = _rods(car, at)
    wheel = at["wheel_center"]

    def left(x, part):
        turn = Rotation.from_rotvec(x[3:])

        def moved(point):
            return wheel + x[:3] + turn.apply(point - wheel)

        gaps = []
        for outer, inner in rods:
            end = at[inner] + (part * rack * axis if inner == "tie_rod_inner" else 0.0)
            design = np.linalg.norm(at[outer] - at[inner])
            gaps.append(np.linalg.norm(moved(at[outer]) - end) - design)
        if strut:
            low, along = at["strut_lower"], at["strut_top"] - at["strut_lower"]
            off = np.cross(at["strut_top"] - moved(low), turn.apply(along / np.linalg.norm(along)))
            gaps += list(turn.inv().apply(off)[np.argsort(np.abs(along))[:2]])
        return np.array([*gaps, x[2] - part * travel])

    place = np.zeros(6)
    for part in (0.25, 0.5, 0.75, 1.0):
        place = root(left, place, (part,), options={"xtol": 1e-14}).x
    if not np.abs(left(place, 1.0)).max() < 1e-11:
        raise WrongError(f"no carrier on rods at {travel} m, rack {rack} m, and the equations have")
    turn = Rotation.from_rotvec(place[3:])
    return wheel + place[:3], turn.apply(car.wheel.spin_axis(car.vehicle.sign))


def _rods(car, at):
    """Return the rods of a carrier by both ends, and whether it has a strut."""
    tie_rod = ("tie_rod_outer", "tie_rod_inner")
    if car.suspension == "multi_link":
        return [*((f"{link}_outer", f"{link}_inner") for link in LINKS), tie_rod], False
    arms = [(ball, bearing) for ball, both in car.hardpoints.ARMS.items() for bearing in both]
    if "strut_top" not in at:
        return [*arms, tie_rod], False
    return [*arms, tie_rod], True


# -- loads ----------------------------------------------------------------------------------------


def _check_loads(axle, random, rack):
    """Hold the loads against those of each side alone, and each other."""
    cases = {
        "case": {
            side: {
                "travel_mm": float(random.uniform(-15.0, 15.0)),
                "contact_N": [*(random.normal(size=2) * 2e3).tolist(), 0.0],
            }
            for side in ("left", "right")
        }
        | {"rack_mm": 1e3 * rack}
    }
    found = loads.static(axle, cases)
    force, at = found["force"].values[0], found["at"].values[0]
    moment = found["moment"].values[0] + np.cross(at, force)
    largest = float(np.abs(force).max())
    outside = np.isin(found["by"].values, ["gravity"])
    outside |= np.array([str(by).startswith(("road", "drive")) for by in found["by"].values])
    for part in np.unique(found["part"].values):
        own = (found["part"] == part).values
        left = np.array([force[own].sum(0), moment[own].sum(0)])
        if part == "chassis":
            left = left - [force[outside].sum(0), moment[outside].sum(0)]
        if not np.abs(left).max() <= CLOSE * largest:
            raise WrongError(f"{part} has {left} left, of {largest} N")
    totals, own = found["total_force"].values[0].sum(0), (found["part"] == "chassis").values
    if not np.abs(totals - force[own].sum(0)).max() <= CLOSE * largest:
        raise WrongError(f"mounts carry {totals} together, the chassis {force[own].sum(0)}")
    if axle.bar is None:
        for side, model in axle.models.items():
            alone = loads.static(model, {"case": cases["case"][side] | {"rack_mm": 1e3 * rack}})
            joint = "wheel at wheel_center by"
            one = next(i for i, n in enumerate(alone["load"].values) if str(n).startswith(joint))
            name = str(alone["load"].values[one]).replace("wheel at", f"wheel_{side} at")
            name = name.replace("wheel_center", f"wheel_center_{side}") + f"_{side}"
            here, there = found["force"].sel(load=name)[0], alone["force"][0, one]
            if not float(abs(here - there).max()) <= CLOSE * largest:
                raise WrongError(f"{name}: {here.values}, alone {there.values}")
