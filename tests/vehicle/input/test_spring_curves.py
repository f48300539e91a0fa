"""Springs by a curve of force over length, in every kind of suspension and in a rigid axle."""

import re
from functools import partial
from importlib import resources

import kintrafo
import numpy as np
import pytest
from kintrafo import (
    Axle,
    InputError,
    Model,
    RigidAxle,
    Suspension,
    characteristics,
    compliance,
    variation,
)
from kintrafo.vehicle import data
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.data import whole_axles as rigid_data
from kintrafo.vehicle.input.spring import force_and_rate, rate_at
from kintrafo.vehicle.models.plausibility import plausibility
from kintrafo.vehicle.models.rigid_axle.model import RigidAxleModel
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator, interp1d
from scipy.optimize import brentq

KINDS = (
    "reference_car",
    "double_wishbone_car",
    "push_rod_car",
    "pull_rod_car",
    "multi_link_car",
    "trailing_arm_car",
)
# twice as stiff pressed by 70 mm as free of force: nearly flat at first, as a coil that goes solid
COMPRESSIONS = (-20.0, 0.0, 20.0, 45.0, 70.0, 110.0, 160.0)
FORCES = (-900.0, 0.0, 1100.0, 2900.0, 5200.0, 9800.0, 18500.0)
WAYS = ("cubic", "linear")


def with_spring(name, **spring):
    """Return a car with another spring."""
    data = Suspension.load(name).to_dict()
    if "strut" in data:
        data["strut"] = {k: v for k, v in data["strut"].items() if not k.startswith("spring_")}
    return Suspension.from_dict(data | {"spring": spring})


def curved(name, interpolation="cubic", force=4000.0):
    """Return a car whose spring has a curve over compressions and a force at design."""
    return with_spring(
        name,
        compression_mm=list(COMPRESSIONS),
        force_N=list(FORCES),
        force_at_design_N=force,
        interpolation=interpolation,
    )


def expected_curve(interpolation):
    """Return force [N] and rate [N/m] over compression [m] by SciPy alone."""
    x, y = 1e-3 * np.array(COMPRESSIONS), np.array(FORCES)
    if interpolation == "linear":
        straight = interp1d(x, y, fill_value="extrapolate")
        return (
            straight,
            lambda c: np.diff(y)[i := np.clip(np.searchsorted(x, c) - 1, 0, 5)] / (np.diff(x)[i]),
        )
    slopes = PchipInterpolator(x, y).derivative()(x)
    # as the last two points rise it goes on
    slopes[[0, -1]] = np.diff(y)[[0, -1]] / np.diff(x)[[0, -1]]
    cubic = CubicHermiteSpline(x, y, slopes)

    def force(c):
        inside = np.clip(c, x[0], x[-1])
        return cubic(inside) + cubic.derivative()(inside) * (c - inside)

    return force, lambda c: cubic.derivative()(np.clip(c, x[0], x[-1]))


def compression_of(interpolation, force):
    """Return where the curve has a force [m]."""
    curve, _ = expected_curve(interpolation)
    return brentq(lambda c: float(curve(c)) - force, -0.1, 0.3, xtol=1e-15)


@pytest.mark.parametrize("interpolation", WAYS)
@pytest.mark.parametrize("name", KINDS)
def test_the_force_is_that_of_the_points(name, interpolation):
    """Over the travel and far beyond the table, beside SciPy's interpolation."""
    model = Model(curved(name, interpolation))
    free = float(model.signal("spring_length", model.design_state)) + compression_of(
        interpolation, 4000.0
    )
    curve, _ = expected_curve(interpolation)
    at = np.linspace(-0.06, 0.06, 13)
    found = characteristics.over(model, "travel", at)["spring_length"].values
    for travel, length in zip(at, found, strict=True):
        state = kintrafo.state_at_height(model, float(travel) + kintrafo_height(model))
        signals = model.signals(state)
        assert float(signals["spring_length"]) == pytest.approx(length, abs=1e-12)
        # rounding of a length of half a metre, times a rate of 2e5 N/m
        expected = float(curve(free - length))
        assert float(signals["spring_force"]) == pytest.approx(expected, rel=1e-11, abs=1e-9)


