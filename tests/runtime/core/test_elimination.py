"""One elimination for many positions, against LAPACK at each of them."""

import numpy as np
import pytest
from kintrafo import Model, Suspension, arm_angles
from kintrafo.core.elimination import eliminated
from kintrafo.vehicle.analysis.loads.balance import balanced, balanced_at_many, dense
from kintrafo.vehicle.analysis.loads.reactions import BalanceEquations
from kintrafo.vehicle.assembly.part_poses import CornerParts
from kintrafo.vehicle.models.reach import at_rest

COUNT, SIZE = 300, 12
# Rounding, times a condition of some thousands, of solutions of size one.
ROUNDING = 1e-11


def random_entries(seed):
    """Return a matrix with few entries, and none but small ones on its diagonal."""
    random = np.random.default_rng(seed)
    there = {(row, (row + 1) % SIZE) for row in range(SIZE)}
    there |= set(map(tuple, random.integers(0, SIZE, (2 * SIZE, 2)).tolist()))
    entries = {at: random.uniform(0.5, 2.0, COUNT) for at in sorted(there)}
    return entries | {(0, 0): random.uniform(-1e-9, 1e-9, COUNT)}


@pytest.mark.parametrize("seed", range(4))
def test_solutions_are_those_of_lapack(seed):
    entries = random_entries(seed)
    right = np.random.default_rng(seed + 100).uniform(-1.0, 1.0, (SIZE, 2, COUNT))
    found, accurate = eliminated(entries, right)
    matrix = dense(entries, (SIZE, SIZE))
    expected = np.linalg.solve(matrix, np.moveaxis(right, -1, 0))
    assert accurate.mean() > 0.9
    error = np.abs(np.moveaxis(found, -1, 0) - expected).max((1, 2))
    # by the condition of each matrix, of equations that hold to 1e-13
    assert (error <= 1e-13 * np.linalg.cond(matrix) * np.abs(expected).max((1, 2)))[accurate].all()


def test_pivots_that_vanish_elsewhere_are_reported():
    entries = random_entries(0)
    right = np.ones((SIZE, 1, COUNT))
    (_, before) = eliminated(entries, right)
    alone = {at: values.copy() for at, values in entries.items()}
    for (row, _), values in alone.items():
        values[7] *= 0.0 if row == 3 else 1.0  # one equation is empty there
    found, accurate = eliminated(alone, right)
    assert before[7]
    assert not accurate[7]
    assert (np.delete(accurate, 7) == np.delete(before, 7)).all()
    assert np.isfinite(found[..., accurate]).all()


def test_dead_points_are_those_of_each_position():
    entries = random_entries(1)
    for (row, _), values in entries.items():
        values[7] *= 0.0 if row == 3 else 1.0
    applied = np.ones((COUNT, SIZE))
    (found, sound), (expected, known) = (
        balanced_at_many(entries, applied),
        balanced(dense(entries, (SIZE, SIZE)), applied),
    )
    assert (sound == known).all()
    assert not sound[7]
    assert np.isnan(found[~sound]).all()
    size = np.abs(expected[sound]).max()
    assert found[sound] == pytest.approx(expected[sound], rel=0.0, abs=ROUNDING * size)


def test_equations_that_are_singular_everywhere_have_no_solution():
    entries = {(0, 0): np.ones(3), (0, 1): np.ones(3), (1, 0): np.ones(3), (1, 1): np.ones(3)}
    found, accurate = eliminated(entries, np.ones((2, 1, 3)))
    assert not accurate.any()
    assert np.isnan(found).all()


@pytest.mark.parametrize(
    "name", ["offset_strut_car", "push_rod_car", "multi_link_car", "trailing_arm_car"]
)
def test_many_positions_carry_what_few_do(name):
    model = Model(Suspension.load(name))
    angles = arm_angles(model, 0.3 + np.linspace(-0.04, 0.04, 220))
    states, inputs = at_rest(model, angles)

    def carried(rows):
        equations = BalanceEquations(CornerParts.of(model, states[rows], inputs[rows]))
        applied = np.random.default_rng(3).uniform(-1e3, 1e3, 6 * len(equations.parts))
        return equations.solve(np.broadcast_to(applied, (len(states[rows]), applied.size)))

    few = np.concatenate([carried(slice(begin, begin + 110)) for begin in (0, 110)])
    assert carried(slice(None)) == pytest.approx(few, rel=0.0, abs=ROUNDING * np.abs(few).max())
