"""Rolling, and gliding along an edge: constraints on speeds, which are eliminated."""

from dataclasses import replace

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.equations.errors import ModelError, ParameterError
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.compile.declaration import model_of
from mechanisms.free_bodies import rotation
from oracle.constraints import skew
from support.folders import ROOT
from support.models import own

FINE = {"rtol": 1e-11, "atol": 1e-12, "method": "DormandPrince"}

WEAVE_AND_CAPSIZE = {
    0: (-5.53094371765393, -3.13164324790656, 3.13164324790656, 5.53094371765393),
    1: (-7.11008014637442, -3.13423125066578, 3.52696170990070 + 0.80774027519930j),
    2: (-8.67387984831735, -3.07158645641514, 2.68234517512745 + 1.68066296590675j),
    3: (-10.35101467245920, -2.63366137253667, 1.70675605663975 + 2.31582447384325j),
    4: (-12.15861426576447, -1.42944427361326, 0.41325331521125 + 3.07910818603206j),
    5: (-14.07838969279822, -0.32286642900409, -0.77534188219585 + 4.46486771378823j),
    6: (-16.08537123098026, -0.00406690076970, -1.52644486584142 + 5.87673060598709j),
    7: (-18.15788466125262, 0.10268170574766, -2.13875644258362 + 7.19525913329805j),
    8: (-20.27940894394569, 0.14327879765713, -2.69348683581097 + 8.46037971396931j),
    9: (-22.43788559040858, 0.15790184030917, -3.21675402252485 + 9.69377351531791j),
    10: (-24.62459635017404, 0.16105338653172, -3.72016840437287 + 10.90681139476287j),
}
"""By the forward speed in m/s: table 2 of Meijaard and others (2007), 1/s."""


# -- the benchmark bicycle ------------------------------------------------------------------------


@pytest.fixture(scope="module")
def bicycle():
    return kintrafo.System(own(model_of(ROOT / "examples/bicycle.py")))


@pytest.mark.parametrize("speed", WEAVE_AND_CAPSIZE)
def test_the_bicycle_has_its_published_eigenvalues(bicycle, speed):
    linear = kintrafo.linearise(bicycle, bicycle.state(rear_angle_rate=speed / 0.3))
    found = linear.eigenvalues
    found = found[(np.abs(found) > 1e-3) & (found.imag >= 0.0)]
    published = np.sort_complex(WEAVE_AND_CAPSIZE[speed])
    np.testing.assert_allclose(np.sort_complex(found), published, rtol=1e-9)
    assert linear.steady
    assert len(linear.eigenvalues) == 9 + 3


def test_a_wobbling_bicycle_keeps_its_energy_and_stays_on_the_ground(bicycle):
    start = bicycle.state(rear_angle_rate=5.0 / 0.3, frame_p=0.3, steer_angle_rate=-0.1)
    found = kintrafo.simulate(bicycle, (0.0, 5.0), start, **FINE)
    energies = [_energy(bicycle, state) for state in (start, found.y[:, -1])]
    assert energies[1] == pytest.approx(energies[0], rel=1e-10)
    gaps = [found.signals[f"{wheel}_rolls_gap"] for wheel in ("rear", "front")]
    assert np.abs(gaps).max() < 1e-10
    assert np.ptp(found.y[bicycle.state_names.index("frame_e1")]) > 0.01


def _energy(bicycle, state):
    motion = 0.5 * state[10:] @ bicycle.evaluate("mass_matrix", state) @ state[10:]
    bodies = bicycle.equations.MASSIVE_BODIES
    masses = np.array([bicycle.parameters[f"{body}_mass"] for body in bodies])
    heights = bicycle.evaluate("positions", state)[:, 2]
    assert bodies == bicycle.equations.BODIES
    return motion + 9.81 * masses @ heights


