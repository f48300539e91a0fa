"""Laws of force elements by themselves: value, sign, derivative, and both ends of every curve."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import generator as g
from kintrafo.generator.declare.laws import Stretch
from kintrafo.generator.program import ConstantStage, Program
from oracle import laws as oracle
from oracle.reference import completed, reference_parameters, set_damper_curve, spring_parameters
from scipy.interpolate import PchipInterpolator
from support.symbolic import python
from sympy import Symbol

STATE = {"length": 0.6, "velocity": 0.2, "slide": 0.25}
TABLE = g.DamperTable(name="damper_table", segments=10)

calm = settings(deadline=None, max_examples=60)
velocities = st.floats(-5.0, 5.0)


def programs(law):
    """Return the program of a law's force, and that of its derivatives by length and velocity."""
    program = Program(ConstantStage(()))
    length, velocity, slide = map(Symbol, STATE)
    force = program.define("force", law.force(Stretch(program, "strut", length, velocity, slide)))
    value = program.function("force", "", {"force": force})
    slopes = {
        f"by_{name}": program.tangents(Symbol(name), [force], f"by_{name}")[0] for name in STATE
    }
    return value, program.function("slopes", "", slopes)


def evaluated(function, given, **state):
    """Evaluate a program; parameters that it does not read are left out."""
    return [float(value) for value in python(function)(dict(given) | STATE | state)]


def force_of(law, given):
    """Return the force of a law as a function of length, velocity and slide."""
    function, _ = programs(law)
    return lambda **state: evaluated(function, given, **state)[0]


def test_spring_by_slide_and_by_length():
    """Both push when the element is short: the slide grows as the length falls."""
    rate = g.SpringRate("k", 2e4, "rate")
    free_slide, free_length = g.Displacement("free", 0.05, "slide"), g.Length("free", 0.8, "length")
    by_slide = force_of(g.LinearSpring(rate, free_slide), {"k": 2e4, "free": 0.05})
    by_length = force_of(g.LinearSpring(rate, free_length=free_length), {"k": 2e4, "free": 0.8})
    assert by_slide(slide=0.3) == pytest.approx(5000.0, rel=1e-15)
    assert by_length(length=0.55) == pytest.approx(5000.0, rel=1e-15)
    assert by_slide(slide=0.05) == by_length(length=0.8) == 0.0
    assert by_slide(slide=0.0) == pytest.approx(-1000.0, rel=1e-15)
    assert by_length(length=0.85) == pytest.approx(-1000.0, rel=1e-13)


def test_damper_resists():
    force = force_of(g.LinearDamper(g.DamperRate("c", 1.0, "rate")), {"c": 1500.0})
    assert force(velocity=-2.0) == 3000.0
    assert force(velocity=2.0) == -3000.0
    assert force(velocity=0.0) == 0.0


def test_actuator_is_its_input():
    push = g.Actuator(g.Input("push", "N", "push"))
    assert force_of(push, {"push": 123.0})() == 123.0


# -- friction -------------------------------------------------------------------------------------

FRICTION = g.Friction(g.ForceLevel("level", 80.0, "level"), g.Speed("speed", 0.02, "speed"))


@given(velocities, st.floats(1e-3, 1.0))
@calm
def test_friction_is_a_saturated_odd_resistance(velocity, speed):
    force = force_of(FRICTION, {"level": 80.0, "speed": speed})
    found = force(velocity=velocity)
    # the sine of the angle whose tangent is velocity / speed, to a few roundings
    expected = -80.0 * np.sin(np.arctan2(velocity, speed))
    assert found == pytest.approx(expected, rel=1e-13, abs=1e-300)
    assert found == -force(velocity=-velocity)
    assert abs(found) <= 80.0


def test_friction_at_its_speed_and_at_rest():
    given_values = {"level": 80.0, "speed": 0.02}
    force = force_of(FRICTION, given_values)
    assert force(velocity=0.0) == 0.0
    assert force(velocity=-0.02) == pytest.approx(80.0 / np.sqrt(2.0), rel=1e-15)
    # most steeply at rest: level / speed
    _, slopes = programs(FRICTION)
    assert evaluated(slopes, given_values, velocity=0.0)[1] == pytest.approx(-4000.0, rel=1e-15)


# -- stops ----------------------------------------------------------------------------------------

STOPS = {
    side: g.Stop(
        side=side,
        length=g.Length("touch", 0.6, "length"),
        rate=g.SpringRate("rate", 3e4, "rate"),
        progression=g.Progression("progression", 2e7, "progression"),
    )
    for side in ("bump", "rebound")
}
STOP = {"touch": 0.6, "rate": 3e4, "progression": 2e7}


