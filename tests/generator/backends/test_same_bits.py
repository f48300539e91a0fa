"""The emitted C gives the same bits on every machine: processor, system, C library and compiler.

Digests of what all shipped models give at some states, and of a motion. They change with the
equations that are emitted, or the method, and with nothing else: where these were changed, what a
failure prints as found is what belongs here.
"""

from hashlib import sha256
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from kintrafo.generator.mechanisms.four_bar import MODELS as FOUR_BARS
from kintrafo.simulation.solvers import native_available
from kintrafo.systems.compile.shipped import words_of
from support.c_text import EMITTED
from support.models import needs_gcc, own

STATES, SPREAD = 50, 0.01  # about design, in SI units
FUNCTIONS = "rhs", "rhs_jacobian", "mass_matrix", "signals", "positions"
MOTION = "0f33b570590c3cde"
EXPECTED = {
    file.stem: file.read_text(encoding="utf-8").strip()
    for file in sorted((Path(__file__).parent / "digests").glob("*.txt"))
}


@pytest.mark.parametrize("name", EMITTED)
def test_digest(name):
    system = kintrafo.System(EMITTED[name])
    shape = STATES, len(system.state_names)
    # sums and products alone make these numbers
    states = system.design_state + np.random.default_rng(0).uniform(-SPREAD, SPREAD, shape)
    digest = sha256()
    for function in FUNCTIONS:
        if hasattr(system.equations, function):
            # minus zero is zero; the first byte of a number is its last on every machine
            digest.update((system.evaluate(function, states) + 0.0).astype("<f8").tobytes())
    assert digest.hexdigest()[:16] == EXPECTED.get(name)


@pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
def test_digest_of_a_motion():
    """By the method of our own: half a second over a ramp."""
    car = kintrafo.Model("reference_car")
    ramp = kintrafo.Samples([0.0, 0.1, 0.2, 0.5], [0.0, 0.0, 0.02, 0.02], "linear")
    found = kintrafo.simulate(
        car, (0.0, 0.5), car.design_state, method="DormandPrince",
        inputs={"road_height": ramp}, t_eval=[0.0, 0.125, 0.25, 0.375, 0.5],
    )  # fmt: skip
    assert sha256((found.y + 0.0).astype("<f8").tobytes()).hexdigest()[:16] == MOTION


@needs_gcc
def test_equations_are_known_by_their_sines_too():
    """Kept results of others would be taken for those of these, bits and all."""
    for equations in (EMITTED["four_bar"], own(FOUR_BARS[0])):
        known = words_of(equations)
        assert b"four_bar_rhs(" in known
        assert b"kt_sine(" in known
