"""The emitted equations in lanes: elementary functions, and every model against its scalar C."""

import ctypes
import shutil
from dataclasses import replace

import kintrafo
import mpmath
import numpy as np
import pytest
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.simulation.lanes.library import widths
from support import lanes
from support.c_text import EMITTED

pytestmark = [
    pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc"),
    pytest.mark.skipif(not widths(), reason="built without lanes"),
]

DIGITS = 50
ANGLES = 400
LARGEST = 1e6  # greatest angle of elementary.h
TAKEN = "real", "root", "magnitude"
CARS, STATES = 4, 8  # parameter sets of a model, and states of each


@pytest.fixture(scope="module")
def drivers(tmp_path_factory):
    folder = tmp_path_factory.mktemp("drivers")
    return {width: lanes.driver(folder, width) for width in widths()}


def off(exact, found):
    """Return an error in units of the last place."""
    return float(abs(mpmath.mpf(found) - exact) / mpmath.mpf(float(np.spacing(abs(float(exact))))))


def angles(rng):
    """Return angles of all sizes, and ones as near to quarter turns as numbers are."""
    quarters = rng.integers(-600_000, 600_000, ANGLES) * (np.pi / 2)
    sizes = 10.0 ** rng.uniform(-12, np.log10(LARGEST), ANGLES)
    return np.concatenate([rng.uniform(-7.0, 7.0, ANGLES), quarters, sizes, [LARGEST, 0.0]])


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_sine_and_cosine(drivers, name):
    function, exact = getattr(drivers[2], f"lane_{name}"), getattr(mpmath, name)
    with mpmath.workdps(DIGITS):
        for angle in angles(np.random.default_rng(1)).tolist():
            assert off(exact(mpmath.mpf(angle)), function(angle)) <= 1.0, angle


def test_arc_functions(drivers):
    rng = np.random.default_rng(2)
    sizes = 10.0 ** rng.uniform(-8, 8, (ANGLES, 2))
    with mpmath.workdps(DIGITS):
        for y, x in (sizes * rng.choice([-1.0, 1.0], (ANGLES, 2))).tolist():
            found = drivers[2].lane_atan2(y, x)
            assert off(mpmath.atan2(mpmath.mpf(y), mpmath.mpf(x)), found) <= 2.0, (y, x)
        for x in (*rng.uniform(-1.0, 1.0, ANGLES).tolist(), 1.0, -1.0, 1e-9, 1.0 - 1e-15):
            assert off(mpmath.asin(mpmath.mpf(x)), drivers[2].lane_asin(x)) <= 3.0, x


@pytest.mark.parametrize("y", [0.0, -0.0, 1.0, -1.0])
@pytest.mark.parametrize("x", [0.0, -0.0, 1.0, -1.0])
def test_arc_tangent_on_the_axes(drivers, y, x):
    assert drivers[2].lane_atan2(y, x) == np.arctan2(y, x)


def test_what_has_no_sine_is_none(drivers):
    for angle in (np.nextafter(LARGEST, np.inf), -1e300, np.inf, -np.inf, np.nan):
        assert np.isnan(drivers[2].lane_sin(angle)), angle
        assert np.isnan(drivers[2].lane_cos(angle)), angle
    assert np.isnan(drivers[2].lane_asin(np.nextafter(1.0, 2.0)))


def test_exponential_and_logarithm(drivers):
    rng = np.random.default_rng(4)
    exponents = [*rng.uniform(-708.0, 708.0, ANGLES), *rng.uniform(-1.0, 1.0, ANGLES), 0.0, 1e-300]
    near_one = 1.0 + rng.uniform(-1e-3, 1e-3, ANGLES)
    with mpmath.workdps(DIGITS):
        for x in map(float, exponents):
            assert off(mpmath.exp(mpmath.mpf(x)), drivers[2].lane_exp(x)) <= 1.0, x
        for x in map(float, (*10.0 ** rng.uniform(-307, 308, ANGLES), *near_one, 2.0, 1e-10)):
            assert off(mpmath.log(mpmath.mpf(x)), drivers[2].lane_log(x)) <= 1.0, x
    exp, log = drivers[2].lane_exp, drivers[2].lane_log
    assert (exp(-709.0), exp(710.0), exp(-np.inf), exp(np.inf)) == (0.0, np.inf, 0.0, np.inf)
    assert (exp(0.0), log(1.0)) == (1.0, 0.0)
    assert np.isnan([exp(np.nan), *map(log, (0.0, -1.0, np.nan, np.inf, 1e-310))]).all()


def test_powers_of_two(drivers):
    """Functions for the choice of a step size; bounds follow from the degrees of polynomials."""
    values = 10.0 ** np.random.default_rng(3).uniform(-60, 60, 200)
    for value in values.tolist():
        assert abs(drivers[2].lane_log2(value) - np.log2(value)) < 1.2e-4
        power = np.log2(value)
        assert abs(drivers[2].lane_exp2(power) / value - 1.0) < 1e-4


