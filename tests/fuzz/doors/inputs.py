"""Inputs of a simulation: samples, functions of time, roads.

What is simulated is compared with SciPy's integration of the same right-hand side, with steps short
enough for the input, which is evaluated apart from kintrafo: a function by calling it, samples by
SciPy's interpolation; and no input may leave the range of the samples on either side.
"""

import numpy as np
from kintrafo import Model, Samples, equilibrium, simulate
from kintrafo.simulation.signals import time_inputs
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PchipInterpolator

from ..attempts import WrongError

SHORT = 10
_MODEL = Model("reference_car")
_REST = np.asarray(equilibrium(_MODEL))
_ROAD = _MODEL.input_names.index("road_height")
# Of the wheel's path, an integration at rtol 1e-8 beside one at 1e-10: some hundred tolerances, and
# the fit of a function to 1e-10 of its range
_TOLERANCE = 1e-5


def attempt(random):
    kind = random.choice(["samples", "function", "awkward"], p=[0.4, 0.4, 0.2])
    {"samples": _samples, "function": _function, "awkward": _awkward}[kind](random)


def _samples(random):
    size = int(random.integers(2, 40))
    end = float(10.0 ** random.uniform(-1.0, 0.5))
    times = np.concatenate(([0.0], np.sort(random.uniform(0.0, end, size - 2)), [end]))
    heights = random.choice([0.0, 0.01, 0.02], size) if random.random() < 0.5 else (
        0.01 * random.normal(size=size)
    )  # fmt: skip
    between = str(random.choice(["monotone", "linear", "spline"]))
    _check_range(times, heights, between, "road_height")
    if between != "linear":
        _check_range(times, heights, between, "rack_position")
    if size > 12 or np.abs(heights).max() > 0.03:
        return
    true = {
        "monotone": PchipInterpolator,
        "spline": CubicSpline,
        "linear": lambda t, h: lambda at: np.interp(at, t, h),
    }[between](times, heights)
    _check_motion(Samples(times, heights, between), true, times, end)


def _check_range(times, values, between, name):
    given = time_inputs(_MODEL, {name: Samples(times, values, between)}, (0.0, times[-1]))
    column = _MODEL.input_names.index(name)
    for segment in given.segments:
        inside = np.linspace(segment.start, segment.end, 200)
        found = given.table(inside, segment)[:, column]
        after = np.clip(np.searchsorted(times, inside), 1, times.size - 1)
        ends = np.sort([values[after - 1], values[after]], axis=0)
        # a time between two samples that are close is known to its rounding only
        close = 1e-15 * times[-1] / np.diff(times).min() * np.ptp(values) + 1e-15
        outside = np.maximum(ends[0] - found, found - ends[1]).max()
        if between != "spline" and outside > close:
            raise WrongError(f"{name} leaves the range of its neighbours by {outside:g} m")


def _function(random):
    end = float(10.0 ** random.uniform(-1.0, 0.7))
    size = 0.02 * random.uniform(0.1, 1.0)
    start, width = random.uniform(0.0, 0.9 * end), random.uniform(0.02, 0.3)
    frequency, phase = 10.0 ** random.uniform(-1.0, 1.3), random.uniform(0.0, 6.0)

    def wave(t):
        return size * np.sin(2.0 * np.pi * frequency * t + phase)

    def bump(t):
        inside = start < t < start + width
        return size * np.sin(np.pi * (t - start) / width) ** 2 if inside else 0.0

    true = [wave, bump, lambda t: wave(t) + bump(t), lambda t: abs(wave(t))][random.integers(4)]
    given = time_inputs(_MODEL, {"road_height": true}, (0.0, end))
    for time in random.uniform(0.0, end, 100):
        found = given.at(time, given.segments[0])[_ROAD]
        if abs(found - true(time)) > 1e-9 * size:
            raise WrongError(f"the function is missed by {found - true(time):g} m at {time:g} s")
    if frequency * end < 10.0:
        _check_motion(true, true, [start, start + width], end)


def _check_motion(signal, true, corners, end):
    """Compare the wheel's path at the end, and beside the corners of the input."""
    times = np.unique([*(t for t in corners if 0.0 < t <= end), end])[-5:]
    method = "DormandPrince"
    options = {"rtol": 1e-8, "atol": 1e-11}
    found = simulate(
        _MODEL, (0.0, end), _REST, inputs={"road_height": signal}, t_eval=times, method=method,
        **options,
    )  # fmt: skip

    def rhs(time, state):
        inputs = np.zeros(len(_MODEL.input_names))
        inputs[_ROAD] = true(time)
        return _MODEL.equations.rhs(state, inputs, _MODEL.constants)

    expected = solve_ivp(
        rhs, (0.0, end), _REST, "DOP853", t_eval=times, rtol=1e-10, atol=1e-13, max_step=0.01
    )
    error = np.abs(found.y[0] - expected.y[0]).max()
    if error > _TOLERANCE:
        raise WrongError(f"the arm is off by {error:g} rad")


def _awkward(random):
    """Try what a person may give by mistake: it must be refused, or be harmless."""
    size = int(random.integers(0, 6))
    times = random.choice([0.0, 0.1, 0.5, 1.0, 1.0 + 1e-15, np.nan, 1e300, 1e-300], size)
    if random.random() < 0.7:
        times = np.sort(times)
    values = random.choice([0.0, 0.01, -0.01, 1e-310, 1e308, np.inf, np.nan], size)
    signals = [
        (times, values),
        [values, times],
        (times, values, values),
        Samples(times, values, str(random.choice(["spline", "linear", "cubic", ""]))),
        Samples([0.0, 0.3, 0.3, 1.0], [0.0, 0.0, 0.01, 0.01], "linear"),
        lambda t: 0.01 if t < random.random() else 0.0,
        lambda _: random.normal(),
        lambda _: "0.01",
        lambda _: None,
        lambda t: [t],
        float(random.choice([np.nan, np.inf, 0.01])),
        str(random.choice(["0.01", "road"])),
        None,
        True,
        {},
        CubicSpline([0.0, 1.0], [[0.0, 0.0], [1.0, 1.0]]),
    ]
    name = str(random.choice(["road_height", "rack_position", "rack_velocity", "rod"]))
    signal = signals[random.integers(len(signals))]
    found = simulate(_MODEL, (0.0, 0.2), _REST, inputs={name: signal}, t_eval=[0.2])
    if not (np.isfinite(found.y).all() and np.isfinite(found.inputs).all()):
        raise WrongError("a result that is not finite")
