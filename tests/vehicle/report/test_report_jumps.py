"""Curves that jump where a stop begins to act, in the report: nothing is interpolated across."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from kintrafo import Model, characteristics, state_at_height
from kintrafo.vehicle.assembly.measures.corner import AT_STOPS
from kintrafo.vehicle.models.positions import design_height
from kintrafo.vehicle.report.accuracy import measure
from kintrafo.vehicle.report.curves import curves, gaps_on
from kintrafo.vehicle.report.grid import Grid, GridAxis
from kintrafo.vehicle.report.plotted import shown_range
from kintrafo.vehicle.report.poses import poses
from scipy.optimize import brentq

CAR = Model("offset_strut_car")  # with bump and rebound stops within its travel
GRID = Grid(GridAxis(-0.1, 0.005, 38), GridAxis(-0.03, 0.01, 7))

slope = st.floats(-1.0, 1.0)


@given(slope, slope, st.integers(0, 2**32 - 1))
def test_cubics_on_either_side_of_a_jump_are_exact(lean, height, seed):
    """A cubic interpolates cubics, on whichever side, as far as there are four points of it."""
    grid = Grid(GridAxis(-1.0, 0.1, 21), GridAxis(-1.0, 0.125, 17))
    t, r = np.meshgrid(grid.travel.values, grid.rack.values, indexing="ij")
    c = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 4, 4))

    def gap(t, r):
        return t - 0.5 * height - 0.1 * lean * r  # at least eight points of either side

    def function(t, r):
        t, r = np.broadcast_arrays(t, r)
        sides = [np.polynomial.polynomial.polyval2d(t, r, part) for part in c]
        return np.where(gap(t, r) <= 0.0, *sides)

    random = np.random.default_rng(seed + 1)
    travel, rack = random.uniform(-1.0, 1.0, 6), random.uniform(-1.0, 1.0, 5)
    near = grid.interpolate_apart(function(t, r), [gap(t, r)], travel, rack)
    exact = function(travel[:, None], rack[None, :])
    # 16 terms below 1, and weights whose sizes add up to 31 at most for two steps beyond the points
    sure = np.abs(gap(travel[:, None], rack[None, :])) > 1e-12  # on the jump either side is right
    assert np.abs(near - exact)[sure].max(initial=0.0) < 16 * 31**2 * 4 * np.finfo(float).eps


def test_part_without_points_is_interpolated_plainly():
    grid = Grid(GridAxis(0.0, 1.0, 5), GridAxis(0.0, 1.0, 5))
    t = np.broadcast_to(grid.travel.values[:, None], grid.shape)
    gaps = [t - 1.4, 1.6 - t]  # both closed nowhere, both open nowhere but between two lines
    near = grid.interpolate_apart(t, gaps, [1.5], [2.0])
    assert near.item() == pytest.approx(1.5, abs=1e-15)


def test_wheel_rate_beside_the_stops_is_that_of_the_model():
    """The model's own values, at travels on either side of both stops, to a digit that is shown."""
    drawn = curves(CAR, GRID.travel.values, GRID.rack.values)
    gaps = gaps_on(CAR, GRID)
    assert len(gaps) == 2
    ranges = {curve.key: shown_range(curve.values) for curve in drawn}
    sampled = poses(CAR, GRID.travel.values, GRID.rack.values)
    errors = measure(CAR, GRID, sampled, drawn, gaps, ranges).curves
    across = measure(CAR, GRID, sampled, drawn, [], ranges).curves
    keys = [curve.key for curve in drawn if curve.jumps]
    assert {key.removesuffix("_over_rack") for key in keys} == AT_STOPS
    # N/mm; a cubic across the jump is wrong by a part of the jump, which is tens of them
    assert max(errors[key] for key in keys) < 0.3
    assert min(across[key] for key in keys) > 10.0


def test_nothing_else_jumps():
    """Every other characteristic is continuous where a stop begins to act."""

    def gap(travel):
        state = state_at_height(CAR, design_height(CAR) + travel)
        return float(CAR.signal("strut_length", state)) - CAR.parameters["bump_stop_length"]

    touching = brentq(gap, 0.0, 0.1, xtol=1e-12)
    beside = 1e-7  # m
    found = characteristics.over(CAR, "travel", [touching - beside, touching + beside])
    for name, variable in found.data_vars.items():
        before, behind = variable.values
        if name in AT_STOPS:
            assert abs(behind - before) > 1e3, name  # N/m
        else:
            # what is smooth changes by its slope times 0.2 um: slopes are below 1e3 of the size
            assert abs(behind - before) <= 1e3 * 2.0 * beside * max(abs(before), 1.0), name