def test_derivatives_of_the_bicycle_are_those_of_its_rates(bicycle):
    state = bicycle.state(rear_angle_rate=15.0, frame_p=0.3, steer_angle=0.2, frame_e1=0.1)
    found, step = bicycle.evaluate("rhs_jacobian", state), 1e-5
    ends = [
        [bicycle.evaluate("rhs", state + sign * step * d) for sign in (1, -1)]
        for d in np.eye(state.size)
    ]
    differences = np.array([(a - b) / (2.0 * step) for a, b in ends]).T
    np.testing.assert_allclose(found, differences, atol=1e-7 * np.abs(found).max())
    rates = np.random.default_rng(0).uniform(-1.0, 1.0, 3)
    moving = np.concatenate((state[:10], rates))
    twists = bicycle.evaluate("global_jacobian", moving) @ rates
    np.testing.assert_allclose(twists, bicycle.evaluate("velocities", moving).ravel(), atol=1e-12)
    slopes = bicycle.evaluate("relative_jacobian", moving) @ rates
    np.testing.assert_allclose(slopes, bicycle.evaluate("rhs", moving)[7:10], atol=1e-12)


# -- a rolling disc -------------------------------------------------------------------------------

MASS, RADIUS, SPIN, DIAMETRAL = 2.0, 0.5, 0.25, 0.125
DISC = g.Body("disc", MASS, (0.0, 0.0, RADIUS), (DIAMETRAL, SPIN, DIAMETRAL))
AXIS = g.Direction("axis", (0.0, 1.0, 0.0))
FLIGHT = g.Free("flight", DISC)
RIM = g.Rolling("rim", g.Wheel(DISC, DISC.center, AXIS), g.Length("radius", RADIUS, "radius"))


def disc_model(eliminated=("disc_u", "disc_v", "disc_w"), constraints=(RIM,)):
    mechanism = g.Mechanism(
        "disc", "a rolling disc", joints=(FLIGHT,), forces=(g.Weight(),), constraints=constraints
    )
    return g.Formulation("disc", "a rolling disc", mechanism, (FLIGHT,), eliminated=eliminated)


@pytest.fixture(scope="module")
def disc():
    return kintrafo.System(own(disc_model()))


def test_axes_that_spin_have_no_constant_coefficients(disc):
    """Gravity turns in the axes of the disc: nothing of it is steady, but where it rests."""
    assert kintrafo.linearise(disc, disc.state()).steady
    assert not kintrafo.linearise(disc, disc.state(disc_q=3.0)).steady


FRAME = g.Body("frame", 1.0, DISC.center, (0.02, 0.03, 0.02))
WHEEL = g.Rotor("wheel", MASS, DISC.center, axis=AXIS, spin=SPIN, diametral=DIAMETRAL)
HUB = g.Revolute("hub", FRAME, WHEEL, g.Line(DISC.center, AXIS))
ON_FRAME = g.Wheel(FRAME, DISC.center, AXIS)


def unicycle(*forces):
    flight, rim = g.Free("flight", FRAME), replace(RIM, wheel=ON_FRAME, bearing=HUB)
    mechanism = g.Mechanism(
        "unicycle",
        "a wheel in a fork",
        joints=(flight, HUB),
        forces=(g.Weight(), *forces),
        coordinates=(HUB.angle("angle", "angle of the wheel"),),
        constraints=(rim,),
    )
    eliminated = ("frame_u", "frame_v", "frame_w")
    return g.Formulation(
        "unicycle", "a wheel in a fork", mechanism, (flight, HUB), eliminated=eliminated
    )


def test_a_push_acts_on_the_speeds_that_are_left():
    """``(C + m r^2) omega' = F r`` of a force ahead, declared in two ways."""
    push = g.Input("push", "N", "force at the centre, ahead")
    none = [g.Input(f"none_{i}", "N" if i < 5 else "N m", "nothing") for i in range(10)]
    loads = g.WheelLoads(
        wheel=ON_FRAME,
        bearing=HUB,
        radius=RIM.radius,
        contact=tuple(none[:3]),
        moment=tuple(none[5:8]),
        center=(push, *none[3:5]),
        shaft=none[8],
        hub=none[9],
    )
    applied = g.AppliedForce(FRAME, DISC.center, g.FORWARD, push)
    for force in (loads, applied):
        system = kintrafo.System(own(unicycle(force), arrays=True, derivatives=False))
        inputs = system.inputs({"push": 6.0})
        rates = system.evaluate("rhs", system.state(angle_rate=2.0), inputs)
        expected = 6.0 * RADIUS / (SPIN + (MASS + 1.0) * RADIUS**2)
        assert rates[-1] == pytest.approx(expected, rel=1e-12)


