"""How cars ride: roads, weighting, rest, modes, linear responses, simulations."""

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import car_on_arms
from kintrafo.vehicle.analysis.ride.linear import linear_at_rest
from kintrafo.vehicle.analysis.ride.outputs import upward
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.roads import CLASSES, Road, bump, iso8608, isotropic_coherence
from scipy.signal import csd, welch
from support.models import own


@pytest.fixture(scope="module")
def car():
    return kintrafo.load("quarter_car")


# -- roads ----------------------------------------------------------------------------------------


def test_a_rough_road_has_the_spectrum_and_the_coherence_of_its_class():
    road = iso8608("C", length=40_000.0, seed=5, track=1.5, fade=0.0)
    how = {"fs": 1.0 / road.spacing, "nperseg": 8192, "window": "hann"}
    n, left = welch(road.left, **how)
    _, right = welch(road.right, **how)
    _, cross = csd(road.left, road.right, **how)
    band = (n > 0.03) & (n < 5.0)
    wanted = CLASSES["C"] * (n[band] / 0.1) ** -2.0
    # some 190 averages: 7 % each; the mean over the thousands of frequencies is far better
    for density in (left[band], right[band]):
        assert np.mean(density / wanted) == pytest.approx(1.0, abs=0.01)
    shared = np.real(cross[band]) / np.sqrt(left[band] * right[band])
    off = shared - isotropic_coherence(n[band], 1.5)
    assert np.abs(off).mean() < 0.08
    assert abs(off.mean()) < 0.01


def test_a_seed_gives_one_road():
    one, same, other = (iso8608("B", length=200.0, seed=s) for s in (1, 1, 2))
    np.testing.assert_array_equal(one.left, same.left)
    assert np.abs(one.left - other.left).max() > 1e-3
    assert np.array_equal(*(iso8608("B", length=200.0, seed=1, track=0.0).__dict__[s] for s in
                            ("left", "right")))  # fmt: skip


def test_rear_wheels_meet_a_road_later():
    road = bump(0.05, 1.0, at=4.0, end=20.0, sides="left")
    front = road.over_time("left", 10.0, 0.0, 2.0)
    rear = road.over_time("left", 10.0, 2.6, 2.0)
    times = np.linspace(0.3, 1.9, 50)
    np.testing.assert_allclose(rear(times), front(times - 0.26), atol=1e-12)
    assert float(front(0.45)) == pytest.approx(0.05, abs=1e-9)
    assert not road.right.any()


@pytest.mark.parametrize(
    "made",
    [
        lambda: Road(0.1, [0.0, np.nan, 0.0, 0.0], [0.0] * 4),
        lambda: Road(0.1, [0.0] * 5, [0.0] * 4),
        lambda: iso8608("Z", length=200.0, seed=1),
        lambda: iso8608("A", length=10.0, seed=1),
        lambda: iso8608("A", length=200.0, seed=1, spacing=0.2),
        lambda: bump(0.05, 0.0),
        lambda: bump(0.05, 60.0),
        lambda: bump(0.05, 1.0).over_time("left", 0.0, 0.0, 1.0),
        lambda: iso8608("A", length=200.0, seed=1, fade=300.0),
    ],
)
def test_roads_that_cannot_be_are_refused(made, refused):
    refused(kintrafo.InputError, made)


# -- weighting ------------------------------------------------------------------------------------


def test_the_weighting_is_that_of_the_standard():
    """ISO 2631-1:1997, Table 3."""
    table = {0.5: 418, 1.0: 482, 1.25: 484, 2.0: 531, 2.5: 631, 4.0: 967, 5.0: 1039, 6.3: 1054}
    table |= {8.0: 1036, 10.0: 988, 12.5: 902, 16.0: 768, 20.0: 636, 25.0: 513, 31.5: 405}
    table |= {40.0: 314, 63.0: 186, 80.0: 132}
    frequencies = np.array(list(table))
    found = 1e3 * np.abs(kintrafo.ride.weighting(frequencies))
    np.testing.assert_allclose(found, list(table.values()), atol=1.0)  # its last digit