class Both:
    """A model as C for one state, as it is built, and in lanes."""

    def __init__(self, name, drivers):
        kind = ctypes.CFUNCTYPE(ctypes.c_int, *[ctypes.c_void_p] * 4)
        # those of parameters take two pointers, and look at no more
        addresses = EMITTED[name].ADDRESSES
        self.scalar = {function: kind(address) for function, address in addresses.items()}
        self.name, self.drivers, self.lanes = name, drivers, lanes.in_lanes(name)

    def same(self, function, *arguments, size):
        """Demand the same bits of a function; the arguments have a column for each lane."""
        width = arguments[0].shape[1]
        called = getattr(self.lanes, f"{self.name}_{function}_{width}")
        found, status = lanes.call(self.drivers[width], called, *arguments, size=size)
        alone = self.scalar[function]
        for lane in range(width):
            given = [np.ascontiguousarray(a[:, lane]) for a in arguments]
            out = np.zeros(size)
            pointers = [a.ctypes.data for a in (*given, out)]
            expected = alone(*pointers, *[None] * (4 - len(pointers)))
            assert status[lane] == expected, function
            # NaN is equal to NaN here, with any bits
            np.testing.assert_array_equal(found[:, lane], out, strict=True)
        return found

    def bounded(self, signals, *arguments):
        """Demand the same bits of signals with ranges, where no other is evaluated."""
        ranged = [i for i, described in enumerate(signals.values()) if "ranges" in described]
        if not ranged:
            return
        width = arguments[0].shape[1]
        (everything, refused), (found, status) = (
            lanes.call(
                self.drivers[width],
                getattr(self.lanes, f"{self.name}_{function}_{width}"),
                *arguments,
                size=size,
            )
            for function, size in (("signals", len(signals)), ("bounded", len(ranged)))
        )
        np.testing.assert_array_equal(found, everything[ranged], strict=True)
        assert not (status & ~refused).any()  # it has some of the guards


def some_parameters(model, rng, width):
    """Return the defaults in the first lane, and sets near them; some are of no mechanism."""
    defaults = np.array([entry["default"] for entry in model.PARAMETERS.values()])
    spread = rng.choice([0.0, 0.01, 1.0], width, p=[0.2, 0.6, 0.2])
    spread[0] = 0.0
    return defaults[:, None] * (1.0 + spread * rng.standard_normal((defaults.size, width)))


@pytest.mark.parametrize("name", EMITTED)
def test_the_same_bits_as_one_by_one(drivers, name):
    """Every function of a simulation, also of states that are refused, and of NaN."""
    pair = Both(name, drivers)
    for width in widths():
        compare(pair, EMITTED[name], np.random.default_rng(width), width)


def compare(pair, model, rng, width):
    functions = {
        f: len(getattr(model, f).labels)
        for f in ("rhs", "signals", "margins")
        if f in model.ADDRESSES
    }
    functions |= {f"rhs_{variant}": functions["rhs"] for variant in model.HELD_VARIANTS}
    for _ in range(CARS):
        parameters = some_parameters(model, rng, width)
        constants = pair.same("prepare", parameters, size=len(model.CONSTANTS))
        design = pair.same("design_state", parameters, size=len(model.STATE))
        for _ in range(STATES):
            off_design = rng.choice([0.05, 0.5, 5.0], width)
            state = design + off_design * rng.standard_normal(design.shape)
            state[0, -1] = rng.choice([state[0, -1], np.nan])
            inputs = 0.02 * rng.standard_normal((max(1, len(model.INPUTS)), width))
            for function, size in functions.items():
                pair.same(function, constants, state, inputs, size=size)
            pair.bounded(model.SIGNALS, constants, state, inputs)


def test_far_angles_are_those_of_the_c_library():
    """One system alone takes them; the last digit of such an angle is 5e-10 rad."""
    bar = kintrafo.System(EMITTED["four_bar"])
    turns = 2.0 * np.pi * 400_000
    far, near = (
        float(bar.signals(bar.state(crank_angle=angle))["spring_force"])
        for angle in (0.3 + turns, 0.3)
    )
    assert far != near
    assert far == pytest.approx(near, abs=1e-6)  # N; 400 N/m of a length of some 0.3 m


def test_equations_may_name_what_the_headers_do():
    """A mechanism and its angles are called like files, functions and types of lanes."""
    names = dict(zip(("crank_angle", "coupler_angle", "rocker_angle"), TAKEN, strict=True))
    coordinates = (replace(c, name=names[c.name]) for c in FOUR_BAR.coordinates)
    other = replace(FOUR_BAR, name="model", coordinates=tuple(coordinates))
    found = []
    for mechanism, angle in ((FOUR_BAR, "crank_angle"), (other, names["crank_angle"])):
        system = kintrafo.System(kintrafo.compile(mechanism))
        start = system.state(**{angle: 0.3})
        rates = {"spring_rate": [300.0, 400.0]}
        found.append(kintrafo.ensemble(system, rates, (0.0, 0.2), start).final_state.values)
    np.testing.assert_array_equal(*found)