def kintrafo_height(model):
    """Return the height of the wheel centre at design [m]."""
    return float(model.signal("wheel_center_z", model.design_state))


@pytest.mark.parametrize("interpolation", WAYS)
@pytest.mark.parametrize("name", KINDS)
def test_what_is_computed_uses_the_rate_where_it_is(name, interpolation):
    """Wheel rate, ride frequency and eigenvalues beside those of a straight spring there."""
    model = Model(curved(name, interpolation))
    _, rate = expected_curve(interpolation)
    found = characteristics.over(model, "travel", [0.0]).isel(wheel_travel=0)
    there = float(rate(compression_of(interpolation, 4000.0)))
    tangent = Model(with_spring(name, rate_N_per_m=there, force_at_design_N=4000.0))
    beside = characteristics.over(tangent, "travel", [0.0]).isel(wheel_travel=0)
    for what in ("wheel_rate", "ride_rate", "motion_ratio"):
        assert float(found[what]) == pytest.approx(float(beside[what]), rel=1e-9)
    assert float(found["wheel_rate"]) > 1000.0
    # the linearised motion about design is that of the tangent, whatever else is the same
    eigenvalues = [np.sort_complex(m.eigenvalues(m.design_state)) for m in (model, tangent)]
    np.testing.assert_allclose(*eigenvalues, rtol=1e-7, atol=1e-7)
    length = np.array(float(model.signal("spring_length", model.design_state)))
    assert float(rate_at(model.parameters, length)) == pytest.approx(there, rel=1e-9)


def test_an_axle_rolls_on_the_rates_where_its_springs_are():
    """Stiffness in roll and compliance of both sides: those of straight springs at design."""
    name = "double_wishbone_car"
    there = float(expected_curve("cubic")[1](compression_of("cubic", 4000.0)))
    sides = curved(name), with_spring(name, rate_N_per_m=there, force_at_design_N=4000.0)
    one, other = (
        Axle.from_dict({"axle": "front", "right": side, "left": side.mirrored()}) for side in sides
    )
    rolled = [flat(characteristics.over(each, "roll", [0.0])) for each in (one, other)]
    for quantity in ("roll_stiffness", "roll_stiffness_with_tyres"):
        found, expected = (float(each[quantity][0]) for each in rolled)
        assert found == pytest.approx(expected, rel=1e-9)
        assert found > 1e4
    soft = [
        compliance.linear(each, BUSH, [0.0], held="spring")["flexibility"] for each in (one, other)
    ]
    np.testing.assert_allclose(*soft, rtol=1e-8, atol=1e-14)