def test_a_weighted_sine_has_the_size_of_the_weighting():
    step = 1e-3
    times = step * np.arange(20_000)
    found = kintrafo.ride.weighted(np.sin(2.0 * np.pi * 5.0 * times), step)[10_000:]
    # straight lines between the points are short of the sine by (2 pi f step)^2 / 12
    assert found.max() == pytest.approx(abs(kintrafo.ride.weighting(5.0)), rel=2e-4)


# -- a quarter car against two masses -------------------------------------------------------------


def test_rest_is_that_of_a_simulation(car):
    model = kintrafo.CarModel(car)
    start = model.design_state.copy()
    start[0] += 0.02
    end = kintrafo.simulate(model, (0.0, 12.0), start).y[:, -1]
    # 12 s are 18 time constants of the heave: 2e-2 exp(-18)
    np.testing.assert_allclose(end[:2], kintrafo.equilibrium(model)[:2], atol=1e-8)
    found = kintrafo.ride.at_rest(car)
    assert float(found["load"]) == pytest.approx(9.81 * 387.36, rel=1e-9)
    assert float(found["travel"]) == pytest.approx(0.0, abs=1e-6)


def test_the_linear_spectrum_is_that_of_a_long_simulation(car):
    speed, step = 20.0, 0.005
    road = iso8608("A", length=8000.0, seed=3, track=0.0)
    motion = kintrafo.ride.over(car, road, speed, settle=5.0, output_step=step)
    f, density = welch(
        motion["body_acceleration"].values[motion["time"].values > 5.0], fs=1.0 / step, nperseg=2048
    )
    band = (f > 0.6) & (f < 20.0)
    linear = kintrafo.ride.response(car, speed, "A", frequency=f[band])
    wanted = linear["body_acceleration_psd"].values
    # some 75 averages in each of 200 frequencies; where they are narrow the peaks are blunt
    assert np.mean(density[band] / wanted) == pytest.approx(1.0, abs=0.05)
    assert np.std(density[band] / wanted) < 0.25
    whole = kintrafo.ride.response(car, speed, "A")
    for name in ("body_acceleration", "travel"):
        simulated = motion[name].attrs["rms"]
        assert simulated == pytest.approx(whole[f"{name}_psd"].attrs["rms"], rel=0.05)
    weighted = whole["body_acceleration_psd"].attrs["weighted_rms"]
    assert motion["body_acceleration"].attrs["weighted_rms"] == pytest.approx(weighted, rel=0.05)


def test_a_tyre_that_pulls_at_the_road_is_named(car):
    motion = kintrafo.ride.over(car, bump(0.05, 0.5, at=1.0, end=20.0), 8.0, duration=1.0, settle=0)
    assert any("pulls at the road" in text for text in motion.attrs["not_valid"])


def test_a_bump_at_the_beginning_is_judged(car):
    road = bump(0.01, 0.5, at=5.0, end=40.0)  # at 20 m/s it is passed after 0.28 s
    motion = kintrafo.ride.over(car, road, 20.0)["body_acceleration"]
    assert motion.attrs["largest"] == motion.values.max() > 0.5
    rough = iso8608("A", length=200.0, seed=1)
    assert (rough.stationary, road.stationary, (rough + rough).stationary) == (True, False, True)


@pytest.mark.parametrize("frequency", [[2.0], [3.0, 2.0, 1.0], [1.0, 2.0, 2.0]])
def test_frequencies_over_which_nothing_can_be_summed_are_refused(car, frequency, refused):
    refused(kintrafo.InputError, lambda: kintrafo.ride.response(car, 20.0, frequency=frequency))


@pytest.mark.parametrize("options", [{"output_step": 0.02}, {"t_eval": [0.0, 1.0]}])
def test_other_outputs_than_those_of_a_ride_are_refused(car, options, refused):
    """Those that are too far apart cannot be weighted."""
    road = bump(0.01, 0.5)
    refused(kintrafo.InputError, lambda: kintrafo.ride.over(car, road, 20.0, **options))


@pytest.mark.parametrize("name", ["body", "a/b", ""])
def test_a_seat_does_not_take_the_name_of_something_else(car, name, refused):
    data = car.to_dict() | {"seats": {name: {"place_mm": [0.0, 0.0, 500.0]}}}
    refused(kintrafo.InputError, lambda: kintrafo.Car.from_dict(data))


