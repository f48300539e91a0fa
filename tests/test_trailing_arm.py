"""The trailing arm by hand: Rodrigues' rotation about its hinge, moments about it at rest.

`test_mechanisms` compares its equations with maximal coordinates, like those of every model.
"""

import numpy as np
import pytest
from kintrafo import System
from kintrafo.generated import trailing_arm
from kintrafo.generator.mechanisms.trailing_arm import MODELS
from numpy.typing import NDArray

Array = NDArray[np.float64]

DEFAULTS = {p.name: p.default for p in MODELS[0].mechanism.parameters}
TURNS = np.linspace(-0.3, 0.3, 13)  # rad, positive with the wheel going up
# lengths of a metre through some tens of operations; angles of 1e-2 are differences of them
ROUNDING = 1e-14


def placed(**points: tuple[float, float, float]) -> dict[str, float]:
    """Return the default values with some points elsewhere."""
    at = {f"{n}_{a}": v for n, p in points.items() for a, v in zip("xyz", p, strict=True)}
    return DEFAULTS | at


def mirrored(values: dict[str, float]) -> dict[str, float]:
    """Return the left side of a car; its spin axis points to the left, too."""
    turned = [n for n in values if n.endswith(("_y", "_inertia_xy", "_inertia_yz"))]
    return values | {n: -values[n] for n in turned if n != "spin_axis_y"}


CARS = {
    "semi-trailing": DEFAULTS,
    "trailing": placed(arm_outer=(0.42, -0.62, 0.29), arm_inner=(0.42, -0.30, 0.29)),
    "inclined": placed(arm_outer=(0.40, -0.60, 0.33), arm_inner=(0.22, -0.20, 0.21)),
}
EACH_CAR = pytest.mark.parametrize("values", CARS.values(), ids=CARS)


def point(values: dict[str, float], name: str) -> Array:
    return np.array([values[f"{name}_{axis}"] for axis in "xyz"])


def hinge(values: dict[str, float]) -> tuple[Array, Array]:
    """Return a point of the hinge and the unit vector about which the wheel turns upwards."""
    outer, inner = point(values, "arm_outer"), point(values, "arm_inner")
    axis = (inner - outer) / np.linalg.norm(inner - outer)
    rises = np.cross(axis, point(values, "wheel_center") - outer)[2]
    return outer, axis * np.sign(rises)


def rotated(vector: Array, axis: Array, turn: float) -> Array:
    """Return a vector turned about a unit vector, by Rodrigues' formula."""
    along = axis * (axis @ vector)
    return along + (vector - along) * np.cos(turn) + np.cross(axis, vector) * np.sin(turn)


def carried(values: dict[str, float], place: Array, turn: float) -> Array:
    """Return where the arm has taken a place of the design position."""
    through, axis = hinge(values)
    return through + rotated(place - through, axis, turn)


def system(values: dict[str, float]) -> System:
    return System(trailing_arm, values)


def state(car: System, turn: float) -> Array:
    """Return a state at rest; the angle falls as the wheel rises."""
    return car.state(arm_angle=float(car.design_state[0]) - turn)


@EACH_CAR
def test_the_wheel_goes_round_the_hinge(values: dict[str, float]) -> None:
    car, (_, axis) = system(values), hinge(values)
    for turn in TURNS:
        found = car.signals(state(car, turn))
        center = carried(values, point(values, "wheel_center"), turn)
        spin = rotated(point(values, "spin_axis"), axis, turn)
        expected = {
            **{f"wheel_center_{a}": v for a, v in zip("xyz", center, strict=True)},
            "camber": np.arctan2(spin[2], spin[1]),  # right: the top of the wheel outboard
            "toe": np.arctan2(-spin[0], spin[1]),
            "steer": np.arctan2(-spin[0], spin[1]),
        }
        for element in ("spring", "damper"):
            seat = carried(values, point(values, f"{element}_seat"), turn)
            length = float(np.linalg.norm(point(values, f"{element}_top") - seat))
            expected[f"{element}_length"] = length
        for name, value in expected.items():
            assert float(found[name]) == pytest.approx(value, abs=ROUNDING), name


def test_a_hinge_across_the_car_changes_neither_camber_nor_toe() -> None:
    car = system(CARS["trailing"])
    found = car.signals(np.array([state(car, turn) for turn in TURNS]))
    for name in ("camber", "toe"):
        np.testing.assert_allclose(found[name], 0.0, atol=ROUNDING)


@EACH_CAR
def test_the_left_side_is_the_mirror_image(values: dict[str, float]) -> None:
    right, left = system(values), system(mirrored(values))
    assert right.design_state[0] == pytest.approx(left.design_state[0], abs=ROUNDING)
    states = np.array([state(right, turn) for turn in TURNS])
    one, two = right.signals(states), left.signals(states)
    for name, values_there in one.items():
        sign = -1.0 if name in ("wheel_center_y", "steer") else 1.0
        # forces are up to 1e5 N/m times a length, accelerations up to 1e2 m/s^2
        scale = max(1.0, float(np.abs(values_there).max()))
        np.testing.assert_allclose(
            sign * two[name], values_there, rtol=0.0, atol=1e-12 * scale, err_msg=name
        )


@EACH_CAR
def test_it_starts_from_rest_as_moments_about_the_hinge_say(values: dict[str, float]) -> None:
    """The bearing passes no moment about the spin axis: the wheel resists tilting only."""
    car, (through, axis) = system(values), hinge(values)
    names = ("xx", "yy", "zz", "xy", "xz", "yz")
    xx, yy, zz, xy, xz, yz = (values[f"arm_inertia_{n}"] for n in names)
    inertia = axis @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ axis
    masses = {"arm_com": values["arm_mass"], "wheel_center": values["wheel_mass"]}
    for name, mass in masses.items():
        inertia += mass * np.linalg.norm(np.cross(axis, point(values, name) - through)) ** 2
    share = axis @ point(values, "spin_axis") / np.linalg.norm(point(values, "spin_axis"))
    inertia += values["wheel_inertia_diametral"] * (1.0 - share**2)
    for turn in TURNS:
        center = carried(values, point(values, "wheel_center"), turn)
        seat = carried(values, point(values, "spring_seat"), turn)
        line = seat - point(values, "spring_top")
        length = np.linalg.norm(line)
        push = values["spring_rate"] * (values["spring_free_length"] - length) / length
        tyre = values["tyre_rate"] * (values["tyre_free_height"] - center[2])
        spin = rotated(point(values, "spin_axis"), axis, turn)
        radial = np.array([0.0, 0.0, 1.0]) - spin * spin[2]  # in the wheel plane, Eq. 24
        forces = [(seat, push * line), (center, tyre * radial / (1.0 - spin[2] ** 2))]
        for name, mass in masses.items():
            weight = np.array([0.0, 0.0, -mass * values["gravity"]])
            forces.append((carried(values, point(values, name), turn), weight))
        moments = [float(axis @ np.cross(at - through, force)) for at, force in forces]
        rates = car.evaluate("rhs", state(car, turn))
        # forces are of differences of lengths, a twentieth of them: some 20 epsilon, with a margin
        tolerance = 1e-13 * sum(map(abs, moments)) / inertia
        assert -rates[2] == pytest.approx(sum(moments) / inertia, abs=tolerance)
        # the wheel keeps its direction about the spin axis
        assert rates[3] == pytest.approx(-share * sum(moments) / inertia, abs=tolerance)