def _lowest(turned):
    axis, up = turned[:, 1], np.array([0.0, 0.0, 1.0])
    pull = up - axis * axis[2]
    return -RADIUS * pull / np.linalg.norm(pull)


def test_accelerations_of_the_disc_are_those_with_multipliers(disc):
    """Newton and Euler with the force at the lowest point, which has no velocity."""
    random = np.random.default_rng(4)
    for _ in range(3):
        state = disc.state(
            disc_e1=0.3 * random.normal(), disc_e2=random.normal(), disc_e3=random.normal()
        )
        state[3:7] /= np.linalg.norm(state[3:7])
        state[7:] = random.normal(size=3) * 3.0
        turned = rotation(state[3:7])
        omega = turned @ state[7:]
        arm = _lowest(turned)
        step = 1e-6
        rate = disc.evaluate("rhs", state)
        moved = [_lowest(rotation(_unit(state[3:7] + s * step * rate[3:7]))) for s in (1, -1)]
        sliding = (moved[0] - moved[1]) / (2.0 * step)  # of the lowest point along the rim
        tensor = turned @ np.diag([DIAMETRAL, SPIN, DIAMETRAL]) @ turned.T
        # with force F at the arm r: m a = F + m g and I alpha + ... = r x F, where a is that of
        # a centre with the velocity r x omega: a = r x alpha + r' x omega
        cross = skew(arm)
        weight = np.array([0.0, 0.0, -9.81])
        known = MASS * np.cross(arm, np.cross(sliding, omega) - weight)
        left = tensor - MASS * cross @ cross
        right = known - np.cross(omega, tensor @ omega)
        alpha = np.linalg.solve(left, right)
        np.testing.assert_allclose(rate[7:], turned.T @ alpha, rtol=1e-7, atol=1e-7)
        velocity = disc.evaluate("velocities", state)[0, 3:]
        np.testing.assert_allclose(velocity, -np.cross(omega, arm), atol=1e-13)


def _unit(v):
    return v / np.linalg.norm(v)


def test_a_disc_that_lies_flat_has_no_lowest_point(disc, refused):
    state = disc.state()
    state[3:7] = [np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0]
    refused(ModelError, lambda: disc.evaluate("rhs", state))


# -- edges ----------------------------------------------------------------------------------------

AHEAD, SLEIGH_MASS, TURNING = 0.3, 4.0, 0.5
SLEIGH = g.Body("sleigh", SLEIGH_MASS, (AHEAD, 0.0, 0.0), (0.2, 0.3, TURNING))
SLIDES = g.Free("slides", SLEIGH)
EDGE = g.NoSlip("edge", SLEIGH, g.Point("skate", (0.0, 0.0, 0.0)), AXIS)


def sleigh_model(**changes):
    mechanism = g.Mechanism("sleigh", "a sleigh", joints=(SLIDES,), constraints=(EDGE,))
    given = {"mechanism": mechanism, "independent": (SLIDES,), "eliminated": ("sleigh_v",)}
    return g.Formulation("sleigh", "a sleigh", **given | changes)


@pytest.fixture(scope="module")
def sleigh():
    return kintrafo.System(own(sleigh_model()))


@pytest.mark.parametrize("method", ["DormandPrince", "BDF"])
def test_chaplygins_sleigh_turns_into_its_way(sleigh, method):
    """With J about the edge: ``r = W / cosh(k t)``, ``u = U tanh(k t)``, ``k = a W^2 / U``."""
    about = TURNING + SLEIGH_MASS * AHEAD**2
    fastest = 2.0
    forward = fastest * np.sqrt(about / SLEIGH_MASS)
    k = AHEAD * fastest**2 / forward
    begin, span = -2.0 / k, 4.0 / k
    times = np.linspace(0.0, span, 9)
    start = sleigh.state(
        sleigh_r=fastest / np.cosh(k * begin), sleigh_u=forward * np.tanh(k * begin)
    )
    found = kintrafo.simulate(
        sleigh, (0.0, span), start, t_eval=times, **FINE | {"method": method}
    ).y
    at = dict(zip(sleigh.state_names, found, strict=True))
    when = k * (begin + times)
    np.testing.assert_allclose(at["sleigh_r"], fastest / np.cosh(when), atol=1e-7)
    np.testing.assert_allclose(at["sleigh_u"], forward * np.tanh(when), atol=1e-7)
    heading = 2.0 * np.arctan(np.tanh(when / 2.0)) * fastest / k  # of the Gudermannian
    heading -= heading[0]
    turned = 2.0 * np.unwrap(np.arctan2(at["sleigh_e3"], at["sleigh_e0"]), period=np.pi)
    np.testing.assert_allclose(turned, heading, atol=1e-6)


