"""The emitted C gives the same bits on every machine: processor, system, C library and compiler.

Digests of what all shipped models give at some states, and of a motion. They change with the
equations that are emitted, or the method, and with nothing else: where these were changed, what a
failure prints as found is what belongs here.
"""

from hashlib import sha256

import kintrafo
import numpy as np
import pytest
from c_text import EMITTED
from kintrafo.generator.mechanisms.four_bar import MODELS as FOUR_BARS
from kintrafo.simulation.solvers import native_available
from kintrafo.systems.compile.shipped import words_of
from own_models import needs_gcc, own

STATES, SPREAD = 50, 0.01  # about design, in SI units
FUNCTIONS = "rhs", "rhs_jacobian", "mass_matrix", "signals", "positions"
MOTION = "99130c26192ebab8"
EXPECTED = {
    "andrews": "0fa687d31c1bb65a",
    "double_wishbone": "9cff587d1dcee901",
    "double_wishbone_general": "9ae37f5ef911800f",
    "excavator": "313d3c1763f6d883",
    "excavator_lifting": "525102ef46edd26b",
    "four_bar": "f5f5d2655eba9b76",
    "front_axle": "902cdc5fe80ac4a3",
    "macpherson": "436f920d469ce559",
    "macpherson_free_rack": "2f92725f6d8e5228",
    "macpherson_general": "907e62cad164c82d",
    "multi_link": "0501f25d1bf3f358",
    "pull_rod": "49673a5e740a893a",
    "push_rod": "9339d095525faa93",
    "rigid_axle": "80e71287d69921e4",
    "slider_crank": "b449d0661da4e759",
    "trailing_arm": "4140199cf2a82401",
}


@pytest.mark.parametrize("name", EMITTED)
def test_digest(name: str) -> None:
    system = kintrafo.System(EMITTED[name])
    shape = STATES, len(system.state_names)
    # sums and products alone make these numbers
    states = system.design_state + np.random.default_rng(0).uniform(-SPREAD, SPREAD, shape)
    digest = sha256()
    for function in FUNCTIONS:
        if hasattr(system.equations, function):
            # minus zero is zero; the first byte of a number is its last, whatever the machine
            digest.update((system.evaluate(function, states) + 0.0).astype("<f8").tobytes())
    assert digest.hexdigest()[:16] == EXPECTED.get(name)


@pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
def test_digest_of_a_motion() -> None:
    """By the method of our own: half a second over a ramp."""
    car = kintrafo.Model("reference_car")
    ramp = kintrafo.Samples([0.0, 0.1, 0.2, 0.5], [0.0, 0.0, 0.02, 0.02], "linear")
    found = kintrafo.simulate(
        car, (0.0, 0.5), car.design_state, method="DormandPrince",
        inputs={"road_height": ramp}, t_eval=[0.0, 0.125, 0.25, 0.375, 0.5],
    )  # fmt: skip
    assert sha256((found.y + 0.0).astype("<f8").tobytes()).hexdigest()[:16] == MOTION


@needs_gcc
def test_equations_are_known_by_their_sines_too() -> None:
    """Kept results of others would be taken for those of these, bits and all."""
    for equations in (EMITTED["four_bar"], own(FOUR_BARS[0])):
        known = words_of(equations)
        assert b"four_bar_rhs(" in known
        assert b"kt_sine(" in known