def test_upward_is_the_second_derivative_of_the_height():
    rng = np.random.default_rng(2)
    place = rng.normal(0.0, 1.0, 3)
    terms = rng.normal(0.0, 0.2, (3, 3))
    names = ("heave", "pitch", "roll")

    def at(t):
        powers = np.array([t, t**2, t**3])
        return dict(zip(names, terms @ powers, strict=True))

    def height(t):
        q = at(t)
        h = np.sin(q["roll"]) * place[1] + np.cos(q["roll"]) * place[2]
        return q["heave"] - np.sin(q["pitch"]) * place[0] + np.cos(q["pitch"]) * h

    t, step = 0.7, 1e-3
    motion = {
        name: (
            np.array([row @ [t, t**2, t**3]]),
            np.array([row @ [1.0, 2 * t, 3 * t**2]]),
            np.array([row @ [0.0, 2.0, 6 * t]]),
        )
        for name, row in zip(names, terms, strict=True)
    }
    difference = (height(t + step) - 2.0 * height(t) + height(t - step)) / step**2
    # the fourth derivative over 12 by the square of the step, and rounding over it
    assert upward(motion, place)[0] == pytest.approx(difference, abs=1e-5)


def test_a_held_body_does_not_ride(refused):
    refused(kintrafo.InputError, lambda: kintrafo.ride.modes(kintrafo.load("reference_axle")))


