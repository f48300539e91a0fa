"""Cars that come with kintrafo: they rest where their files say, and have the sources' facts.

No equations of a whole car are derived here: each corner is held, with its part of the weight.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import kintrafo
import numpy as np
import pytest
from kintrafo import Model
from kintrafo.vehicle.analysis.characteristics import over
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.data.starter import packaged_cars
from kintrafo.vehicle.models.car.car import center_of_gravity, masses

if TYPE_CHECKING:
    from kintrafo.vehicle.models.car import Car

CARS = [name for name in packaged_cars() if kintrafo.load(name).axles]
# How far from design a wheel rests on a body that is held [m]: the springs of FED-Alpha are those
# of its source, and others are said to carry their car.
FAR = {"fed_alpha": 0.01}


def loads(car: Car) -> dict[str, float]:
    """Return the load of a wheel of each axle, by the balance of moments at design [N]."""
    weight = 9.81 * sum(mass for mass, _ in masses(car))
    x = {end: float(car.wheel_centers[f"{end}_left"][0]) for end in car.axles}
    front = (center_of_gravity(car)[0] - x["rear"]) / (x["front"] - x["rear"])
    return {"front": 0.5 * weight * front, "rear": 0.5 * weight * (1.0 - front)}


@pytest.mark.parametrize("name", CARS)
def test_its_springs_and_tyres_carry_it(name: str) -> None:
    car = kintrafo.load(name)
    assembly = assembly_of(car)
    for end, load in loads(car).items():
        (wheel, *_) = checkup(assembly.held_parts[end]).wheels
        assert wheel.equilibrium is not None
        assert abs(wheel.equilibrium.travel) < FAR.get(name, 1e-3)
        assert wheel.equilibrium.signals["tyre_force"] == pytest.approx(
            load, rel=0.1 if name in FAR else 0.005
        )


@pytest.mark.parametrize("name", [n for n in CARS if n not in ("reference_vehicle", "driving_car")])
def test_its_tyres_leave_the_road_and_its_axles_pass_their_check(name: str) -> None:
    assembly = assembly_of(kintrafo.load(name))
    for part in assembly.held_parts.values():
        assert all(tyre.lifts_off for tyre in part.tyres)
        assert checkup(part).problems == ()


def test_the_bmw_has_the_mass_of_its_source() -> None:
    """All parts of Chrono's: chassis, rack, bars; of both sides spindle, arms, rod, rim, tyre."""
    front = 9.962477554 + 13.5 + 13.51 + 2.72 + 1.13 + 18.0 + 37.6
    rear = 14.705 + 5.813 + 23.965 + 19.45 + 6.0 + 15.4 + 37.6
    expected = 1442.1 + 9.072 + 4.0 * 5.0 + 2.0 * (front + rear)
    car = kintrafo.load("bmw_e90")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(expected, abs=0.01)


def test_fed_alpha_has_the_mass_of_its_source() -> None:
    side = 13.08 + 36.27 + 8.45 + 31.55 + 6.0 + 18.8 + 56.1
    expected = 5672.87 + 3.6814844109 + 1.605 + 2.0 * 15.02 + 4.0 * side
    car = kintrafo.load("fed_alpha")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(expected, abs=0.01)


def test_the_bmw_rolls_by_some_two_degrees_at_0_6_g() -> None:
    """By the linear formula of a body on two axles; its source cites 2.0 (SAE 2007-01-0817).

    The body turns about the line through the roll centres, on the roll stiffness of both axles and
    their tyres: (K - m g h) roll = m a h. Left out are unsprung masses, contacts that move as
    wheels lean, and the change of the roll centres: see benchmarks/steady_roll.py.
    """
    car = kintrafo.load("bmw_e90")
    body, gravity = car.described.body, 9.81
    stiffness, height = 0.0, 0.0
    part = {"front": 1.0 + car.com[0] / 2.75717, "rear": -car.com[0] / 2.75717}
    for end, axle in car.axles.items():
        found = over(axle, "roll", [0.0])
        stiffness += float(found["roll_stiffness_with_tyres"].values.ravel()[0])
        height += part[end] * float(found["roll_center_height"].values.ravel()[0])
    arm = float(car.com[2]) - height
    roll = body.mass_kg * 0.6 * gravity * arm / (stiffness - body.mass_kg * gravity * arm)
    assert np.rad2deg(roll) == pytest.approx(2.1, abs=0.01)


def test_the_formula_student_car_has_the_front_corner_of_the_tutorial() -> None:
    car = kintrafo.load("formula_student_car")
    assert car.axles["front"].right == kintrafo.load("formula_student")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(290.0, abs=1e-9)
    rear = over(Model(car.axles["rear"].right), "travel", [-0.03, 0.03])
    assert np.ptp(np.rad2deg(rear["toe"].values)) < 0.03
