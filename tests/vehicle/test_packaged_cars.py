"""Cars that come with kintrafo: they rest where their files say, and have the sources' facts.

No equations of a whole car are derived here: each corner is held, with its part of the weight.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import Model
from kintrafo.systems.modes import modes_of_motions
from kintrafo.vehicle.analysis.characteristics import over
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.data import data_sets
from kintrafo.vehicle.data.starter import CARS as FILES
from kintrafo.vehicle.models.car.car import center_of_gravity, masses, suspension_masses

CARS = [name for name in data_sets(FILES) if kintrafo.load(name).axles]
# How far from design a wheel rests on a body that is held [m]: the springs of FED-Alpha are those
# of its source, and others are said to carry their car; the tyres of the driving car are 5 mm lower
# under the load than those that its axles' files have for cars that do not travel.
FAR = {"fed_alpha": 0.01, "driving_car": 0.006}


def loads(car):
    """Return the load of a wheel of each axle, by the balance of moments at design [N]."""
    weight = 9.81 * sum(mass for mass, _ in masses(car))
    x = {end: float(car.wheel_centers[f"{end}_left"][0]) for end in car.axles}
    front = (center_of_gravity(car)[0] - x["rear"]) / (x["front"] - x["rear"])
    return {"front": 0.5 * weight * front, "rear": 0.5 * weight * (1.0 - front)}


@pytest.mark.parametrize("name", CARS)
def test_its_springs_and_tyres_carry_it(name):
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
def test_its_tyres_leave_the_road_and_its_axles_pass_their_check(name):
    assembly = assembly_of(kintrafo.load(name))
    for part in assembly.held_parts.values():
        assert all(tyre.lifts_off for tyre in part.tyres)
        assert checkup(part).problems == ()


@pytest.mark.parametrize("name", CARS)
def test_its_modes_keep_their_names_while_its_damping_grows(name):
    """The modes are those of a body on four sprung masses, with masses and rates of the car."""
    car = kintrafo.load(name)
    body, axles = car.described.body, suspension_masses(car)
    places = np.array([car.wheel_centers[wheel] - car.com for wheel in car.wheels])
    on_body = np.stack([np.ones(4), -places[:, 0], places[:, 1]], axis=1)
    inertia = body.elements()
    mass = np.array([body.mass_kg, inertia["yy"], inertia["xx"], *np.repeat(0.5, 4)])
    mass[3:] *= np.repeat([axles[end] for end in car.axles], 2)
    springs = [over(Model(car.axles[e].right), "travel", [0.0])["wheel_rate"] for e in car.axles]
    rates = np.repeat([float(rate.values.ravel()[0]) for rate in springs], 2)
    tyres = np.repeat([car.axles[e].right.tyre.rate_N_per_m for e in car.axles], 2)
    stretched = np.hstack([on_body, -np.eye(4)])  # springs by coordinates
    stiffness = stretched.T @ np.diag(rates) @ stretched + np.diag([0.0, 0.0, 0.0, *tyres])
    halves = np.kron(np.eye(2), [[0.5, 0.5], [0.5, -0.5]])
    motions = np.zeros((7, 14))
    motions[:3, :3], motions[3:, 3:7] = np.eye(3), halves
    weights = np.array([*mass[:3], *np.repeat([*axles.values()], 2)])
    before, clear_before = np.full(7, np.nan), np.zeros(7, dtype=bool)
    for ratio in np.linspace(0.02, 0.4, 39):
        dampers = np.diag(2.0 * ratio * np.sqrt(rates * body.mass_kg / 4.0))
        left = np.hstack([stiffness, stretched.T @ dampers @ stretched]) / mass[:, None]
        matrix = np.vstack([np.eye(7, 14, k=7), -left])
        found = modes_of_motions(matrix, tuple(map(str, range(14))), motions, weights)
        assert len({mode.eigenvalues for mode, _ in found}) == 7
        frequencies = np.array([mode.natural_frequency for mode, _ in found])
        assert frequencies[:3].max() < frequencies[3:].min()
        # nearly equal axles share their hop and tramp half and half, and have no clear names
        clear = np.array([part for _, part in found]) > 0.6
        assert clear[2]
        steps = np.abs(frequencies / before - 1.0)[clear & clear_before]
        assert not (steps > 0.02).any()
        before, clear_before = frequencies, clear


def test_the_bmw_has_the_mass_of_its_source():
    """All parts of Chrono's: chassis, rack, bars; of both sides spindle, arms, rod, rim, tyre."""
    front = 9.962477554 + 13.5 + 13.51 + 2.72 + 1.13 + 18.0 + 37.6
    rear = 14.705 + 5.813 + 23.965 + 19.45 + 6.0 + 15.4 + 37.6
    expected = 1442.1 + 9.072 + 4.0 * 5.0 + 2.0 * (front + rear)
    car = kintrafo.load("bmw_e90")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(expected, abs=0.01)


def test_fed_alpha_has_the_mass_of_its_source():
    side = 13.08 + 36.27 + 8.45 + 31.55 + 6.0 + 18.8 + 56.1
    expected = 5672.87 + 3.6814844109 + 1.605 + 2.0 * 15.02 + 4.0 * side
    car = kintrafo.load("fed_alpha")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(expected, abs=0.01)


def test_the_bmw_rolls_by_some_two_degrees_at_0_6_g():
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


def test_the_formula_student_car_has_the_front_corner_of_the_tutorial():
    car = kintrafo.load("formula_student_car")
    assert car.axles["front"].right == kintrafo.load("formula_student")
    assert sum(mass for mass, _ in masses(car)) == pytest.approx(290.0, abs=1e-9)
    rear = over(Model(car.axles["rear"].right), "travel", [-0.03, 0.03])
    assert np.ptp(np.rad2deg(rear["toe"].values)) < 0.03
