"""Forces with states of their own, of first order."""

from dataclasses import dataclass, replace

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.declare.forces.force import Action, Force
from kintrafo.generator.equations.outputs import generate
from scipy.integrate import solve_ivp
from support.models import own

FINE = {"rtol": 1e-11, "atol": 1e-12, "method": "DormandPrince"}
BASE, BLOCK = g.Ground("base"), g.Body("block", 2.0, (0.1, 0.0, 0.0))
GUIDE = g.Prismatic("way", BASE, BLOCK, g.FORWARD)
LAGGED = g.InternalState("lagged_force", "N", "force of the damper")
DAMPER = g.LaggingDamper(
    g.DamperRate("damping", 30.0, "rate"), g.TimeConstant("lag", 0.08, "lag"), LAGGED
)
SPRING = g.LinearSpring(
    g.SpringRate("stiffness", 400.0, "rate"),
    free_length=g.Displacement("free_slide", 0.02, "slide"),
)
PUSH = g.Input("push", "N", "push")


def model(*forces):
    mechanism = g.Mechanism(
        "lagging",
        "a block on a guide",
        joints=(GUIDE,),
        forces=forces,
        coordinates=(GUIDE.slide("slide", "slide of the block"),),
    )
    return g.Formulation("lagging", "a block on a guide", mechanism, independent=(GUIDE,))


STRUT = g.ForceElement("strut", g.AlongGuide(GUIDE), (SPRING, DAMPER))
MODEL = model(STRUT, g.JointForce(GUIDE, PUSH))


@pytest.fixture(scope="module")
def block():
    return kintrafo.System(own(MODEL))


def test_it_comes_last_in_the_state(block):
    assert block.state_names == ("slide", "slide_rate", "lagged_force")
    assert (block.layout.positions, block.layout.speeds) == (1, 1)
    assert block.design_state.tolist() == [0.0, 0.0, 0.0]
    assert block.equations.STATE["lagged_force"]["unit"] == "N"


@pytest.mark.parametrize("method", ["DormandPrince", "BDF", "Radau"])
def test_a_lagging_damper_is_maxwells_element(block, method):
    """Beside it: damper and spring in a row, by the place between them."""
    mass, stiffness, rate, lag, push = 2.0, 400.0, 30.0, 0.08, 5.0
    inner = rate / lag

    def rates(_, y):
        x, v, between = y
        force = inner * (x - between)
        return [v, (push - stiffness * (x - 0.02) - force) / mass, force / rate]

    start = block.state(slide=0.05, slide_rate=-0.3, lagged_force=1.5)
    times = np.linspace(0.0, 1.0, 6)
    found = kintrafo.simulate(
        block, (0.0, 1.0), start, inputs={"push": push}, t_eval=times, **FINE | {"method": method}
    )
    begin = [0.05, -0.3, 0.05 + 1.5 / inner]
    expected = solve_ivp(rates, (0.0, 1.0), begin, t_eval=times, rtol=1e-12, atol=1e-13).y
    np.testing.assert_allclose(found.y[:2], expected[:2], atol=1e-7)
    force = -inner * (expected[0] - expected[2])
    np.testing.assert_allclose(found.y[2], force, atol=1e-5)
    np.testing.assert_allclose(found.signals["damper_force"], force, atol=1e-5)


def test_it_is_at_rest_and_linear_as_anything(block):
    found = kintrafo.rest(block, block.state(lagged_force=9.0), {"push": 5.0})
    np.testing.assert_allclose(found, [0.02 + 5.0 / 400.0, 0.0, 0.0], atol=1e-12)
    linear = kintrafo.linearise(block, found)
    expected = [[0.0, 1.0, 0.0], [-200.0, 0.0, 0.5], [0.0, -30.0 / 0.08, -1.0 / 0.08]]
    np.testing.assert_allclose(linear.A, expected, atol=1e-9)
    assert linear.steady
    assert linear.mode_of("slide").oscillates


def test_steps_of_one_length_take_it(block):
    start = block.state(slide=0.05)
    stepper = kintrafo.Stepper(block, 1e-3, start)
    for _ in range(200):
        stepper.step()
    expected = kintrafo.simulate(block, (0.0, 0.2), start, **FINE).y[:, -1]
    np.testing.assert_allclose(stepper.state, expected, atol=1e-6)


@dataclass(frozen=True)
class Follower(Force):
    """A force that follows an input with a lag, by a state of its own."""

    state: g.InternalState
    lag: g.TimeConstant
    rates: object = None

    @property
    def identity(self):
        return "Follower", self.state.name

    def act(self, at):
        rate = (self.lag.symbol - self.state.symbol) / self.lag.symbol
        rates = {self.state.name: rate} if self.rates is None else dict(self.rates)
        return Action({at.coordinate("way"): self.state.symbol}, rates=rates)


PULL = g.InternalState("pull", "N", "what follows")
FOLLOWER = Follower(PULL, g.TimeConstant("own_lag", 0.5, "lag"))


def test_copies_have_states_of_their_own():
    copies = [g.Copy(model(STRUT).mechanism, f"{side}_") for side in ("one", "other")]
    both = g.combined("both", "two blocks", copies)
    assert [s.name for s in both.internal_states] == ["one_lagged_force", "other_lagged_force"]
    joints = tuple(joint for joint in both.joints)
    derived = generate(g.Formulation("both", "two blocks", both, joints), derivatives=False)
    assert [entry.name for entry in derived.state][-2:] == [
        "one_lagged_force",
        "other_lagged_force",
    ]


def test_a_force_of_ones_own_says_the_rate():
    derived = generate(model(FOLLOWER))
    assert derived.functions["rhs"].labels[-1] == "d(pull)/dt"


@pytest.mark.parametrize(
    "forces",
    [
        [replace(FOLLOWER, rates=())],
        [replace(FOLLOWER, rates=(("pull", 1), ("push", 2)))],
        [FOLLOWER, g.ForceElement("a", g.AlongGuide(GUIDE), (replace(DAMPER, state=PULL),))],
    ],
)
def test_each_has_one_rate(forces, refused):
    refused(g.DeclarationError, lambda: generate(model(*forces)))


def test_units_and_names_are_checked(refused):
    state = g.InternalState("angle", "rad", "no force")
    refused(
        g.DeclarationError,
        lambda: g.ForceElement("strut", g.AlongGuide(GUIDE), (replace(DAMPER, state=state),)),
        lambda: g.InternalState("x", "furlong", "no unit of SI"),
        lambda: model(replace(FOLLOWER, state=g.InternalState("slide_rate", "N", "taken"))),
    )
