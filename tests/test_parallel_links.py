"""Three parallel cranks on one rod, as on a locomotive: one equation more than it takes."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import kintrafo
import numpy as np
import pytest
from changes import with_default
from kintrafo import generator as g
from kintrafo.equations.errors import ParameterError
from kintrafo.generator.closed_forms.parallel_links import ParallelLinks
from kintrafo.generator.planning.plan import Plan
from oracle_check import check_with_the_oracle
from own_models import derive, own
from own_wheels import locomotive

if TYPE_CHECKING:
    from pathlib import Path


def test_it_moves_as_the_oracle_says(tmp_path: Path) -> None:
    model = locomotive("four_wheels", (0.0, 0.9, 1.7, 2.6))
    plan = Plan.of(model)
    assert [type(t.step) for t in plan.transformers] == [ParallelLinks] * 3
    assert plan.topology.mobility == 2
    check_with_the_oracle(model, tmp_path, pi)


def test_any_wheel_may_drive_and_all_turn_alike(tmp_path: Path) -> None:
    model = locomotive("rear_drive")
    swing, first = model.independent
    last = model.mechanism.joint("axle_2")
    forces = tuple(f for f in model.mechanism.forces if f.along != first)
    mechanism = replace(model.mechanism, forces=forces)
    driven = replace(model, mechanism=mechanism, independent=(swing, last))
    built = check_with_the_oracle(driven, tmp_path, pi)
    names = list(built.module.RELATIVE_COORDINATES)
    state = np.array([0.2, 2.5, 0.0, 0.0])
    found = built("relative_coordinates", state)
    shown = dict(zip(names, found, strict=True))
    assert shown["axle_0_angle"] == pytest.approx(2.5, abs=1e-14)
    assert shown["axle_1_angle"] == pytest.approx(2.5, abs=1e-14)
    assert shown["crank_1_angle"] == pytest.approx(-2.5, abs=1e-14)
    residuals = built.residuals(found, state, np.zeros(len(built.module.INPUTS)))
    np.testing.assert_allclose(residuals, 0.0, atol=1e-14)


def test_what_can_drive_it_is_found() -> None:
    mechanism = replace(locomotive().mechanism, forces=())
    found = [p.independent for p in kintrafo.proposals(mechanism)]
    assert {("swing", f"axle_{i}") for i in range(3)} <= set(found)


def test_a_crank_that_is_not_parallel_is_told_by_how_much() -> None:
    bent = with_default(locomotive("bent"), pin_2_x=1.9)
    with pytest.raises(g.DeclarationError, match=r"wheel2 and wheel0 hold rod .*off by .* mm"):
        derive(bent, derivatives=False)


def test_parameters_that_lock_it_are_refused() -> None:
    model = own(locomotive(), arrays=True, derivatives=False)
    with pytest.raises(ParameterError, match="not parallel and equally long, so that nothing"):
        kintrafo.System(model, {"bearing_1_z": 0.5})