BUSH = {"lower_arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 1200.0}}


def test_a_flat_piece_has_no_rate():
    """The remaining wheel rate there is that of the rotation of the force."""
    name = "double_wishbone_car"
    points = {"compression_mm": [0.0, 20.0, 120.0, 160.0], "force_N": [0.0, 4e3, 4e3, 9e3]}
    length = 1e3 * Suspension.load(name).hardpoints.distance("spring_seat", "spring_top")
    model = Model(with_spring(name, free_length_mm=length + 70.0, **points))
    assert float(model.signal("spring_force", model.design_state)) == pytest.approx(4e3, rel=1e-12)
    length = np.array(float(model.signal("spring_length", model.design_state)))
    assert float(rate_at(model.parameters, length)) == 0.0
    step = 1e-3
    found = characteristics.over(model, "travel", [-step, 0.0, step])
    turning = 4e3 * np.diff(found["motion_ratio"].values[[0, 2]])[0] / (2.0 * step)
    assert float(found["wheel_rate"][1]) == pytest.approx(turning, rel=1e-4)
    assert abs(turning) < 3e3


def test_many_cars_have_the_numbers_of_each():
    """A free length and hardpoints that vary: together, and one by one."""
    car = curved("double_wishbone_car")
    values = {
        "spring.force_at_design_N": np.array([4000.0, 3800.0, 4300.0, 5000.0]),
        "hardpoints.spring_top.z": np.array([620.0, 622.0, 617.0, 625.0]),
    }
    found = variation.cars(car, values, positions=[-0.03, 0.0, 0.03], names=["wheel_rate"])
    for which in range(4):
        changes = {place: float(column[which]) for place, column in values.items()}
        alone = characteristics.over(Model(car.with_changes(changes)), "travel", [-0.03, 0.0, 0.03])
        # as a rate of 1e5 N/m is found alone: lengths to 1e-14 m, times how fast rates change
        np.testing.assert_allclose(
            found["wheel_rate"].values[which], alone["wheel_rate"], rtol=1e-9
        )
    assert not found["reason"].values.astype(bool).any()


def test_a_motion_over_the_kinks_of_straight_lines():
    """Methods of high order and stiff ones, at a usual tolerance, beside one at a small one."""
    model = Model(curved("double_wishbone_car", "linear"))
    start = kintrafo.state_at_height(model, kintrafo_height(model) + 0.05)
    span, at = (0.0, 0.5), np.linspace(0.0, 0.5, 26)
    exact = kintrafo.simulate(
        model, span, start, t_eval=at, rtol=1e-12, atol=1e-13, max_step=1e-3, method="DOP853"
    )
    for method in ("DOP853", "BDF"):
        found = kintrafo.simulate(
            model, span, start, t_eval=at, method=method, rtol=1e-7, atol=1e-9
        )
        assert found.success
        # some hundred steps of at most 1e-7 each, of heights of 0.3 m and turns of 1 rad
        for name, size in (("wheel_center_z", 1.0), ("wheel_velocity", 10.0)):
            np.testing.assert_allclose(
                found.signals[name], exact.signals[name], rtol=0.0, atol=2e-6 * size
            )
    # knots were passed
    lengths = exact.signals["spring_length"]
    knots = {model.parameters[f"spring_table_knot_{i}"] for i in range(11)}
    assert any(lengths.min() < knot < lengths.max() for knot in knots)


@pytest.mark.parametrize("name", [*KINDS[1:], "rigid_axle"])
def test_what_the_annotated_files_propose_can_be_used(name, tmp_path):
    """Their curve goes with the force at design that stands above it."""
    text = resources.files(rigid_data if name == "rigid_axle" else data)
    text = text.joinpath(f"{name}.toml").read_text(encoding="utf-8")
    begin, end = text.index("[spring]"), text.index("[damper]")
    section = re.sub(r"^rate_N_per_m.*\n", "", text[begin:end], flags=re.MULTILINE)
    section = re.sub(r"^# (compression_mm|force_N)", r"\1", section, flags=re.MULTILINE)
    file = tmp_path / "car.toml"
    file.write_text(text[:begin] + section + text[end:], encoding="utf-8")
    found = (RigidAxle if name == "rigid_axle" else Suspension).load(file)
    assert found.spring.by_curve
    assert found.spring.force_at_design_N > 0.0


def test_a_simulation_says_where_a_curve_ends():
    name = "double_wishbone_car"
    length = 1e3 * Suspension.load(name).hardpoints.distance("spring_seat", "spring_top")
    lengths = {"length_mm": [length - 15.0, length + 10.0], "force_N": [6400.0, 4900.0]}
    model = Model(with_spring(name, **lengths))
    start = kintrafo.state_at_height(model, kintrafo_height(model) + 0.05)
    found = kintrafo.simulate(model, (0.0, 0.1), start)
    assert any("shorter than its table goes" in words for words in map(str, found.validity))
    inside = kintrafo.simulate(model, (0.0, 0.1), kintrafo.equilibrium(model))
    assert not inside.validity


def test_a_rate_beside_a_curve_is_no_variable(refused):
    """A key that a curve replaces is refused by name, in studies, too."""
    car = curved("double_wishbone_car")
    refused(InputError, lambda: car.with_changes({"spring.rate_N_per_m": 60e3}))
    found = variation.sensitivity(car, ["spring.force_at_design_N"], positions=[0.0])
    step = 1.0
    up, down = (
        characteristics.over(
            Model(car.with_changes({"spring.force_at_design_N": 4000.0 + s})), "travel", [0.0]
        )["wheel_rate"][0]
        for s in (step, -step)
    )
    slope = float(up - down) / (2.0 * step)
    there = found["wheel_rate"]
    assert float(np.squeeze(there)) == pytest.approx(slope, rel=1e-4)


@pytest.mark.parametrize("interpolation", WAYS)
def test_the_derivative_is_that_of_the_force(interpolation):
    """The law in NumPy, that of the equations and their derivative agree at every length."""
    model = Model(curved("double_wishbone_car", interpolation))
    assert "spring_table_knot_0" in model.parameters
    lengths = np.linspace(0.2, 0.6, 4001)
    force, rate = force_and_rate(model.parameters, lengths)
    middle = -np.gradient(force, lengths)
    kinks = [model.parameters[f"spring_table_knot_{i}"] for i in range(11)]
    away = np.abs(lengths[:, None] - kinks).min(1) > 2e-4
    # central differences over 0.2 mm of a cubic whose third derivative is below 1e9 N/m^3
    np.testing.assert_allclose(rate[away], middle[away], rtol=1e-3, atol=5.0)
    by_state = model.evaluate("signals_jacobian", model.design_state)
    names = list(model.signal_names)
    by_arm = by_state[:, 0]
    length = by_arm[names.index("spring_length")]
    there = np.array(float(model.signal("spring_length", model.design_state)))
    assert by_arm[names.index("spring_force")] == pytest.approx(
        -float(rate_at(model.parameters, there)) * length, rel=1e-12
    )


def test_the_three_ways_to_say_it_are_one():
    """Over lengths, from a free length, and from a force at design."""
    name = "double_wishbone_car"
    by_force = curved(name)
    design = 1e3 * by_force.hardpoints.distance("spring_seat", "spring_top")
    free = design + 1e3 * compression_of("cubic", 4000.0)
    points = {"force_N": list(FORCES), "compression_mm": list(COMPRESSIONS)}
    by_free = with_spring(name, free_length_mm=free, **points)
    lengths = [free - c for c in reversed(COMPRESSIONS)]
    by_length = with_spring(name, length_mm=lengths, force_N=list(reversed(FORCES)))
    one, *others = (Model(car) for car in (by_force, by_free, by_length))
    for other in others:
        for height in (0.26, 0.3, 0.34):
            states = (kintrafo.state_at_height(m, height) for m in (one, other))
            first, second = (
                float(m.signal("spring_force", s))
                for m, s in zip((one, other), states, strict=True)
            )
            assert first == pytest.approx(second, rel=1e-11)


def test_a_macpherson_spring_stands_in_one_place(refused):
    car = Suspension.load("reference_car")
    length = 1e3 * car.hardpoints.distance("ball_joint", "strut_top")
    rate = with_spring("reference_car", rate_N_per_m=25e3, free_length_mm=length + 100.0)
    assert not rate.beyond_the_paper()
    slide = car.strut.length_max_mm - length - 100.0
    assert rate.parameters()["spring_free_slide"] == pytest.approx(1e-3 * slide, abs=1e-12)
    assert curved("reference_car").beyond_the_paper() == ["[spring] force_N"]
    both = car.to_dict() | {"spring": {"rate_N_per_m": 25e3, "free_length_mm": 700.0}}
    refused(InputError, lambda: Suspension.from_dict(both))
    strut = {k: v for k, v in car.to_dict()["strut"].items() if not k.startswith("spring_")}
    refused(InputError, lambda: Suspension.from_dict(car.to_dict() | {"strut": strut}))


GOOD = {"compression_mm": [0.0, 50.0, 100.0], "force_N": [0.0, 2000.0, 6000.0]}


@pytest.mark.parametrize(
    "spring",
    [
        {**GOOD},
        {**GOOD, "free_length_mm": 500.0, "force_at_design_N": 10.0},
        {**GOOD, "free_length_mm": 500.0, "rate_N_per_m": 1e4},
        {**GOOD, "free_length_mm": 500.0, "length_mm": [1.0, 2.0, 3.0]},
        {"force_N": [0.0, 1.0], "free_length_mm": 500.0},
        {"length_mm": [300.0, 400.0]},
        {"interpolation": "linear"},
        {"free_length_mm": 500.0},
        {"length_mm": [300.0, 400.0], "force_N": [900.0, 0.0], "force_at_design_N": 100.0},
        {"length_mm": [300.0, 400.0], "force_N": [900.0, 0.0], "free_length_mm": 100.0},
        {"length_mm": [400.0, 300.0], "force_N": [0.0, 900.0]},
        {"compression_mm": [0.0, 5e-324], "force_N": [0.0, 1.0], "free_length_mm": 500.0},
        {"compression_mm": [0.0, 100.0], "force_N": [0.0, 1e308], "free_length_mm": 500.0},
        {"compression_mm": 5.0, "force_N": [0.0, 1.0]},
        {"length_mm": [300.0, 400.0], "force_N": [0.0, 900.0]},
        {"length_mm": [0.0, 400.0], "force_N": [900.0, 0.0]},
        {"length_mm": [300.0, 400.0], "force_N": [900.0]},
        {"length_mm": [300.0], "force_N": [900.0]},
        {"length_mm": [300.0, 400.0], "force_N": [900.0, 900.0]},
        {"compression_mm": [0.0, 50.0], "force_N": [10.0, 0.0], "free_length_mm": 500.0},
        {**GOOD, "force_at_design_N": 7000.0},
        {**GOOD, "free_length_mm": 90.0},
        {
            "compression_mm": [0.0, 50.0, 60.0, 100.0],
            "force_N": [0.0, 2000.0, 2000.0, 4000.0],
            "force_at_design_N": 2000.0,
        },
        {**GOOD, "free_length_mm": 500.0, "interpolation": "spline"},
    ],
)
@pytest.mark.parametrize("kind", ["double_wishbone_car", "reference_car", "rigid_axle"])
def test_refused_springs(kind, spring, refused):
    make = axle if kind == "rigid_axle" else partial(with_spring, kind)
    refused(InputError, lambda: make(**spring))


def test_a_spring_in_a_wrong_unit_or_beyond_its_table_is_reported():
    name = "double_wishbone_car"
    weak = with_spring(name, compression_mm=[0.0, 150.0], force_N=[0.0, 6.0], force_at_design_N=5.0)
    assert "[spring] force_N: the rate at design = 40 N/m" in plausibility(weak).problems[0]
    beyond = with_spring(name, length_mm=[300.0, 400.0], force_N=[6000.0, 0.0])
    assert "goes from 300.0 to 400.0 mm" in plausibility(beyond).notes[-1]
    assert not plausibility(curved(name)).problems


def test_the_file_is_written_and_read_back(tmp_path):
    for name in KINDS:
        car = curved(name, "linear")
        assert Suspension.load(car.save(tmp_path / f"{name}.toml")) == car


def axle(**spring):
    return RigidAxle.from_dict(RigidAxle.load("rigid_axle").to_dict() | {"spring": spring})


def five_rods(**spring):
    """Return an axle whose spring's rate alone holds it: five rods, one on soft bushes."""
    data = RigidAxle.load("rigid_axle").to_dict()
    data["rods"]["fifth_link"] = {"chassis": [500.0, -60.0, 540.0], "axle": [-20.0, -60.0, 520.0]}
    bushings = {"fifth_link_chassis": {"axial_N_per_mm": 900.0, "radial_N_per_mm": 900.0}}
    return RigidAxle.from_dict(data | {"spring": spring, "bushings": bushings})


@pytest.mark.parametrize("make", [axle, five_rods])
def test_compliance_of_a_rigid_axle_is_that_of_the_rate_where_it_is(make):
    points = {"compression_mm": list(COMPRESSIONS), "force_N": list(FORCES)}
    there = float(expected_curve("cubic")[1](compression_of("cubic", 4000.0)))
    bushings = {"panhard_rod_chassis": {"axial_N_per_mm": 5000.0}}
    both = bushings | ({} if make is axle else make(**points, force_at_design_N=4e3).bushings)
    one, other = (
        compliance.linear(make(**spring, force_at_design_N=4000.0), both, [0.0], held="spring")
        for spring in (points, {"rate_N_per_m": there})
    )
    for name in one:
        np.testing.assert_allclose(one[name], other[name], rtol=1e-8, atol=1e-14)


def test_springs_of_a_rigid_axle():
    """Force, rest and rates: those of a straight spring that touches the curve at design."""
    points = {"compression_mm": list(COMPRESSIONS), "force_N": list(FORCES)}
    force = RigidAxle.load("rigid_axle").spring.force_at_design_N
    curve, rate = expected_curve("cubic")
    there = float(rate(compression_of("cubic", force)))
    bent = axle(**points, force_at_design_N=force)
    straight = axle(rate_N_per_m=there, force_at_design_N=force)
    models = [RigidAxleModel(one) for one in (bent, straight)]
    found, expected = (np.sort_complex(m.eigenvalues(m.design_state)) for m in models)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6)
    rest = kintrafo.equilibrium(models[0])
    signals = models[0].signals(rest)
    for side in ("left", "right"):
        free = bent.length("spring", side) + compression_of("cubic", force)
        length = float(signals[f"{side}_spring_length"])
        assert float(signals[f"{side}_spring_spring_force"]) == pytest.approx(
            float(curve(free - length)), rel=1e-10
        )


