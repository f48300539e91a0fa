"""Spring, damper, stops and tyre as users describe them, seen through the compiled equations."""

import re
from importlib import resources

import kintrafo
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import InputError, Model, Suspension
from kintrafo.vehicle import data
from scipy.interpolate import PchipInterpolator

CAR = Suspension.load("reference_car")
VELOCITIES = (-1.0, -0.3, -0.05, 0.0, 0.05, 0.3, 1.0)
FORCES = (-2500.0, -1300.0, -400.0, 0.0, 250.0, 600.0, 1100.0)


def changed(**sections):
    """Return the reference car with keys changed, added or (None) removed, section by section."""
    data = CAR.to_dict()
    for section, keys in sections.items():
        table = data.setdefault(section, {})
        for key, value in keys.items():
            if value is None:
                table.pop(key)
            else:
                table[key] = value
    return Suspension.from_dict(data)


def with_damper(velocities, forces):
    curve = {"velocity_m_per_s": velocities, "force_N": forces}
    return changed(strut={"damper_rate_N_s_per_m": None}, damper=curve)


def at_strut_velocity(model, velocity):
    """Return the state at design with the strut compressed at some velocity [m/s]."""
    names = list(model.equations.SIGNALS)
    by_state = model.evaluate("signals_jacobian", model.design_state)
    return model.state(beta1_rate=-velocity / by_state[names.index("strut_velocity"), 2])


def damper_force(model, velocity):
    return float(model.signal("damper_force", at_strut_velocity(model, velocity)))


def expected_curve(velocities, forces, at):
    """SciPy's own interpolation, with straight lines outside."""
    curve = PchipInterpolator(velocities, forces)
    inside = np.clip(at, velocities[0], velocities[-1])
    return curve(inside) + curve.derivative()(inside) * (at - inside)


# not subnormal numbers, with which SciPy's harmonic mean overflows
RISES = st.just(0.0) | st.floats(1e-3, 900.0)


@st.composite
def curves(draw):
    count = draw(st.integers(2, 11))
    steps = draw(st.lists(st.floats(0.01, 1.0), min_size=count - 1, max_size=count - 1))
    rises = draw(st.lists(RISES, min_size=count - 1, max_size=count - 1))
    zero = draw(st.integers(0, count - 1))
    v, force = np.append(0.0, np.cumsum(steps)), np.append(0.0, np.cumsum(rises))
    return (v - v[zero]).tolist(), (force - force[zero]).tolist()


@settings(deadline=None, max_examples=40)
@given(curves(), st.lists(st.floats(-6.0, 6.0), min_size=1, max_size=6))
def test_damper_curve_is_the_monotone_cubic(curve, at):
    velocities, forces = curve
    model = Model(with_damper(velocities, forces))
    for velocity in [*at, *velocities]:
        # the strut's velocity is itself rounded to 1e-15 of some metres per second, and slopes go
        # up to 9e4 N s/m
        expected = expected_curve(velocities, forces, velocity)
        assert damper_force(model, velocity) == pytest.approx(expected, rel=1e-12, abs=1e-9)


def test_damping_at_rest_is_the_slope_of_the_curve():
    """Rest is a knot of nearly every table: the derivative there must not fall between segments."""
    model = Model(with_damper(VELOCITIES, FORCES))
    slope = float(PchipInterpolator(VELOCITIES, FORCES).derivative()(0.0))
    names = list(model.equations.SIGNALS)
    by_state = model.evaluate("signals_jacobian", model.design_state)
    row = {name: by_state[names.index(name), 2] for name in ("damper_force", "strut_velocity")}
    assert row["damper_force"] == pytest.approx(-slope * row["strut_velocity"], rel=1e-12)
    linear = Model(changed(strut={"damper_rate_N_s_per_m": slope}, tyre={"lifts_off": True}))
    found, expected = (np.sort(m.eigenvalues(m.design_state)) for m in (model, linear))
    assert found == pytest.approx(expected, rel=1e-11)


def test_ways_to_say_where_the_spring_is_free():
    slide = CAR.strut.spring_free_slide_mm
    length = CAR.strut.length_max_mm - slide
    design = 1000 * CAR.hardpoints.distance("ball_joint", "strut_top")
    rate = CAR.strut.spring_rate_N_per_m / 1000
    ways = [
        {"spring_free_length_mm": length},
        {"spring_force_at_design_N": rate * (length - design)},
    ]
    for way in ways:
        car = changed(strut={"spring_free_slide_mm": None} | way)
        # one rounding of a length below 1 m, and one of a force of some kilonewtons by its rate
        assert car.parameters()["spring_free_slide"] == pytest.approx(slide / 1000, abs=4e-16)
    preloaded = changed(strut={"spring_free_slide_mm": None, "spring_preload_N": 500.0})
    assert preloaded.parameters()["spring_free_slide"] == pytest.approx(-0.02, abs=1e-15)