@pytest.mark.parametrize(("side", "sense"), [("bump", 1.0), ("rebound", -1.0)])
def test_stops_act_on_their_side_only(side, sense):
    force = force_of(STOPS[side], STOP)
    _, slopes = programs(STOPS[side])
    for depth in (1e-12, 1e-4, 0.01, 0.05):
        pressed, free = 0.6 - sense * depth, 0.6 + sense * depth
        assert force(length=free) == 0.0
        assert evaluated(slopes, STOP, length=free) == [0.0, 0.0, 0.0]
        x = sense * (0.6 - pressed)
        assert force(length=pressed) == pytest.approx(sense * (3e4 * x + 2e7 * x**3), rel=1e-14)
        # stiffer the further it is pressed in, on either side
        rigidity = -evaluated(slopes, STOP, length=pressed)[0]
        assert rigidity == pytest.approx(3e4 + 6e7 * x**2, rel=1e-14)
    assert force(length=0.6) == 0.0
    # at first touch the rigidity is that of the free side
    assert evaluated(slopes, STOP, length=0.6) == [0.0, 0.0, 0.0]


def test_names_of_signals():
    assert [stop.signal for stop in STOPS.values()] == ["bump_stop_force", "rebound_stop_force"]
    assert [stop.meaning for stop in STOPS.values()] == [
        "force of the bump stop",
        "force of the rebound stop",
    ]
    assert TABLE.signal == g.LinearDamper.signal  # shown as one force


# -- the damper's table ---------------------------------------------------------------------------


def table(count, seed):
    """Return a curve with some knots, not always rising, and the parameters that describe it."""
    rng = np.random.default_rng(seed)
    knots = np.cumsum(rng.uniform(0.02, 0.6, count)) - 1.2
    curve = PchipInterpolator(knots, np.cumsum(rng.uniform(-200.0, 500.0, count)))
    parameters = completed(reference_parameters())
    set_damper_curve(parameters, curve)
    return curve, {p.name: parameters[p.name] for p in TABLE.numbers}


CURVES = [(count, seed) for count in (2, 5, 11) for seed in range(3)]


@pytest.mark.parametrize(("count", "seed"), CURVES)
def test_table_is_the_curve_with_straight_ends(count, seed):
    curve, parameters = table(count, seed)
    force = force_of(TABLE, parameters)
    _, slopes = programs(TABLE)
    middles = [0.5 * (a + b) for a, b in pairwise(curve.x)]
    for v in (*np.linspace(-4.0, 4.0, 21), *middles):
        inside = np.clip(v, curve.x[0], curve.x[-1])
        slope = float(curve.derivative()(inside))
        expected = float(curve(inside)) + slope * (v - inside)
        # Sums of up to ten cubics of some hundred newtons; 2e-13 relative to the largest force.
        assert force(velocity=-v) == pytest.approx(expected, rel=1e-12, abs=1e-9)
        by_length, by_velocity, by_slide = evaluated(slopes, parameters, velocity=-v)
        assert by_velocity == pytest.approx(-slope, rel=1e-11, abs=1e-8)
        assert by_length == by_slide == 0.0


@pytest.mark.parametrize(("count", "seed"), CURVES)
def test_table_is_smooth_at_its_knots(count, seed):
    """Value and slope at each knot, and beside it, are those of the curve: no jump, no gap."""
    curve, parameters = table(count, seed)
    force = force_of(TABLE, parameters)
    _, slopes = programs(TABLE)
    derivative = curve.derivative()
    for knot in curve.x:
        for v in (knot, np.nextafter(knot, 9.0), np.nextafter(knot, -9.0)):
            assert force(velocity=-v) == pytest.approx(float(curve(knot)), rel=1e-12, abs=1e-9)
            found = evaluated(slopes, parameters, velocity=-v)[1]
            # Rounding of a coefficient over the width of its segment, 0.02 m/s at least.
            assert found == pytest.approx(-float(derivative(knot)), rel=1e-10, abs=1e-8)


@given(velocities, st.integers(0, 50))
@calm
def test_table_is_that_of_the_oracle(velocity, seed):
    """With coefficients of no interpolation at all, as no program of ours would write them."""
    rng = np.random.default_rng(seed)
    names = [p.name for p in TABLE.numbers]
    parameters = {name: rng.uniform(-300.0, 300.0) for name in names}
    knots = np.cumsum(rng.uniform(0.1, 0.5, 11)) - 1.5
    parameters |= {f"damper_table_knot_{i}": knots[i] for i in range(11)}
    parameters |= {
        f"damper_table_inverse_width_{i}": 1.0 / (knots[i + 1] - knots[i]) for i in range(10)
    }
    expected = oracle.damper_curve(parameters)(-velocity)
    # sums of up to forty terms of up to 300 N
    assert force_of(TABLE, parameters)(velocity=velocity) == pytest.approx(
        expected, rel=1e-11, abs=1e-9
    )


