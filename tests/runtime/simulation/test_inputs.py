"""Inputs over time are what was given: between samples, of functions, and at every step."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from kintrafo import InputError, Model, Samples, System, ensemble, equilibrium, rest, simulate
from kintrafo.generated import front_axle
from kintrafo.simulation.interpolation import curves
from kintrafo.simulation.signals import time_inputs
from kintrafo.simulation.solvers import native_available
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

MODEL = Model("reference_car")
WITH_ROAD_VELOCITY = Model("offset_strut_car")
BACKENDS = ["scipy", *(["sundials"] if native_available() else [])]


@st.composite
def samples(draw):
    size = draw(st.integers(2, 20))
    # steps from a thousandth to all of the longest: with less, h^2 is near the rounding of t^2
    steps = draw(st.lists(st.floats(1e-3, 1.0), min_size=size - 1, max_size=size - 1))
    value = st.one_of(st.floats(-1.0, 1.0), st.sampled_from([0.0, 1.0, -0.5]))
    values = draw(st.lists(value, min_size=size, max_size=size))
    return np.concatenate(([0.0], np.cumsum(steps))), np.array(values)


class TestBetweenSamples:
    @pytest.mark.parametrize("accelerates", [False, True])
    @given(samples())
    def test_no_sample_is_missed_and_no_neighbour_left_behind(self, accelerates, drawn):
        times, values = drawn
        (curve,) = curves(times, values, "monotone", accelerates=accelerates)
        # Horner's rule at the end of an interval of width h takes a h^3 + b h^2 + d h + e, none of
        # them more than twelve times the change: a few roundings of that; and where three cubics
        # meet between two samples is known as well as times are
        resolution = 2.0**-50 * times[-1] / np.diff(times).min()
        # what is below the smallest normal number is rounded to steps of 5e-324
        rounding = (1e-14 + resolution) * np.abs(values).max() + np.finfo(np.float64).tiny
        assert np.abs(curve(times) - values).max() <= rounding
        places = np.linspace(times[:-1], times[1:], 33)
        between = curve(places)
        low, high = np.minimum(values[:-1], values[1:]), np.maximum(values[:-1], values[1:])
        assert (between >= low - rounding).all()
        assert (between <= high + rounding).all()

    @pytest.mark.parametrize(("accelerates", "order"), [(False, 1), (True, 2)])
    @given(samples())
    def test_what_a_model_takes_is_continuous(self, accelerates, order, drawn):
        times, values = drawn
        (curve,) = curves(times, values, "monotone", accelerates=accelerates)
        derivative = curve.derivative(order)
        width = np.diff(derivative.x)[:-1]
        ends = np.zeros(width.size)
        for row in derivative.c[:, :-1]:
            ends = ends * width + row
        jumps = np.abs(ends - derivative.c[-1, 1:])
        # values / h^2 at the shortest h of 1e-3 amplify a rounding of 1e-16 to 1e-10, of what may
        # be as large as values / h^order; where a monotone cubic jumps, it does so by all of it
        assert jumps.size == 0 or jumps.max() <= 1e-8 * max(1.0, np.abs(derivative.c).max())

    @pytest.mark.parametrize("between", ["monotone", "spline", "linear"])
    @pytest.mark.parametrize("accelerates", [False, True])
    def test_straight_lines_stay_straight(self, between, accelerates):
        times = np.array([0.0, 0.25, 0.5, 2.0, 4.0])
        (curve,) = curves(times, 1.0 + 0.5 * times, between, accelerates=accelerates)
        places = np.linspace(0.0, 4.0, 101)
        # numbers of few digits, so that differences and slopes are exact
        assert curve(places) == pytest.approx(1.0 + 0.5 * places, rel=1e-15)
        assert curve(places, 1) == pytest.approx(np.full(101, 0.5), rel=1e-14)
        assert np.abs(curve(places, 2)).max() < 1e-13

    def test_a_ramp_stays_a_ramp(self):
        """A cubic spline through these drives over a road from -22 to +1201 mm."""
        road = ([0, 0.1, 0.12, 1], [0, 0, 0.02, 0.02])
        rack = ([0, 0.5, 1, 2], [0, 0, 0.04, 0.04])
        result = simulate(
            MODEL, (0, 1), equilibrium(MODEL), inputs={"road_height": road, "rack_position": rack}
        )
        height, position = result.inputs.T[[4, 0]]
        assert (height.min(), height.max()) == (0.0, 0.02)
        assert (position.min(), position.max()) == (0.0, 0.04)
        column = MODEL.input_names.index("rack_velocity")
        # a monotone cubic over a step of the rack is at most half as fast again as a line, an eased
        # one, with its acceleration over three quarters of the time, a little more
        assert 0.08 < result.inputs[:, column].max() < 2.0 * 0.08

    def test_velocities_and_accelerations_belong_to_the_position(self):
        times = np.linspace(0.0, 1.0, 21)
        rack = 0.01 * np.sin(5.0 * times)
        given_inputs = time_inputs(MODEL, {"rack_position": (times, rack)}, (0.0, 1.0))
        (segment,) = given_inputs.segments
        fine = np.linspace(0.0, 1.0, 20001)
        position, velocity, acceleration = given_inputs.table(fine, segment)[:, :3].T
        step = fine[1]
        gained = np.cumsum((velocity[1:] + velocity[:-1]) / 2.0) * step
        # trapezoidal rule, h^2 / 12 of the change of the derivative: (5e-5)^2 / 12 of 10 m/s^2
        assert rack[0] + gained == pytest.approx(position[1:], abs=1e-8)
        gained = np.cumsum((acceleration[1:] + acceleration[:-1]) / 2.0) * step
        # and of some 100 m/s^3
        assert velocity[0] + gained == pytest.approx(velocity[1:], abs=1e-6)

    def test_a_kink_is_made_by_a_time_given_twice(self):
        road = ([0, 0.1, 0.1, 0.2, 0.2, 1], [0, 0, 0, 0.02, 0.02, 0.02])
        found = time_inputs(MODEL, {"road_height": road}, (0.0, 1.0))
        assert [segment.start for segment in found.segments] == [0.0, 0.1, 0.2]
        assert found.at(0.15, found.segments[1])[4] == pytest.approx(0.01, rel=1e-12)

    def test_lines_are_cut_where_a_derivative_jumps_that_the_model_takes(self):
        road = Samples([0, 0.1, 0.2, 0.3, 1], [0, 0, 0.01, 0.02, 0.02], "linear")
        found = time_inputs(WITH_ROAD_VELOCITY, {"road_height": road}, (0.0, 1.0))
        assert [segment.start for segment in found.segments] == [0.0, 0.1, 0.3]
        # without the velocity these are kinks, onto which it is enough to step
        (segment,) = time_inputs(MODEL, {"road_height": road}, (0.0, 1.0)).segments
        assert segment.milestones.tolist() == [0.1, 0.3]

    @pytest.mark.parametrize(
        "rack",
        [
            Samples([0, 0.5, 1], [0, 0, 0.01], "linear"),
            ([0, 0.5, 0.5, 1], [0, 0, 0, 0.01]),
            lambda t: abs(t - 0.5),
            PPoly([[1.0, 2.0], [0.0, 0.5]], [0.0, 0.5, 1.0]),
        ],
    )
    def test_a_kink_of_the_rack_is_refused(self, rack, refused):
        refused(InputError, lambda: time_inputs(MODEL, {"rack_position": rack}, (0.0, 1.0)))

    def test_curves_of_scipy_are_taken_as_they_are(self, refused):
        times = np.linspace(0.0, 1.0, 9)
        heights = 0.01 * np.sin(times)
        for curve in (PchipInterpolator(times, heights), CubicSpline(times, heights)):
            found = time_inputs(MODEL, {"road_height": curve}, (0.0, 1.0))
            assert found.at(0.3, found.segments[0])[4] == curve(0.3)
            # a monotone cubic's acceleration jumps at its samples
            rack = time_inputs(MODEL, {"rack_position": curve}, (0.0, 1.0))
            assert (len(rack.segments) > 1) == isinstance(curve, PchipInterpolator)
        quartic = PPoly(np.ones((5, 1)), [0.0, 1.0])
        refused(InputError, lambda: time_inputs(MODEL, {"road_height": quartic}, (0.0, 1.0)))

    def test_a_measured_road_turns_at_its_samples_only(self):
        random = np.random.default_rng(1)
        times = np.linspace(0.0, 1.0, 10_001)
        road = 1e-3 * random.normal(size=times.size)
        (segment,) = time_inputs(MODEL, {"road_height": (times, road)}, (0.0, 1.0)).segments
        turns = np.flatnonzero(np.diff(road[:-1]) * np.diff(road[1:]) < 0.0) + 1
        assert segment.milestones == pytest.approx(times[turns], abs=1e-12)


def bump(start, width, height):
    """A smooth bump: its height times the square of a sine."""

    def at(time):
        inside = start < time < start + width
        return height * np.sin(np.pi * (time - start) / width) ** 2 if inside else 0.0

    return at


class TestFunctions:
    @pytest.mark.parametrize(("frequency", "end"), [(1.0, 64.0), (2.0, 32.0), (8.0, 8.0)])
    def test_no_oscillation_looks_like_a_constant(self, frequency, end):
        rate = 2.0 * np.pi * frequency
        found = time_inputs(
            MODEL, {"rack_position": lambda t: 0.005 * np.cos(rate * t)}, (0.0, end)
        )
        times = np.linspace(0.0, end, 1237)
        position, velocity, acceleration = found.table(times, found.segments[0])[:, :3].T
        # the fit's tolerance is 1e-10 of the range, checked between all knots but not everywhere;
        # its second derivative is good to the square root of that, and at the ends, where a spline
        # is worst, to ten times this
        wave = 0.005 * np.cos(rate * times)
        assert position == pytest.approx(wave, abs=1e-11)
        assert velocity == pytest.approx(-0.005 * rate * np.sin(rate * times), abs=1e-8 * rate)
        assert acceleration == pytest.approx(-(rate**2) * wave, abs=1e-4 * 0.005 * rate**2)
        # one milestone for each turn of the position
        count = time_inputs(MODEL, {"road_height": lambda t: np.cos(rate * t)}, (0.0, end))
        assert count.segments[0].milestones.size == 2 * frequency * end - 1

    @pytest.mark.parametrize("start", np.random.default_rng(7).uniform(0.1, 19.8, 12))
    def test_a_short_bump_is_seen(self, start):
        result = simulate(
            MODEL, (0, 20), equilibrium(MODEL), inputs={"road_height": bump(start, 0.1, 0.02)}
        )
        after = np.linspace(start, start + 0.2, 401)
        expected = solve_ivp(
            lambda t, y: MODEL.equations.rhs(
                y, [0, 0, 0, 0, bump(start, 0.1, 0.02)(t)], MODEL.constants
            ),
            (start, start + 0.2),
            equilibrium(MODEL),
            "DOP853",
            t_eval=after,
            rtol=1e-8,
            atol=1e-11,
            max_step=0.01,
        )
        height = MODEL.signals(expected.y.T)["wheel_center_z"]
        # the result has the steps' ends only: some ten of them are in the bump, and the top between
        # two of them is lower by one part in a hundred
        assert np.ptp(result.signals["wheel_center_z"]) == pytest.approx(np.ptp(height), rel=0.03)

    def test_a_step_is_asked_for_to_see_what_is_shorter(self):
        """Below a millisecond: `max_step` limits the time between two calls of a function."""
        for start in (0.70003, 0.3007, 1.2222):
            spike = bump(start, 1e-4, 1.0)
            found = time_inputs(MODEL, {"strut_force": spike}, (0.0, 2.0), max_step=4e-5)
            top = found.at(start + 5e-5, found.segments[0])[3]
            assert top == pytest.approx(1.0, abs=1e-9)

    def test_fast_oscillations_are_resolved_or_refused(self, monkeypatch):
        """Calls come at irregular times: nothing that repeats itself hides between them."""
        monkeypatch.setattr("kintrafo.simulation.fitting._MOST_KNOTS", 10_000)
        for frequency in (1e3, 2e3, 1e4):
            with pytest.raises(InputError, match="road_height"):
                time_inputs(
                    MODEL,
                    {"road_height": lambda t, f=frequency: np.sin(2.0 * np.pi * f * t)},
                    (0.0, 1.0),
                )

    def test_a_kink_of_a_road_is_followed(self):
        found = time_inputs(MODEL, {"road_height": lambda t: abs(np.sin(t))}, (0.0, 10.0))
        times = np.linspace(0.0, 10.0, 777)
        assert found.table(times, found.segments[0])[:, 4] == pytest.approx(
            np.abs(np.sin(times)), abs=1e-9
        )

    def test_a_constant_is_a_constant(self):
        found = time_inputs(MODEL, {"rack_position": lambda _: 0.01}, (0.0, 10.0))
        assert found.variant == "_rack_held"
        assert found.constant[0] == 0.01

    def test_an_error_in_a_users_function_says_where_it_was_called(self):
        with pytest.raises(ZeroDivisionError) as caught:
            time_inputs(MODEL, {"road_height": lambda t: 1.0 / t}, (0.0, 1.0))
        assert "'road_height', at t = 0 s" in caught.value.__notes__[0]

    def test_too_long_for_calls_is_refused(self, refused):
        refused(InputError, lambda: time_inputs(MODEL, {"road_height": np.sin}, (0.0, 1e6)))


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("method", ["BDF", "DormandPrince", "LSODA", "Radau"])
def test_no_step_passes_over_a_turn_of_the_road(backend, method):
    """A pulse in a slow wave, where steps are long: every sample at which the road turns is met."""
    if backend == "sundials" and method in ("LSODA", "Radau"):
        pytest.skip("methods of SciPy")
    times = np.linspace(0.0, 4.0, 2001)
    road = 0.01 * np.sin(0.5 * times)
    road[1201] += 0.005
    result = simulate(
        MODEL, (0.0, 4.0), equilibrium(MODEL), inputs={"road_height": (times, road)},
        method=method, backend=backend, rtol=1e-4, atol=1e-6,
    )  # fmt: skip
    assert {times[1201], times[1202]} <= set(result.t)
    assert result.inputs[:, 4].max() == road.max()


@pytest.mark.skipif(not native_available(), reason="nothing is integrated in C")
def test_steps_pass_over_slow_turns_of_several_inputs():
    """Two roads: waves that turn slowly do not cut the steps, and no pulse on them is missed."""
    axle = System(front_axle)
    start, at = rest(axle, axle.design_state), np.linspace(0.0, 2.0, 201)
    times = np.linspace(0.0, 2.0, 2001)
    accuracy = {"method": "DormandPrince", "rtol": 1e-4, "atol": 1e-6}
    truths = []
    for pulses in ((), (402, 911, 1701)):
        roads = {}
        for side, phase in (("right", 0.0), ("left", 2.0)):
            road = 0.002 * np.sin(20.0 * times + phase)
            for place in pulses:
                road[place : place + 4] += 0.01
            roads[f"{side}_road_height"] = (times, road)
        truth = simulate(
            axle, (0.0, 2.0), start, inputs=roads, method="Verner", t_eval=at, rtol=1e-9, atol=1e-11
        ).y
        found = simulate(axle, (0.0, 2.0), start, inputs=roads, t_eval=at, **accuracy)
        truths.append(np.abs(truth[4:]).max())
        assert np.abs(found.y - truth).max() < 5e-3 * truths[-1]
        whole = simulate(axle, (0.0, 2.0), start, inputs=roads, **accuracy)
        met = np.isin(time_inputs(axle, roads, (0.0, 2.0)).segments[0].milestones, whole.t)
        assert met.any() == bool(pulses)
        in_lanes = ensemble(axle, {}, (0.0, 2.0), start, inputs=roads, rtol=1e-4, atol=1e-6)
        assert set(in_lanes.steps.values.ravel()) == {found.steps}
    assert truths[1] > 2.0 * truths[0]  # which the pulses move


@pytest.mark.skipif(not native_available(), reason="nothing is integrated in C")
@pytest.mark.parametrize("middle", [0.3, 0.31])
def test_a_flat_top_is_not_passed_over(middle):
    """A pulse of 4 ms whose top is flat, beside another road, in steps of 20 ms.

    Its half width would be near its turn; the stages of a step are half of its length apart.
    """
    axle = System(front_axle)

    def pulse(time):
        begins, ends = ((time - middle + side * 2e-3) / 3e-4 for side in (1.0, -1.0))
        return 0.01 * (np.tanh(begins) - np.tanh(ends))

    roads = {"right_road_height": pulse, "left_road_height": lambda t: 1e-6 * np.sin(3.0 * t)}
    start, span = rest(axle, axle.design_state), (0.0, 1.0)
    coarse = simulate(
        axle, span, start, inputs=roads, method="DormandPrince", rtol=1e-4, atol=1e-6,
        max_step=0.02,
    )  # fmt: skip
    fine = simulate(axle, span, start, inputs=roads, max_step=5e-4)
    found, truth = (np.ptp(one.signals["right_front_wheel_center_z"]) for one in (coarse, fine))
    # the output has the steps' ends only, between which the top is
    assert found == pytest.approx(truth, rel=0.05)


def test_fixed_steps_end_at_fast_turns_alone():
    times = np.linspace(0.0, 2.0, 2001)
    road = 0.005 * np.sin(20.0 * times)
    road[701] += 0.005
    segment = time_inputs(MODEL, {"road_height": (times, road)}, (0.0, 2.0)).segments[0]
    assert segment.milestones.size > 10
    np.testing.assert_allclose(segment.milestones_of(5e-3), times[701:703], atol=2e-3)
    assert segment.milestones_of(1e-5).size == 0


@pytest.mark.parametrize("backend", BACKENDS)
def test_backward_over_the_same_turns(backend):
    road = ([0.0, 0.1, 0.12, 0.14, 0.2], [0.0, 0.0, 0.01, 0.0, 0.0])
    result = simulate(
        MODEL, (0.2, 0.0), equilibrium(MODEL), inputs={"road_height": road}, backend=backend,
        rtol=1e-4,
    )  # fmt: skip
    assert 0.12 in result.t
    assert result.t[-1] == 0.0
