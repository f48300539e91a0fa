"""Hardpoints of all kinds: nearly singular, signs, units, swapped; computed positions.

Every position that comes back is measured: the distances of hardpoints that belong to one body,
axes that are orthonormal, the height that was asked for, and lengths that the file allows.
"""

from itertools import combinations

import numpy as np
from kintrafo import Model, Suspension, equilibrium, state_at_height, travel_range
from kintrafo.vehicle.analysis.characteristics.datasets import over
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import PositionError

from ..attempts import WrongError

SHORT = 15
# Promised, as a part of the size; the file's own rounding is far less.
PROMISED = 1e-9
CARS = {
    name: Suspension.load(name)
    for name in (
        "reference_car",
        "offset_strut_car",
        "double_wishbone_car",
        "chrono_generic",
        "push_rod_car",
        "pull_rod_car",
        "multi_link_car",
        "trailing_arm_car",
    )
}
# Hardpoints whose distances no motion changes; the bearings stay where they are.
BODIES = {
    "macpherson": (
        ("arm_front", "arm_rear", "ball_joint"),
        ("ball_joint", "tie_rod_outer", "wheel_center", "strut_lower", "spring_seat"),
        ("tie_rod_outer", "tie_rod_inner"),
    ),
    "double_wishbone": (
        ("lower_arm_front", "lower_arm_rear", "lower_ball_joint", "spring_seat"),
        ("upper_arm_front", "upper_arm_rear", "upper_ball_joint"),
        ("lower_ball_joint", "upper_ball_joint", "tie_rod_outer", "wheel_center"),
        ("tie_rod_outer", "tie_rod_inner"),
    ),
}
for _rod, _arm in (("push_rod", "lower"), ("pull_rod", "upper")):
    _lower, _upper, _knuckle, _tie_rod = BODIES["double_wishbone"]
    BODIES[_rod] = (
        _lower[:3] + (f"{_rod}_outer",) * (_arm == "lower"),
        _upper + (f"{_rod}_outer",) * (_arm == "upper"),
        _knuckle,
        _tie_rod,
        (f"{_rod}_outer", f"{_rod}_inner"),
        ("rocker_front", "rocker_rear", f"{_rod}_inner", "spring_seat"),
    )
_LINKS = ("front_upper_link", "rear_upper_link", "front_lower_link", "rear_lower_link", "tie_rod")
BODIES["multi_link"] = (
    (*(f"{link}_outer" for link in _LINKS), "wheel_center", "damper_seat"),
    *((f"{link}_outer", f"{link}_inner") for link in _LINKS),
    ("rear_lower_link_outer", "rear_lower_link_inner", "spring_seat"),
)
BODIES["trailing_arm"] = (("arm_inner", "arm_outer", "wheel_center", "spring_seat", "damper_seat"),)


def attempt(random):
    car = _car(random)
    model = Model(car)
    rack = float(random.choice([0.0, 0.0, random.uniform(-0.06, 0.06)]))
    rack = rack if car.steered() else 0.0
    reach = travel_range(model, rack)
    low, high = reach.height
    parts = [0.0, 1.0, *random.uniform(size=3), 10.0 ** random.uniform(-12.0, -1.0)]
    for part in parts:
        height = min(max(low + part * (high - low), low), high)
        try:
            state = state_at_height(model, height, rack_position=rack)
        except PositionError:
            continue
        _check(model, state, rack, height)
    beyond = low - 10.0 ** random.uniform(-6.0, 0.0)
    try:
        state_at_height(model, beyond, rack_position=rack)
    except PositionError:
        pass
    else:
        raise WrongError(f"a height of {beyond} m, where the least is {low} m")
    if rack == 0.0:
        _characteristics(model, low, high)
    _check(model, equilibrium(model, rack_position=rack), rack, None)