def test_a_skate_that_is_steered_keeps_its_pace():
    """A point mass on an edge whose heading is given: ``x' = s cos``, ``y' = s sin``."""
    base, cart = g.Ground("base"), g.Body("cart", 1.0, (0.0, 0.0, 0.1))
    slide, skate = g.Body("slide", 1.0, (0.0, 0.0, 0.1)), g.Body("skate", 1.5, (0.0, 0.0, 0.0))
    along = g.Prismatic("along", base, cart, g.FORWARD)
    across = g.Prismatic("across", cart, slide, g.Direction("left", fixed=(0, 1, 0)))
    center = g.Point("center", (0.0, 0.0, 0.0))
    steer = g.Revolute("steer", slide, skate, g.Line(center, g.UP))
    edge = g.NoSlip("edge", skate, center, AXIS)
    mechanism = g.Mechanism(
        "skate",
        "a skate that is steered",
        joints=(along, across, steer),
        coordinates=(along.slide("x", "forward"), across.slide("y", "to the left")),
        constraints=(edge,),
    )
    model = g.Formulation(
        "skate",
        "a skate that is steered",
        mechanism,
        independent=(along, across),
        prescribed={steer: g.Motion("heading", "rad", "heading of the skate")},
        massive=(skate,),
        eliminated=("y_rate",),
    )
    system = kintrafo.System(own(model, arrays=True))
    times = np.linspace(0.0, 2.0, 41)
    given = 0.8 * np.sin(times)
    found = kintrafo.simulate(
        system,
        (0.0, 2.0),
        system.state(x_rate=1.3),
        inputs={"heading_position": (times, given)},
        t_eval=times,
        rtol=1e-9,
        atol=1e-10,
    )
    np.testing.assert_allclose(found.y[2], 1.3 * np.cos(given), atol=2e-4)  # of the spline
    paths = np.gradient(found.y[1], times)[1:-1], (1.3 * np.sin(given))[1:-1]
    np.testing.assert_allclose(*paths, atol=5e-3)
    rest = kintrafo.linearise(system, found.y[:, 0], system.inputs({"heading_velocity": 0.8}))
    assert rest.A.shape == (3, 3)


# -- errors ---------------------------------------------------------------------------------------


def test_as_many_speeds_are_eliminated_as_vanish(refused):
    for eliminated in ((), ("sleigh_x",), ("sleigh_v", "sleigh_v")):
        with refused(g.DeclarationError):
            sleigh_model(eliminated=eliminated)


def test_what_the_constraints_do_not_give_cannot_be_eliminated(refused):
    model = sleigh_model(eliminated=("sleigh_w",))
    refused(ParameterError, lambda: own(model, arrays=True, derivatives=False))


def test_the_bearing_of_a_disc_is_that_of_its_wheel(refused):
    other = g.Body("other", 1.0, (0.0, 0.0, 0.5), (0.1, 0.1, 0.1))
    hinge = g.Revolute("hinge", other, DISC, g.Line(DISC.center, g.UP))
    refused(g.DeclarationError, lambda: replace(RIM, bearing=hinge))


def test_constraints_without_names_of_their_own_are_refused():
    with pytest.raises(g.DeclarationError, match="edge"):
        replace(sleigh_model().mechanism, constraints=(EDGE, replace(EDGE, direction=g.FORWARD)))


def test_copies_have_constraints_of_their_own():
    copies = [g.Copy(sleigh_model().mechanism, f"{side}_") for side in ("one", "other")]
    both = g.combined("both", "two sleighs", copies)
    assert [c.name for c in both.constraints] == ["one_edge", "other_edge"]
    model = g.Formulation(
        "both", "two", both, both.joints, eliminated=("one_sleigh_v", "other_sleigh_v")
    )
    assert len(generate(model, derivatives=False).state) == 14 + 10
