"""Properties that tyres have in any state, of states that hypothesis draws."""

from pathlib import Path

import kintrafo
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

FILE = Path(__file__).parents[2] / "data/chrono/TMeasyTire.json"
TYRES = {
    "MF 6.1": kintrafo.tyres.load("passenger_205_55"),
    "TMeasy": kintrafo.tyres.load(FILE),
    "linear": kintrafo.tyres.LinearSlip(
        radius=0.3, effective_radius=0.29, vertical_stiffness=2e5, slip_stiffness=9e4,
        cornering_stiffness=7e4, trail=0.03,
    ),
}  # fmt: skip
NUMBERS = {"allow_nan": False, "allow_infinity": False}
LOADS = st.floats(0.0, 9000.0, **NUMBERS)
ANGLES = st.floats(-0.6, 0.6, **NUMBERS)
SLIPS = st.floats(-1.0, 1.0, **NUMBERS)
CAMBERS = st.floats(-0.15, 0.15, **NUMBERS)
SPEEDS = st.floats(-80.0, 80.0, **NUMBERS)


@pytest.mark.parametrize("name", TYRES)
@settings(max_examples=60, deadline=None, derandomize=True)
@given(load=LOADS, angle=ANGLES, slip=SLIPS, camber=CAMBERS, speed=SPEEDS)
def test_every_state_has_finite_forces_below_friction(name, load, angle, slip, camber, speed):
    found = TYRES[name].evaluate(load, angle, slip, camber, speed=speed)
    for field in ("fx", "fy", "mx", "my", "mz", "trail", "loaded_radius", "effective_radius"):
        assert np.isfinite(getattr(found, field)), field
    assert np.hypot(found.fx, found.fy) <= 1.4 * load + 1e-6
    assert found.fz == load
    assert found.outside == {}


@pytest.mark.parametrize("name", TYRES)
@settings(max_examples=40, deadline=None, derandomize=True)
@given(load=LOADS, angle=ANGLES, slip=SLIPS, camber=CAMBERS)
def test_one_state_alone_is_the_same_as_among_others(name, load, angle, slip, camber):
    tyre, rows = TYRES[name], np.array([0.5, 1.0, 0.7])
    among = tyre.evaluate(load * rows, angle, slip, camber)
    alone = tyre.evaluate(load, angle, slip, camber)
    assert among.fx.shape == (3,)
    for field in ("fx", "fy", "mz"):
        # NumPy has loops of its own for arrays, which may differ in the last digit
        assert getattr(among, field)[1] == pytest.approx(float(getattr(alone, field)), rel=1e-10)


@pytest.mark.parametrize("name", TYRES)
@settings(max_examples=40, deadline=None, derandomize=True)
@given(load=st.floats(500.0, 8900.0, **NUMBERS), angle=ANGLES, slip=SLIPS)
def test_forces_are_continuous(name, load, angle, slip):
    """A step of 1e-7 in slips and 1e-3 N in load moves forces by their greatest slopes at most."""
    one = TYRES[name].evaluate(load, angle, slip)
    two = TYRES[name].evaluate(load + 1e-3, angle + 1e-7, max(slip - 1e-7, -1.0))
    for field in ("fx", "fy"):
        assert abs(getattr(two, field) - getattr(one, field)) < 0.2
