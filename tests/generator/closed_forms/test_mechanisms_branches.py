"""Branches and dead points of the closed forms, against circles that are cut in many digits.

In the design position an arm is on one side of its rod, and it remains there up to the dead
point. There the formulas end, and the status names it. Just before it a position is worth
half of the digits: that is the geometry, and the model loses no more than that.
"""

from dataclasses import dataclass

import mpmath
import numpy as np
import pytest
from kintrafo.generated import four_bar, slider_crank
from kintrafo.generator.mechanisms.four_bar import MODELS as FOUR_BARS
from kintrafo.generator.mechanisms.slider_crank import MODELS as SLIDER_CRANKS
from mpmath import mpf
from support.models import Built

EPSILON = 2.0**-52


def linkage(crank, coupler, rocker, ground, side):
    """Return a four-bar of given lengths, declared with its crank upright.

    `side` is that of the rocker's pin, seen from the crank's pin towards the rocker's bearing:
    1 left, -1 right.
    """
    pin = np.array([0.0, crank])
    span = np.array([ground, 0.0]) - pin
    distance = np.hypot(*span)
    along = (coupler**2 - rocker**2 + distance**2) / (2.0 * distance)
    off = side * np.sqrt(coupler**2 - along**2)
    meeting = pin + along * span / distance + off * np.array([-span[1], span[0]]) / distance
    changes = {
        "crank_pin_x": 0.0,
        "crank_pin_y": crank,
        "rocker_bearing_x": ground,
        "rocker_bearing_y": 0.0,
        "rocker_pin_x": meeting[0],
        "rocker_pin_y": meeting[1],
    }
    return Built.of(FOUR_BARS[0], four_bar, changes)


def crank_and_slider(crank, rod, side, offset=0.0):
    """Return a slider-crank, declared with its crank upright and its piston in front or behind."""
    changes = {
        "crank_pin_x": 0.0,
        "crank_pin_y": crank,
        "piston_pin_x": side * np.sqrt(rod**2 - (crank - offset) ** 2),
        "piston_pin_y": offset,
    }
    return Built.of(SLIDER_CRANKS[0], slider_crank, changes)


# -- circles in many digits ------------------------------------------------------------------------


@dataclass(frozen=True)
class Exact:
    """The lengths that a linkage has by its parameters, and where its crank's pin is."""

    place: dict[str, tuple[mpf, mpf]]

    @classmethod
    def of(cls, built, *names):
        given = built.parameters
        return cls({n: (mpf(given[f"{n}_x"]), mpf(given[f"{n}_y"])) for n in names})

    def length(self, first, second):
        return mpmath.hypot(*self.between(self.place[first], self.place[second]))

    @staticmethod
    def between(a, b):
        return b[0] - a[0], b[1] - a[1]

    def pin(self, angle):
        """Return the crank's pin, the crank turned from the start."""
        x, y = self.place["crank_pin"]
        c, s = mpmath.cos(mpf(angle)), mpmath.sin(mpf(angle))
        return c * x - s * y, s * x + c * y


def rocker_angle(built, angle, side):
    """Return the turn of the rocker, where the circles of coupler and rocker meet."""
    exact = Exact.of(built, "crank_pin", "rocker_pin", "rocker_bearing")
    coupler = exact.length("crank_pin", "rocker_pin")
    rocker = exact.length("rocker_bearing", "rocker_pin")
    pin, bearing = exact.pin(angle), exact.place["rocker_bearing"]
    span = exact.between(pin, bearing)
    square = span[0] ** 2 + span[1] ** 2
    along = (coupler**2 - rocker**2 + square) / (2 * square)
    off = side * mpmath.sqrt(coupler**2 / square - along**2)
    meeting = pin[0] + along * span[0] - off * span[1], pin[1] + along * span[1] + off * span[0]
    start = exact.between(bearing, exact.place["rocker_pin"])
    now = exact.between(bearing, meeting)
    return mpmath.atan2(
        start[0] * now[1] - start[1] * now[0], start[0] * now[0] + start[1] * now[1]
    )


def piston_slide(built, angle, side):
    """Return the slide of the piston, where the circle of the rod cuts the guide."""
    exact = Exact.of(built, "crank_pin", "piston_pin")
    rod, pin = exact.length("crank_pin", "piston_pin"), exact.pin(angle)
    height = exact.place["piston_pin"][1] - pin[1]
    return pin[0] + side * mpmath.sqrt(rod**2 - height**2) - exact.place["piston_pin"][0]


def reported(built, coordinate, angle):
    """Return a relative coordinate of a model with one degree of freedom."""
    index = list(built.module.RELATIVE_COORDINATES).index(coordinate)
    return float(built("relative_coordinates", np.array([angle, 0.0]))[index])


def off_by(found, expected):
    """Return how far an angle is from another, without whole turns."""
    turn = 2 * mpmath.pi
    difference = mpf(found) - expected
    return float(abs(difference - turn * mpmath.nint(difference / turn)))


# -- branches --------------------------------------------------------------------------------------

TURNS = np.linspace(-np.pi, np.pi, 41)


@pytest.mark.parametrize("side", [1, -1])
def test_the_rocker_stays_on_the_side_of_its_design(side):
    built = linkage(0.1, 0.28, 0.26, 0.3, side)
    for angle in TURNS:
        with mpmath.workdps(40):
            expected = rocker_angle(built, angle, side)
        # 1e-14: some ten roundings, times three where the circles meet at the sharpest angle
        assert off_by(reported(built, "rocker_angle", angle), expected) < 1e-14


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("offset", [0.0, 0.03, -0.02])
def test_the_piston_stays_on_the_side_of_its_design(side, offset):
    built = crank_and_slider(0.04, 0.15, side, offset)
    for angle in TURNS:
        with mpmath.workdps(40):
            expected = float(piston_slide(built, angle, side))
        # a few roundings of 0.15 m
        assert reported(built, "piston_slide", angle) == pytest.approx(expected, abs=1e-15)


