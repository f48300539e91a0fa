"""Mechanisms with many coordinates: their derivatives do without those of the mass matrix.

An open chain with a wheel at its end is differentiated in 50 digits; a Stewart platform, whose pose
is found by iteration, moves like the oracle.
"""

import mpmath
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations import dynamics
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms.stewart_platform import STEWART_PLATFORM
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.loader import load
from oracle.random_states import check_with_the_oracle
from support.models import Built
from support.symbolic import constants_of, derivatives_of


def open_chain(hinges):
    """Return a chain of links, with a wheel in the last one and torques that act on both ends."""
    links = [g.Ground("ground", 1)]
    joints = []
    for i in range(hinges):
        inertia = (0.11, 0.04, 0.12, 0.01, -0.004, 0.006)
        links.append(g.Body(f"link_{i}", 2.0, (0.1, 0.4 * i + 0.2, 0.05), inertia))
        pin = g.Point(f"pin_{i}", (0.0, 0.4 * i, 0.03 * i), f"pin of link {i}")
        axis = g.Direction(f"axis_{i}", ((1.0, 0.0, 0.3), (0.1, 0.2, 1.0))[i % 2], f"axis {i}")
        joints.append(g.Revolute(f"hinge_{i}", *links[-2:], axis=g.Line(pin, axis)))
    hub = g.Point("hub", (0.1, 0.4 * hinges, 0.1), "centre of the wheel")
    spin = g.Direction("spin_axis", (0.2, 1.0, 0.1), "axis of the wheel")
    wheel = g.Rotor("wheel", 1.5, hub, axis=spin, spin=0.05, diametral=0.03)
    joints.append(g.Revolute("bearing", links[-1], wheel, axis=g.Line(hub, spin)))
    torques = [g.Input(f"torque_{j.name}", "N m", f"torque at {j.name}") for j in joints]
    mechanism = g.Mechanism(
        name="open_chain",
        title="Open chain with a wheel",
        joints=tuple(joints),
        forces=(g.Weight(), *(g.JointForce(joints[i], torques[i]) for i in (0, -1))),
        coordinates=tuple(j.angle(f"{j.name}_angle", f"angle of {j.name}") for j in joints),
    )
    return g.Formulation(
        name="open_chain",
        title="Open chain with a wheel",
        mechanism=mechanism,
        independent=tuple(joints),
        massive=mechanism.bodies[1:],
    )


@pytest.fixture(scope="module")
def chain():
    return generate(open_chain(dynamics.MANY))


def test_derivatives_of_an_open_chain_are_exact(tmp_path, chain):
    folder = tmp_path / "open_chain-arrays"
    folder.mkdir()
    build(chain, folder, None)
    built = Built.of(chain.formulation, load(folder))
    rng = np.random.default_rng(2)
    size = len(built.module.STATE)
    state, inputs = rng.uniform(-2.0, 2.0, size), rng.uniform(-3.0, 3.0, 2)
    with mpmath.workdps(50):
        values = constants_of(chain, built.parameters)
        values |= {n: mpmath.mpf(v) for n, v in built.named(inputs).items()}
        values |= dict(zip(built.module.STATE, map(mpmath.mpf, state), strict=True))
        for function, names in (
            ("rhs_jacobian", built.module.STATE),
            ("rhs_input_jacobian", built.module.INPUTS),
        ):
            expected = derivatives_of(chain.functions["rhs"], values, names)
            scale = np.abs(expected).max()
            found = built(function, state, inputs)
            # some thousand roundings, and the condition of the mass matrix
            np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * scale)


def test_no_element_of_the_mass_matrix_is_differentiated(chain, monkeypatch):
    names = {step.symbol.name for step in chain.functions["rhs_jacobian"].steps}
    assert not any(name.startswith("mass_") and "__" in name for name in names)
    monkeypatch.setattr(dynamics, "MANY", dynamics.MANY + 1)
    before = generate(chain.formulation)
    counts = [operations_of(d.functions["rhs_jacobian"]).total() for d in (chain, before)]
    assert counts[0] < counts[1]


def test_a_stewart_platform_moves_as_the_oracle_says(tmp_path):
    check_with_the_oracle(STEWART_PLATFORM, tmp_path, reach=0.15, count=3)