def _car(random):
    """Change some hardpoints of a car, each in one of the ways in which people and attackers do."""
    car = CARS[random.choice(list(CARS))]
    names = car.hardpoints.given()
    changes = {}
    for name in random.choice(names, random.integers(1, 4), replace=False):
        one, two = (
            np.array(getattr(car.hardpoints, n)) for n in random.choice(names, 2, replace=False)
        )
        here = np.array(getattr(car.hardpoints, name))
        signs = random.choice([-1.0, 1.0], 3)
        # millimetres, down to far less than anybody measures
        beside = random.normal(size=3) * 10.0 ** random.uniform(-9.0, 1.5)
        place = [
            here + random.normal(size=3) * 10.0 ** random.uniform(0.0, 2.5),
            one + beside,
            one + random.uniform(-1.0, 2.0) * (two - one) + beside,
            here * signs,
            here / 1000.0,
            np.array([here[0], one[1], here[2]]),
        ][random.integers(6)]
        changes[f"hardpoints.{name}"] = place.tolist()
    if car.steered() and random.random() < 0.3:
        changes["rack.axis"] = random.normal(size=3).tolist()
    if car.suspension == "macpherson":
        changes["strut.length_max_mm"] = 5000.0
        if random.random() < 0.2:
            changes["strut.length_min_mm"] = random.uniform(50.0, 600.0)
    return car.with_changes(changes)


def _characteristics(model, low, high):
    """Ask for curves over the travel: they are those of positions that are measured above."""
    design = float(model.signal("wheel_center_z", model.design_state))
    span = np.clip(np.linspace(-0.05, 0.05, 3), low - design, high - design)
    curves = over(model, "travel", span)
    if not np.isfinite(curves["camber"]).all():
        raise WrongError(f"camber {curves['camber'].values} over {span} m of travel")


def _check(model, state, rack, height):
    steered = model.suspension.steered()
    inputs = model.inputs({"rack_position": rack} if steered else {})
    now = hardpoints(model, state, inputs)
    points = model.suspension.hardpoints
    names = [name for name in now if name in points.given()]
    size = max(float(np.linalg.norm(points.metres(name))) for name in names)
    if steered:
        moved = points.metres("tie_rod_inner") + rack * _unit(model.suspension.rack.axis)
        if np.abs(now["tie_rod_inner"] - moved).max() > PROMISED * size:
            raise WrongError(f"the rack is at {now['tie_rod_inner']} and not at {moved}")
    for body in BODIES[model.suspension.suspension]:
        for one, two in combinations([name for name in body if name in names], 2):
            gap = np.linalg.norm(now[one] - now[two]) - points.distance(one, two)
            if not abs(gap) <= PROMISED * size:
                raise WrongError(f"{one} and {two} have come {gap} m apart")
    axes = model.evaluate("orientations", state, inputs)
    gram = np.abs(axes @ axes.swapaxes(-1, -2) - np.eye(3)).max()
    if not gram <= PROMISED:
        raise WrongError(f"axes are off by {gram}")
    if height is not None and not abs(now["wheel_center"][2] - height) <= PROMISED * size:
        raise WrongError(f"{height} m asked for, {now['wheel_center'][2]} m found")
    if model.suspension.suspension == "macpherson":
        _check_strut(model, now)


def _check_strut(model, now):
    """See that the strut is as long as it may be, and has not gone through its own mount."""
    points, knuckle = model.suspension.hardpoints, "strut_lower"
    lower = now[knuckle] if points.strut_lower is not None else now["ball_joint"]
    length = float(np.linalg.norm(now["strut_top"] - lower))
    least = model.suspension.strut.length_min_mm
    if least is not None and length < 1e-3 * least - PROMISED:
        raise WrongError(f"a strut of {length} m, the least is {least} mm")
    if points.strut_lower is None:
        return
    # of the triangle of mount, lower end and ball joint, two sides and the angle are fixed: the
    # ball joint lies as far along the axis from the lower end as it did
    axis = _unit(points.metres("strut_top") - points.metres("strut_lower"))
    along = float((points.metres("ball_joint") - points.metres("strut_lower")) @ axis)
    upward = (now["strut_top"] - lower) / length
    found = float((now["ball_joint"] - lower) @ upward)
    if not abs(found - along) <= 1e-9 / min(length, 1.0):
        raise WrongError(f"the strut goes through its own mount: {found} m and not {along} m")


def _unit(vector):
    return np.array(vector) / np.linalg.norm(vector)