def test_what_varies_of_a_spring_by_a_curve_is_said(refused):
    car = curved("double_wishbone_car")
    with pytest.warns(
        RuntimeWarning,
        match=r"spring.compression_mm, spring.force_N: lists, such as a .* if spring.force_N is",
    ):
        variation.sensitivity(car, ["spring"], positions=[0.0])
    refused(
        InputError, lambda: variation.sensitivity(car, ["spring.compression_mm"], positions=[0.0])
    )


def scaled_by(car, factor):
    """Return a car with other forces of its spring's curve."""
    return car.with_changes({"spring.force_N": [factor * force for force in car.spring.force_N]})


@pytest.mark.parametrize("name", ["double_wishbone_car", "reference_car"])
def test_forces_of_a_curve_vary_by_a_factor(name):
    """Each car is that whose file has the forces times the factor."""
    car, at = curved(name), [-0.02, 0.02]
    options = {"positions": at, "names": ["wheel_rate"]}
    factors = [0.9, 1.0, 1.1, 1.3]
    found = variation.cars(car, {"spring.force_N": factors}, **options)
    for rates, factor in zip(found["wheel_rate"].values, factors, strict=True):
        expected = characteristics.over(Model(scaled_by(car, factor)), "travel", at)[
            "wheel_rate"
        ].values
        np.testing.assert_allclose(rates, expected, rtol=1e-12)
    slope = variation.sensitivity(car, ["spring.force_N"], **options)
    assert str(slope["place_name"].values[0]) == "spring force factor"
    beside = [
        characteristics.over(Model(scaled_by(car, 1.0 + by)), "travel", at)["wheel_rate"].values
        for by in (-1e-3, 1e-3)
    ]
    difference = (beside[1] - beside[0]) / 2e-3
    # the difference is off by the square of its step
    np.testing.assert_allclose(slope["wheel_rate"].values[0], difference, rtol=1e-5)
    bands = variation.tolerance(car, {"spring.force_N": "3 %"}, count=40, seed=2, **options)
    assert np.abs(bands["value_of"].values - 1.0).max() == pytest.approx(0.02, abs=0.012)
    assert bands["wheel_rate_share"].values == pytest.approx(1.0)


def test_a_factor_of_a_rigid_axle_and_of_goals():
    bent = axle(compression_mm=COMPRESSIONS, force_N=FORCES, force_at_design_N=4000.0)
    found = variation.sensitivity(bent, ["spring.force_N"], positions=[0.0])
    assert any(np.nan_to_num(found[name].values).any() for name in found)
    car = curved("double_wishbone_car")
    wanted = 1.1 * characteristics.over(Model(car), "travel", [0.0])["wheel_rate"].values[0] / 1e3
    goals = {"wheel_rate": {"at_mm": [0.0], "value": wanted, "within": 0.1}}
    best = variation.optimise(car, {"spring.force_N": "30 %"}, goals)
    factor = 1.0 + best.moved["spring.force_N"]
    assert best.suspension == scaled_by(car, factor)