# -- four wheels ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def whole():
    """Return a car on four trailing arms, derived once for this and for tests of its equations."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(
            "kintrafo.vehicle.models.car.equations.compile_mechanism", lambda model, **_: own(model)
        )
        return kintrafo.CarModel(car_on_arms())


def test_corner_weights_carry_the_car(whole):
    found = kintrafo.ride.at_rest(whole)
    loads = found["load"].values
    weight = 9.81 * (1200.0 + 4 * 38.0)
    assert loads.sum() == pytest.approx(weight, rel=1e-9)
    left, right = loads[[0, 2]].sum(), loads[[1, 3]].sum()
    # moments about the middle and about the rear wheel centres; the car leans, which moves them
    assert (left - right) * 0.74 == pytest.approx(9.81 * 1200.0 * 0.02, rel=0.05)
    arms = 4 * 18.0 * 0.130 * 9.81
    front = (9.81 * 1200.0 * 1.4 + arms + 9.81 * 2 * 38.0 * 2.6) / 2.6
    assert loads[:2].sum() == pytest.approx(front, rel=5e-3)
    assert float(found["roll"]) < 0.0 < float(found["pitch"])  # left side down, nose down


def test_a_slow_road_lifts_pitches_and_rolls_the_car(whole):
    """At 0.01 Hz the body follows the plane of the road, whose twist the springs share."""
    linear = linear_at_rest(assembly_of(whole))
    frequency = np.array([0.01])
    by_wheel = {
        wheel: dict(zip(linear.state_names, found[0].real, strict=True))
        for wheel in whole.car.wheels
        for found in [linear.state_response(frequency, f"{wheel}_road_height")]
    }

    def motion(coordinate, **heights):
        return sum(h * by_wheel[wheel][coordinate] for wheel, h in heights.items())

    wheels = whole.car.wheels
    # the height is that of the centre of mass of the body, 1.2 m behind the front wheels
    assert motion("heave", **dict.fromkeys(wheels, 1.0)) == pytest.approx(1.0, abs=1e-3)
    front = {wheel: float(wheel.startswith("front")) for wheel in wheels}
    assert motion("heave", **front) == pytest.approx(1.4 / 2.6, abs=2e-2)
    # the weight of the body, 0.3 m above the wheel centres, goes on pitching it: 2.7 % of the
    # stiffness of the springs. In roll tyres lean with the body, and so do their forces
    assert 1.0 < motion("pitch", **front) * -2.6 < 1.03
    left = {wheel: 0.74 * (1.0 if wheel.endswith("left") else -1.0) for wheel in wheels}
    assert motion("roll", **left) == pytest.approx(1.0, abs=2e-2)


def test_modes_have_names(whole):
    found = kintrafo.ride.modes(whole)
    names = ["heave", "pitch", "roll", "front_hop", "front_tramp", "rear_hop", "rear_tramp"]
    assert found["mode"].values.tolist() == names
    frequencies = found["frequency"].values
    assert len(set(frequencies.round(6))) == len(names)
    assert frequencies[:3].max() < 3.0
    assert frequencies[3:].min() > 8.0


def test_equal_axles_have_as_many_modes_as_names(whole):
    """Wheels of both take part alike in modes of two axles together, and against each other."""
    car = whole.car.with_changes({"body.com_mm": [-1300.0, 0.0, 600.0]})
    found = np.sort(kintrafo.ride.modes(car)["frequency"].values)
    modes = linear_at_rest(assembly_of(car)).modes
    wanted = np.sort([mode.natural_frequency for mode in modes if mode.oscillates])
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


def test_numbers_over_speed_are_those_of_the_spectra(whole, refused):
    numbers = kintrafo.ride.by_speed(whole, [15.0, 30.0], "C", seat="driver")
    spectra = kintrafo.ride.response(whole, 30.0, "C")
    driver = spectra["driver_acceleration_psd"].attrs
    for name, wanted in (
        ("acceleration_rms", driver["rms"]), ("weighted_rms", driver["weighted_rms"]),
        ("load_rms", spectra["load_psd"].attrs["rms"]),
        ("travel_rms", spectra["travel_psd"].attrs["rms"]),
    ):  # fmt: skip
        np.testing.assert_allclose(numbers[name].isel(speed=1), wanted, rtol=1e-12)
    modes = kintrafo.ride.modes(whole)
    for name, each in modes.groupby("mode"):
        assert float(numbers[f"{name}_frequency"][0]) == float(each["frequency"].item())
    refused(kintrafo.InputError, lambda: kintrafo.ride.by_speed(whole, [0.0]))
    with pytest.raises(kintrafo.InputError, match="driver"):
        kintrafo.ride.by_speed(whole, [10.0], seat="drivr")


def test_four_wheels_ride_by_the_linear_equations(whole):
    speed = 20.0
    road = iso8608("A", length=1200.0, seed=4, track=assembly_of(whole).track)
    motion = kintrafo.ride.over(whole, road, speed, settle=4.0)
    linear = kintrafo.ride.response(whole, speed, "A")
    assert motion["load"].dims == ("wheel", "time")
    for name in ("body_acceleration", "driver_acceleration"):
        # 56 s of some 1.3 Hz: 150 periods, of which the spectrum is known to 8 %
        simulated, expected = motion[name].attrs, linear[f"{name}_psd"].attrs
        assert simulated["rms"] == pytest.approx(expected["rms"], rel=0.15)
        assert simulated["weighted_rms"] == pytest.approx(expected["weighted_rms"], rel=0.15)
    np.testing.assert_allclose(
        motion["travel"].attrs["rms"], linear["travel_psd"].attrs["rms"], rtol=0.15
    )


def test_a_seat_moves_as_the_leaning_body_moves_it(whole):
    """The height of a seat is differentiated at rest, where the body is pitched and rolled."""
    frequency, road = np.array([1.0, 3.0]), "front_left_road_height"
    found = kintrafo.ride.response(whole, 20.0, frequency=frequency)["driver_acceleration_by_road"]
    assembly = assembly_of(whole)
    linear = linear_at_rest(assembly)
    x, y, z = assembly.felt_at()["driver_acceleration"]

    def height(heave, pitch, roll):
        return heave - np.sin(pitch) * x + np.cos(pitch) * (np.sin(roll) * y + np.cos(roll) * z)

    def slope(i):
        step = 1e-5 * np.eye(3)[i]
        return (height(*(linear.state[:3] + step)) - height(*(linear.state[:3] - step))) / 2e-5

    moved = linear.state_response(frequency, road)[:, :3] @ [slope(i) for i in range(3)]
    wanted = np.abs(moved) * (2.0 * np.pi * frequency) ** 2
    # a central difference: its rounding, 1e-16 over the step
    np.testing.assert_allclose(found.sel(road_wheel="front_left"), wanted, rtol=1e-9)
