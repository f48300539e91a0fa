"""The closed form of a strut whose axis misses the ball joint: many geometries, up to the edges.

Two oracles: Newton's poses, and the joints' own equations at the poses of the closed form. The
first are as good as the mechanism is conditioned, the second need not know.

A rounding of the rod's equation turns the knuckle by as much over the sine of the angle between the
lever and the plane in which the rod would be dead. Errors are therefore measured in multiples of
`slackness`, lever over distance from that plane, which is one at best.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from cars.instants import At, Instant, counted_by, of_model
from kintrafo.equations.errors import ClosureError
from kintrafo.generated import macpherson_general
from oracle.constraints import Array, Pose
from oracle.newton import AssemblyError, Mechanism, residual_norm, solve_pose
from oracle.reference import general_parameters, mirrored_parameters, set_vector, vector

MODEL = macpherson_general
GUARDS = [name for name, _ in MODEL.GUARDS]

# Joints compare places that follow from each other by some ninety operations on coordinates and
# sines of order one, each of which is off by half of 2.2e-16 at most.
ROUNDING = 1e-14

TURN = -0.1  # of the arm, rad, where the rack is moved up to the dead point


@dataclass(frozen=True)
class Offset:
    """A car with an offset strut, for the oracle and for the compiled model."""

    car: Mechanism
    constants: Array

    def at(self, turn, rack=0.0, spin=0.3):
        """Return the model with the arm turned from design (rad) and the rack moved (m)."""
        instant = Instant(self.car.beta1_design + turn, spin, rack)
        return At(MODEL, instant, self.constants)

    def slackness(self, at):
        """Return the lever of the rod over how far it is from its dead point."""
        lever = self.car.points["tie_rod_outer"] - self.car.points["ball_joint"]
        return float(np.linalg.norm(lever) / np.sqrt(margin(at, "knuckle_closure")))


def offset_car(parameters):
    """Return a car from parameters of any model."""
    given = of_model(MODEL, parameters)
    return Offset(Mechanism(given), MODEL.prepare(given))


def random_car(seed, offset=None):
    """Return a general car with an offset of up to 120 mm, every second one on the left."""
    rng = np.random.default_rng(seed)
    parameters = general_parameters(rng, rng.uniform(0.0, 0.12) if offset is None else offset)
    return offset_car(mirrored_parameters(parameters) if seed % 2 else parameters)


def margin(at, guard):
    """Return one of the margins, whether it is positive or not."""
    return float(at("margins")[GUARDS.index(guard)])


def closed_form(at):
    """Return the pose of the closed form; None where it refuses."""
    try:
        return Pose(at("positions"), at("orientations"))
    except ClosureError:
        return None


def by_newton(car, at):
    """Return the pose that Newton finds on the branch of the design position; None without."""
    try:
        return solve_pose(car, at.instant.beta1, at.instant.rack, at.instant.spin)
    except AssemblyError:
        return None


def difference(one, other):
    """Return the largest difference of positions (m) and direction cosines."""
    positions = np.abs(one.position - other.position).max()
    return float(max(positions, np.abs(one.rotation - other.rotation).max()))


def last_reached(subject, side):
    """Return the last rack displacement (m) to one side at which the rod reaches the knuckle."""
    reached, missed = 0.0, 0.4 * side
    assert margin(subject.at(TURN, missed), "knuckle_closure") < 0.0
    for _ in range(60):  # bisection to the last digit
        middle = 0.5 * (reached + missed)
        closes = margin(subject.at(TURN, middle), "knuckle_closure") > 0.0
        reached, missed = (middle, missed) if closes else (reached, middle)
    return reached


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("seed", range(4))
def test_up_to_the_dead_point(seed, side):
    """As the rack nears the place where the rod just reaches, the joints stay closed."""
    subject = random_car(2000 + seed)
    reached = last_reached(subject, side)
    for gap in 10.0 ** np.arange(-2, -13, -1):
        at = subject.at(TURN, reached - side * gap)
        pose = closed_form(at)
        assert pose is not None
        assert residual_norm(subject.car, pose) < ROUNDING
        expected = by_newton(subject.car, at)
        if gap > 1e-9:  # beyond, Newton's own steps may end on the other branch
            assert expected is not None
        if expected is not None:
            assert difference(pose, expected) < ROUNDING * subject.slackness(at)
    assert closed_form(subject.at(TURN, reached + 1e-9 * side)) is None


@pytest.mark.parametrize("seed", range(3))
def test_accelerations_up_to_the_dead_point(seed):
    """Towards it they grow without limit; their relative error grows with the slackness squared.

    A rounding of the equation of the rod changes its distance from the dead point, by which
    velocities are divided, by a relative amount of that square.
    """
    subject = random_car(3000 + seed, 0.06)
    car = Mechanism(counted_by(MODEL, subject.car.parameters))
    reached = last_reached(subject, 1.0)
    for gap in 10.0 ** np.arange(-2, -7, -1):
        instant = replace(
            subject.at(TURN, reached - gap).instant,
            beta1_rate=0.5,
            spin_rate=60.0,
            rack_rate=0.05,
            rack_acceleration=1.0,
        )
        at = At(MODEL, instant, subject.constants)
        expected = instant.solution(MODEL, car).coordinate_accelerations[:2]
        # seven times the worst measured (3e-15)
        allowed = 2e-14 * subject.slackness(at) ** 2 * np.abs(expected).max()
        assert np.abs(at("rhs")[2:] - expected).max() < allowed


def almost_touching(seed, reach):
    """Return a car whose strut top is, along the strut's axis, a reach (m) from the ball joint."""
    parameters = general_parameters(np.random.default_rng(seed), 0.06)
    ball, top, lower = (
        vector(parameters, name) for name in ("ball_joint", "strut_top", "strut_lower")
    )
    axis = (lower - top) / np.linalg.norm(lower - top)
    offset = (ball - top) - ((ball - top) @ axis) * axis
    top = ball - reach * axis - offset
    set_vector(parameters, "strut_top", top)
    set_vector(parameters, "strut_lower", top + 0.3 * axis)
    return offset_car(parameters)