# -- dead points -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Dead:
    """A dead point: a linkage that cannot turn all the way, and where it ends.

    `angle` is that of the crank from the start; in front of it the linkage moves.
    """

    built: Built
    side: int
    angle: float
    inward: int
    guard: str


def dead_point(kind, side):
    """Return the end of a linkage's reach, from its own lengths by the law of cosines."""
    if kind == "rod too short":
        built = crank_and_slider(0.2, 0.15, side, 0.1)
        exact = Exact.of(built, "crank_pin", "piston_pin")
        with mpmath.workdps(40):
            crank = mpmath.hypot(*exact.place["crank_pin"])
            rod = exact.length("crank_pin", "piston_pin")
            lowest = exact.place["piston_pin"][1] - rod
            angle = mpmath.asin(lowest / crank) - mpmath.pi / 2
            return Dead(built, side, float(angle), 1, "piston_closure")
    built = linkage(
        *{"stretched": (0.3, 0.2, 0.25, 0.28), "folded": (0.2, 0.12, 0.3, 0.3)}[kind], side
    )
    exact = Exact.of(built, "crank_pin", "rocker_pin", "rocker_bearing")
    with mpmath.workdps(40):
        crank = mpmath.hypot(*exact.place["crank_pin"])
        coupler = exact.length("crank_pin", "rocker_pin")
        rocker = exact.length("rocker_bearing", "rocker_pin")
        ground = mpmath.hypot(*exact.place["rocker_bearing"])
        reach = coupler + rocker if kind == "stretched" else abs(coupler - rocker)
        cosine = (crank**2 + ground**2 - reach**2) / (2 * crank * ground)
        angle = mpmath.acos(cosine) - mpmath.pi / 2
        inward = -1 if kind == "stretched" else 1
        return Dead(built, side, float(angle), inward, "rocker_closure")


DEAD_POINTS = [
    (kind, side) for kind in ("stretched", "folded", "rod too short") for side in (1, -1)
]
every_dead_point = pytest.mark.parametrize(("kind", "side"), DEAD_POINTS)


@every_dead_point
def test_beyond_a_dead_point_the_loop_is_named(kind, side):
    dead = dead_point(kind, side)
    for beyond in (1e-9, 1e-3, 0.1):
        state = np.array([dead.angle - dead.inward * beyond, 1.0])
        for function in ("rhs", "rhs_jacobian", "positions", "velocities", "relative_coordinates"):
            with pytest.raises(dead.built.module.ClosureError) as error:
                dead.built(function, state)
            assert dead.guard in error.value.margins
        margins = dict(
            zip(dict(dead.built.module.GUARDS), dead.built("margins", state), strict=True)
        )
        assert margins[dead.guard] < 0.0


@every_dead_point
@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10])
def test_accuracy_before_a_dead_point(kind, side, before):
    dead = dead_point(kind, side)
    angle = dead.angle + dead.inward * before
    with mpmath.workdps(40):
        if dead.guard == "piston_closure":
            expected = piston_slide(dead.built, angle, side)
            found = mpf(reported(dead.built, "piston_slide", angle))
            off = float(abs(found - expected))
        else:
            expected = rocker_angle(dead.built, angle, side)
            off = off_by(reported(dead.built, "rocker_angle", angle), expected)
    # the position is a root of the distance to the dead point: a rounding of the crank's angle or
    # of a length moves it by that over the root; some ten of them
    assert off < 40.0 * EPSILON / np.sqrt(before)


@every_dead_point
@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6])
def test_equations_of_motion_before_a_dead_point(kind, side, before):
    dead = dead_point(kind, side)
    built, inputs = dead.built, np.array([2.0])
    state = np.array([dead.angle + dead.inward * before, 0.3 * before])
    oracle = built.oracle.reduced(built.motion(state, inputs), built.named(inputs), {})
    found = built("rhs", state, inputs)[1]
    # both lose digits like the inverse of the distance
    scale = np.abs(oracle.applied[0]) + np.abs(oracle.inertial[0])
    assert abs(found - oracle.accelerations[0]) * oracle.mass_matrix[0, 0] < 1e-13 * scale / before


# -- where an angle is not determined --------------------------------------------------------------


def test_a_pin_on_the_hinge_is_named():
    # a kite: the crank's pin passes through the rocker's bearing, the crank turned to lie along x
    built = linkage(0.25, 0.3, 0.3, 0.25, 1)
    meeting = np.array([-np.pi / 2.0, 0.0])
    with pytest.raises(built.module.ClosureError, match="undetermined") as error:
        built("positions", meeting)
    assert "rocker_reach_squared" in error.value.margins
    built("positions", meeting + np.array([0.1, 0.0]))  # beside it all is well


def test_degenerate_lengths_are_refused(refused):
    nothing = {"rocker_pin_x": 0.3, "rocker_pin_y": 0.0}  # on the rocker's own bearing
    built = Built.of(FOUR_BARS[0], four_bar, nothing)
    with refused(built.module.ParameterError):
        _ = built.constants


def test_a_design_at_a_dead_point_is_refused(refused):
    # coupler and rocker in line: no side to be on, which only rounding would choose
    flat = {"crank_pin_y": 0.0, "crank_pin_x": 0.1, "rocker_pin_y": 0.0}
    built = Built.of(FOUR_BARS[0], four_bar, flat | {"rocker_pin_x": 0.2})
    with refused(built.module.ParameterError):
        _ = built.constants