def test_table_without_force():
    """The defaults are no damper at all."""
    parameters = {p.name: p.default for p in TABLE.numbers}
    force = force_of(TABLE, parameters)
    assert [force(velocity=v) for v in (-3.0, -1e-9, 0.0, 1e-9, 3.0)] == [0.0] * 5
    assert len(parameters) == 3 + 11 + 4 * 10


SPRING = g.SpringTable(name="spring_table", segments=10)


def spring(seed):
    """Return a curve of a spring about 0.6 m, and no rate beside it."""
    parameters = completed(reference_parameters()) | {"spring_rate": 0.0}
    return parameters | spring_parameters(np.random.default_rng(seed), 0.6)


@pytest.mark.parametrize("seed", range(3))
def test_a_spring_of_lengths_is_that_of_the_oracle(seed):
    """Value and slope, at the knots as well: a spring that is shorter pushes more."""
    parameters = spring(seed)
    force, (_, slopes) = force_of(SPRING, parameters), programs(SPRING)
    knots = [parameters[f"spring_table_knot_{i}"] for i in range(SPRING.segments + 1)]
    assert knots[0] > knots[-1]
    h = 1e-8
    for length in (*np.linspace(0.45, 0.75, 13), *knots):
        expected = oracle.spring_force(parameters, length)
        # sums of up to ten cubics of some thousand newtons
        assert force(length=length) == pytest.approx(expected, rel=1e-12, abs=1e-9)
        by_length, by_velocity, by_slide = evaluated(slopes, parameters, length=length)
        # differences over 1e-8 m: roundings of 1e-12 N and of 1e-16 m by that are some newtons per
        # metre, and so is what a slope changes by between knots of which two are all but one
        around = [oracle.spring_force(parameters, length + sense * h) for sense in (1.0, -1.0)]
        assert by_length == pytest.approx((around[0] - around[1]) / (2.0 * h), rel=1e-3, abs=50.0)
        assert by_length < 1e-9
        assert by_velocity == by_slide == 0.0


def test_a_spring_of_lengths_without_force():
    force = force_of(SPRING, {p.name: p.default for p in SPRING.numbers})
    assert [force(length=length) for length in (0.1, 0.6, 3.0)] == [0.0] * 3


def test_a_twist_has_no_lengths(refused):
    ground, crank = g.Ground("ground", 1), g.Body("crank", 1.0, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    axis = g.Line(g.Point("pivot", (0.0, 0.0, 0.0), "pivot"), g.UP)
    hinge = g.Revolute("hinge", ground, crank, axis=axis)
    refused(g.DeclarationError, lambda: g.ForceElement("coil", g.AlongHinge(hinge), (SPRING,)))


@pytest.mark.parametrize(
    "law",
    [
        g.LinearSpring(g.SpringRate("rate", 3e4, "rate"), g.Displacement("touch", 0.61, "slide")),
        g.LinearSpring(g.SpringRate("rate", 3e4, "rate"), free_length=STOPS["bump"].length),
        g.LinearDamper(g.DamperRate("rate", 3e4, "rate")),
        FRICTION,
        *STOPS.values(),
        TABLE,
    ],
    ids=lambda law: type(law).__name__,
)
def test_slopes_are_the_differences_of_the_force(law):
    """Away from kinks: a central difference of the sixth order, good to 1e-9."""
    given_values = STOP | {"level": 80.0, "speed": 0.3, "touch": 0.61} | table(11, 1)[1]
    value, slopes = programs(law)
    for length in (0.57, 0.64):
        for velocity in (-0.93, 0.41):
            state = {"length": length, "velocity": velocity, "slide": 0.85 - length}
            found = evaluated(slopes, given_values, **state)
            for name, slope in zip(STATE, found, strict=True):
                h = 2e-3
                expected = (
                    sum(
                        weight
                        * evaluated(value, given_values, **state | {name: state[name] + k * h})[0]
                        for k, weight in (
                            (-3, -1 / 60),
                            (-2, 3 / 20),
                            (-1, -3 / 4),
                            (1, 3 / 4),
                            (2, -3 / 20),
                            (3, 1 / 60),
                        )
                    )
                    / h
                )
                assert slope == pytest.approx(expected, rel=1e-8, abs=1e-6)