def test_spring_with_seats_of_its_own(refused):
    seats = {"spring_top": [-30.0, -580.0, 790.0], "spring_seat": [10.0, -650.0, 500.0]}
    car = changed(
        hardpoints=seats, strut={"spring_free_slide_mm": None, "spring_force_at_design_N": 3200.0}
    )
    model = Model(car)
    signals = model.signals(model.design_state)
    distance = np.linalg.norm(np.subtract(*seats.values())) / 1000
    assert signals["spring_length"] == pytest.approx(distance, rel=1e-15)
    assert signals["spring_force"] == pytest.approx(3200.0, rel=1e-12)
    refused(InputError, lambda: changed(hardpoints=seats))


def test_damping_of_the_tyre_follows_the_road(refused):
    model = Model(changed(tyre={"damper_rate_N_s_per_m": 150.0}))
    still = model.signal("tyre_force", model.design_state)
    rising = model.signal("tyre_force", model.design_state, model.inputs({"road_velocity": 2.0}))
    assert rising - still == pytest.approx(300.0, rel=1e-12)  # no camber at design
    refused(
        InputError,
        lambda: kintrafo.simulate(
            model, (0.0, 0.1), model.design_state, inputs={"road_velocity": 1.0}
        ),
    )


@pytest.mark.parametrize(
    "sections",
    [
        {"strut": {"spring_preload_N": 10.0}},
        {"strut": {"spring_free_slide_mm": None}},
        {
            "strut": {
                "spring_free_slide_mm": None,
                "spring_rate_N_per_m": 0.0,
                "spring_force_at_design_N": 100.0,
            }
        },
        {"strut": {"damper_rate_N_s_per_m": None}},
        {"damper": {"velocity_m_per_s": [0.0, 1.0], "force_N": [0.0, 9.0]}},
        {"tyre": {"lifts_off": 1}},
        {"strut": {"friction_velocity_m_per_s": 0.0}},
        {"bump_stop": {"clearance_mm": 10.0}},
        {"hardpoints": {"strut_lower": [-28.0, -585.0, 820.0]}},
        {"hardpoints": {"strut_lower": [-28.0, -585.0, 900.0]}},
    ],
)
def test_refusals(sections, refused):
    refused(InputError, lambda: changed(**sections))


@pytest.mark.parametrize(
    ("velocities", "forces"),
    [
        ([0.0, 1.0], [0.0]),
        ([0.0], [0.0]),
        (list(range(12)), [0.0] * 12),
        ([0.0, 0.0], [0.0, 1.0]),
        ([-1.0, 0.0, 5e-324], [-1.0, 0.0, 1.0]),
        ([-1.0, 1.0], [-1e308, 1e308]),
        ([-1.0, 1.0], [300.0, 500.0]),
        ([-1.0, float("nan")], [0.0, 1.0]),
    ],
)
def test_refused_damper_curves(velocities, forces, refused):
    refused(InputError, lambda: with_damper(velocities, forces))


STARTER = (resources.files(data) / "reference_car.toml").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^(?:# .*\n)*?(# \[\w+\].*\n(?:# .*\n)+)", STARTER, flags=re.MULTILINE)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.split("]")[0][3:])
def test_commented_blocks_of_the_starter_file_are_valid(block, tmp_path):
    text = STARTER.replace(block, re.sub(r"^# ", "", block, flags=re.MULTILINE))
    if "[spring]" in block:
        text = re.sub(r"^spring_(?!top|seat).*\n", "", text, flags=re.MULTILINE)
    if "[damper]" in block:
        text = re.sub(r"^damper_rate_N_s_per_m.*\n", "", text, flags=re.MULTILINE)
    file = tmp_path / "car.toml"
    file.write_text(text, encoding="utf-8")
    model = Model(file)
    assert model.equations.NAME == "macpherson_general"
    assert kintrafo.equilibrium(model) is not None


def test_the_starter_file_shows_all_optional_sections():
    assert [block.split("]")[0][3:] for block in BLOCKS] == [
        "bump_stop",
        "rebound_stop",
        "spring",
        "damper",
    ]
