"""Three parallel cranks on one rod, as on a locomotive: one equation more than it takes."""

from dataclasses import replace
from itertools import permutations
from math import pi

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.equations.errors import ParameterError
from kintrafo.generator.closed_forms.parallel_links import ParallelLinks
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms.coupled_wheels import PINS, double_crank, locomotive, table_on_links
from oracle.random_states import check_with_the_oracle
from support.changes import with_default
from support.models import derive, own


def test_it_moves_as_the_oracle_says(tmp_path):
    model = locomotive("four_wheels", (0.0, 0.9, 1.7, 2.6))
    plan = CataloguePlan.of(model)
    assert [type(t.step) for t in plan.transformers] == [ParallelLinks] * 3
    assert plan.topology.mobility == 2
    check_with_the_oracle(model, tmp_path, pi)


def test_any_wheel_may_drive_and_all_turn_alike(tmp_path):
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


def test_what_can_drive_it_is_found():
    mechanism = replace(locomotive().mechanism, forces=())
    found = [p.independent for p in kintrafo.proposals(mechanism)]
    assert {("swing", f"axle_{i}") for i in range(3)} <= set(found)


def test_a_crank_that_is_not_parallel_is_reported_by_how_much(refused):
    bent = with_default(locomotive("bent"), pin_2_x=1.9)
    refused(g.DeclarationError, lambda: derive(bent, derivatives=False))


def test_parameters_that_lock_it_are_refused(refused):
    model = own(locomotive(), arrays=True, derivatives=False)
    refused(ParameterError, lambda: kintrafo.System(model, {"bearing_1_z": 0.5}))


LOCKED = {
    "the ground link is across": (PINS, {"lean": 0.05}),
    "four links": ((*PINS, (0.15, 0.1)), {"lean": 0.05}),
    # the design position is a dead point: at first order, the rocker turns as the crank does
    "the ground link is parallel and longer": (PINS, {"way": 0.35}),
    "two of the links are the same": ((PINS[0], PINS[0], PINS[1]), {"lean": 0.05}),
}


@pytest.mark.parametrize("allow_iteration", [False, True])
@pytest.mark.parametrize("case", LOCKED)
def test_links_of_bodies_that_another_loop_turns_are_refused(case, allow_iteration, refused):
    """Crank and rocker turn against each other, as the frame has it, and the links forbid that."""
    pins, more = LOCKED[case]
    model = replace(double_crank("locked", pins, **more), allow_iteration=allow_iteration)
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


def test_in_whatever_order_links_are_declared_they_are_refused():
    for pins in permutations(PINS):
        model = double_crank("locked", pins, lean=0.05)
        joints = model.mechanism.joints
        for order in (joints, joints[::-1]):
            turned = replace(model, mechanism=replace(model.mechanism, joints=order))
            with pytest.raises(NoClosedFormError, match=r"link\d, link\d"):
                CataloguePlan.of(turned)


@pytest.mark.parametrize("also", ["crank_0", "axle_1", "crank_1", "axle_2", "crank_2"])
def test_what_the_links_determine_cannot_be_driven_too(also, refused):
    model = locomotive("driven_twice")
    driven = tuple(map(model.mechanism.joint, ("swing", "axle_0", also)))
    refused(NoClosedFormError, lambda: CataloguePlan.of(replace(model, independent=driven)))


@pytest.mark.parametrize("driven", ["crank_bearing", "rocker_bearing"])
def test_a_frame_that_is_one_more_parallel_link_moves_with_them(driven, tmp_path):
    """Behind the dead points, too, where a four-bar of one link would leave the parallelogram."""
    model = double_crank(f"by_{driven}", driven=("swing", driven))
    plan = CataloguePlan.of(model)
    assert plan.topology.mobility == 2
    assert [type(t.step) for t in plan.transformers] == [ParallelLinks] * 3
    check_with_the_oracle(model, tmp_path, pi)


def test_a_frame_that_is_no_longer_parallel_is_refused_by_its_name(refused):
    model = own(double_crank("double_crank"), arrays=True, derivatives=False)
    refused(ParameterError, lambda: kintrafo.System(model, {"d_x": 0.5}))


def test_links_on_the_same_pins_turn_with_the_first(tmp_path):
    check_with_the_oracle(double_crank("same", PINS[:1] * 3, lean=0.05), tmp_path, 0.5)


def test_links_whose_pins_are_no_longer_the_same_are_refused(refused):
    model = own(double_crank("same", PINS[:1] * 3, lean=0.05), arrays=True, derivatives=False)
    moved = {
        f"{pin}_1_{x}": kintrafo.System(model).parameters[f"{pin}_0_{x}"] + 0.01
        for pin in "bc"
        for x in "xyz"
    }  # parallel and equally long all the same
    refused(ParameterError, lambda: kintrafo.System(model, moved))


def test_a_table_that_guides_keep_from_turning_has_links(tmp_path):
    model = table_on_links("table")
    assert ParallelLinks in [type(t.step) for t in CataloguePlan.of(model).transformers]
    check_with_the_oracle(model, tmp_path, 0.02)