@pytest.mark.parametrize("exponent", range(1, 7))
@pytest.mark.parametrize("seed", range(3))
def test_up_to_where_the_axis_passes_the_ball_joint(seed, exponent):
    """The strut top as near to the ball joint as the axis is: there the reach is zero.

    A rounding of the square of the reach is divided by the reach, and so is the knuckle's turn.
    """
    subject = almost_touching(seed, 10.0**-exponent)
    solved = 0
    for turn in 0.3 * 10.0**-exponent * np.array([-1.0, 1.0]):
        at = subject.at(turn, 0.1 * turn)
        pose = closed_form(at)
        if pose is None:
            # of the two sides of so small a reach, one may be beyond the edge
            assert exponent > 2
            assert min(margin(at, "length_squared_BC"), margin(at, "knuckle_closure")) < 0.0
            continue
        solved += 1
        assert residual_norm(subject.car, pose) < ROUNDING
        reach = np.sqrt(margin(at, "length_squared_BC"))
        expected = by_newton(subject.car, at)
        assert expected is not None
        allowed = ROUNDING * subject.slackness(at) * max(1.0, 0.1 / reach)
        assert difference(pose, expected) < allowed
    assert solved > 0


def test_either_branch_is_that_of_the_design():
    """The rod's end in front of the axle or behind it: two signs of the root."""
    signs = set()
    for seed in range(6):
        rng = np.random.default_rng(seed)
        parameters = general_parameters(rng)
        if seed % 2:  # steering in front of the axle
            for name in ("tie_rod_outer", "tie_rod_inner"):
                place = vector(parameters, name) * np.array([-1.0, 1.0, 1.0])
                set_vector(parameters, name, place)
        subject = offset_car(parameters)
        signs.add(float(subject.constants[MODEL.CONSTANTS.index("knuckle_branch")]))
        for turn, rack in ((0.0, 0.0), (0.2, 0.01), (-0.2, -0.01)):
            at = subject.at(turn, rack)
            pose, expected = closed_form(at), by_newton(subject.car, at)
            assert pose is not None
            assert expected is not None
            assert difference(pose, expected) < ROUNDING * subject.slackness(at)
    assert signs == {-1.0, 1.0}
