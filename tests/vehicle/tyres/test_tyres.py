"""Tyres of the Magic Formula on arrays, against the printed equations and physics."""

import itertools

import kintrafo
import numpy as np
import pytest
from cars.tyre_files import FILES, NEWER, with_values
from oracle import magic_formula as oracle

FIELDS = ("fx", "fy", "mx", "my", "mz", "slip_stiffness", "cornering_stiffness", "trail")


@pytest.fixture(scope="session")
def tyre_of(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tyres")

    def tyre(text):
        path = folder / f"{abs(hash(text))}.tir"
        path.write_text(text, encoding="utf-8")
        return kintrafo.tyres.load(path)

    return tyre


LOADS, ANGLES, SLIPS = (300.0, 4000.0, 8500.0), (-0.4, -0.06, 0.003, 0.15), (-0.7, -0.04, 0.1)
CAMBERS, SPEEDS, PRESSURES = (-0.15, 0.0, 0.06), (16.7, -5.0, 45.0), (220e3, 170e3, 300e3)


@pytest.mark.parametrize("name", FILES)
def test_forces_and_moments_are_those_of_the_printed_equations(name, tyre_of):
    """But for the 1e-6 N that are added to a load that divides: 3e-9 of 300 N."""
    tyre, p = tyre_of(FILES[name]), oracle.coefficients(FILES[name])
    with_pressure = "NOMPRES" in p
    states = list(itertools.product(LOADS, ANGLES, SLIPS, CAMBERS))
    random = np.random.default_rng(3)
    speeds, pressures = (random.choice(v, len(states)) for v in (SPEEDS, PRESSURES))
    load, angle, slip, camber = np.array(states).T
    found = tyre.evaluate(
        load, angle, slip, camber, speed=speeds, pressure=pressures if with_pressure else None
    )
    expected = np.array(
        [
            [float(x) for x in oracle.evaluate(p, *state, speed, pressure, tyre.form.angle)]
            for state, speed, pressure in zip(states, speeds, pressures, strict=True)
        ]
    )
    for i, field in enumerate(FIELDS):
        scale = np.max(np.abs(expected[:, i]))
        # at slips of some 1e-4 the friction ellipse passes into its slope at zero
        bound = 1e-3 if name == "ellipse" else 1e-8
        np.testing.assert_allclose(
            getattr(found, field), expected[:, i], rtol=1e-8, atol=bound * scale, err_msg=field
        )


def test_the_loaded_radius_carries_the_load(tyre_of):
    p, tyre = oracle.coefficients(NEWER), tyre_of(NEWER)
    for load, speed, pressure in ((500.0, 10.0, 200e3), (4000.0, 16.7, 220e3), (8000.0, 50.0, 3e5)):
        found = tyre.evaluate(load, 0.05, 0.02, speed=speed, pressure=pressure)
        expected = oracle.loaded_radius(p, load, found.fx, found.fy, 0.02, speed, pressure)
        assert found.loaded_radius == pytest.approx(float(expected), abs=1e-12)


def test_a_table_of_stiffness_is_the_slope(tyre_of):
    for name, text in FILES.items():
        tyre, step = tyre_of(text), 1e-4
        loads = np.array([1500.0, 4000.0])
        around = [tyre.evaluate(loads, sign * step) for sign in (-1, 1)]
        slope = -(around[1].fy - around[0].fy) / (2.0 * step)
        stiffness = tyre.evaluate(loads).cornering_stiffness
        # shifts move the point of greatest slope by some hundredths
        np.testing.assert_allclose(slope, stiffness, rtol=0.03, err_msg=name)
        along = [tyre.evaluate(loads, 0.0, sign * step) for sign in (-1, 1)]
        slope = (along[1].fx - along[0].fx) / (2.0 * step)
        np.testing.assert_allclose(
            slope, tyre.evaluate(loads).slip_stiffness, rtol=0.03, err_msg=name
        )


@pytest.mark.parametrize("name", FILES)
def test_the_mirror_image_does_the_mirrored(name, tyre_of):
    tyre = tyre_of(FILES[name])
    other = tyre.on("right")
    assert tyre.on("left") is tyre
    assert (other.side, other.mirrored()) == ("right", tyre)
    angles, slips, cambers = np.meshgrid([-0.2, 0.0, 0.1], [-0.3, 0.0, 0.05], [-0.1, 0.08])
    here = tyre.evaluate(4500.0, angles, slips, cambers, speed=-8.0)
    there = other.evaluate(4500.0, -angles, slips, -cambers, speed=-8.0)
    for field in ("fx", "my", "trail", "loaded_radius", "relaxation_x", "relaxation_y"):
        np.testing.assert_allclose(getattr(here, field), getattr(there, field), rtol=1e-12)
    for field in ("fy", "mx", "mz"):
        one, two = getattr(here, field), -getattr(there, field)
        np.testing.assert_allclose(one, two, rtol=1e-11, atol=1e-9)


@pytest.mark.parametrize("name", FILES)
def test_a_sliding_tyre_takes_power(name, tyre_of):
    """Without shifts, and on a wheel upright, the forces oppose the slip velocities everywhere."""
    keys = ("PHX1", "PHX2", "PVX1", "PVX2", "PHY1", "PHY2", "PVY1", "PVY2", "RHX1", "RHY1", "RHY2",
            "RVY1", "RVY2")  # fmt: skip
    there = {key: 0.0 for key in keys if f"\n{key} " in FILES[name]}
    tyre = tyre_of(with_values(FILES[name], **there))
    angles, slips = np.meshgrid(np.linspace(-0.5, 0.5, 21), np.linspace(-1.0, 1.0, 21))
    found = tyre.evaluate(4000.0, angles, slips)
    # slip velocity over |Vx|: -kappa along, tan(alpha) across
    power = found.fx * -slips + found.fy * np.tan(angles)
    assert np.all(power <= 0.0)
    assert np.all(found.fx**2 + found.fy**2 <= (1.25 * 4000.0) ** 2)


@pytest.mark.parametrize("name", FILES)
def test_no_load_no_force_and_all_of_it_is_smooth_at_zero(name, tyre_of):
    tyre = tyre_of(FILES[name])
    loads = np.array([0.0, 1e-9, 1e-3, 1.0])
    found = tyre.evaluate(loads, 0.1, 0.05, 0.02)
    for field in ("fx", "fy", "mx", "my", "mz"):
        values = getattr(found, field)
        assert np.isfinite(values).all()
        # but rolling resistance, whose load has the power 0.88
        bound = 0.1 * loads**0.8 + 1e-6 if field == "my" else 1.6 * loads
        assert np.all(np.abs(values) <= bound), field


def test_rolling_backward_turns_what_depends_on_the_way(tyre_of):
    tyre = tyre_of(NEWER)
    ahead, back = tyre.evaluate(4000.0, 0.05, speed=10.0), tyre.evaluate(4000.0, 0.05, speed=-10.0)
    assert back.fy == ahead.fy
    assert back.trail == -ahead.trail
    assert back.my == -ahead.my
    assert ahead.my < 0.0 < back.my
    # the speed of the tread, by which a tyre grows, is that of the wheel and what slip adds to it
    grown = (tyre.evaluate(0.0, slip=s, speed=v).loaded_radius for s, v in ((0.3, 40), (-0.3, -40)))
    assert len(set(map(float, grown))) == 1


def test_ranges_are_kept_and_told(tyre_of):
    tyre = tyre_of(NEWER)
    assert tyre.ranges["slip_angle"] == (-0.6, 0.6)
    found = tyre.evaluate([100.0, 4000.0, 12000.0], [0.1, 0.9, 0.1], camber=0.0)
    at_ends = tyre.evaluate([100.0, 4000.0, 9000.0], [0.1, 0.6, 0.1])
    np.testing.assert_array_equal(found.fy, at_ends.fy)
    np.testing.assert_array_equal(found.fz, [100.0, 4000.0, 12000.0])
    assert {k: v.tolist() for k, v in found.outside.items()} == {
        "load": [False, False, True],
        "slip_angle": [False, True, False],
    }
    beyond = tyre.evaluate(12000.0, 0.1, extrapolate=True)
    assert beyond.outside == {}
    assert beyond.fy != at_ends.fy[2]


def test_relaxation_lengths(tyre_of):
    tyre = tyre_of(NEWER)
    found = tyre.evaluate(4000.0)
    assert found.relaxation_x == pytest.approx(94000.0 / 360000.0)
    assert found.relaxation_y == pytest.approx(found.cornering_stiffness / 130000.0)
    older = tyre_of(FILES["PAC2002"]).evaluate(4000.0)
    assert older.relaxation_x == pytest.approx(1.9 * 0.316)
    assert older.relaxation_y == pytest.approx(2.2 * np.sin(2 * np.arctan(1 / 1.8)) * 0.316)


@pytest.mark.parametrize(
    "arguments",
    [
        {"load": -1.0},
        {"load": float("nan")},
        {"load": "much"},
        {"load": 4000.0, "slip_angle": 1.6},
        {"load": [1.0, 2.0], "slip": [0.1, 0.2, 0.3]},
        {"load": 4000.0, "pressure": 0.0},
        {"load": 4000.0, "extrapolate": 1},
    ],
)
def test_arguments_are_refused_by_name(tyre_of, arguments, refused):
    refused(kintrafo.InputError, lambda: tyre_of(NEWER).evaluate(**arguments))
    if "pressure" in arguments:
        refused(kintrafo.InputError, lambda: tyre_of(FILES["PAC2002"]).evaluate(**arguments))


def test_the_free_radius_is_the_loaded_one_without_load():
    tyre = kintrafo.tyres.load("passenger_205_55")
    loaded = float(tyre.evaluate(1e-9, speed=0.0, extrapolate=True).loaded_radius)
    assert tyre.free_radius == pytest.approx(loaded, abs=1e-12)
    assert tyre.free_radius < tyre.radius - 9e-4  # Q_RE0 is 0.997
