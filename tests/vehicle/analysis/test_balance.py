"""Equilibrium at many positions: each is solved as if it were alone."""

import numpy as np
import pytest
from kintrafo import Model, Suspension, arm_angles
from kintrafo.vehicle.analysis.loads import reactions
from kintrafo.vehicle.analysis.loads.balance import balanced
from kintrafo.vehicle.assembly.part_poses import CornerParts
from kintrafo.vehicle.models.reach import at_rest

COUNT, SIZE = 30, 12
# Rounding, times a condition of some thousands, of solutions of size one.
ROUNDING = 1e-11


def test_dead_points_are_those_of_each_position():
    matrix = np.random.default_rng(1).uniform(0.5, 2.0, (COUNT, SIZE, SIZE))
    matrix[7, 3] = 0.0
    applied = np.ones((COUNT, SIZE))
    found, sound = balanced(matrix, applied)
    others = np.arange(COUNT) != 7
    assert (sound == others).all()
    assert np.isnan(found[7]).all()
    expected = np.linalg.solve(matrix[others], -applied[others][..., None])[..., 0]
    assert found[others] == pytest.approx(expected, rel=0.0, abs=ROUNDING * np.abs(expected).max())


@pytest.mark.parametrize("name", ["push_rod_car", "multi_link_car"])
def test_pieces_carry_what_all_do(name, monkeypatch):
    model = Model(Suspension.load(name))
    states, inputs = at_rest(model, arm_angles(model, 0.3 + np.linspace(-0.04, 0.04, COUNT)))
    equations = reactions.BalanceEquations(CornerParts.of(model, states, inputs))
    applied = np.random.default_rng(3).uniform(-1e3, 1e3, (COUNT, 6 * len(equations.parts), 2))
    expected = equations.solve(applied)
    monkeypatch.setattr(reactions, "_TOGETHER", 8)
    found = equations.solve(applied)
    assert found == pytest.approx(expected, rel=0.0, abs=ROUNDING * np.abs(expected).max())
    none = reactions.BalanceEquations(CornerParts.of(model, states[:0], inputs[:0]))
    assert none.solve(applied[:0]).shape == (0, *expected.shape[1:])
