"""A mechanism moves in company as it moves alone.

Beside a copy of it stands its mirror image, in one mechanism with it. Both get the state of the
original, and so they have its accelerations.
"""

import numpy as np
import pytest
import sympy as sp
from kintrafo import generator as g
from kintrafo.generator.closed_forms.catalogue import STEPS
from kintrafo.generator.closed_forms.free_body import PlaceFree
from kintrafo.generator.closed_forms.passive_turn import PlacePassive
from kintrafo.generator.mechanisms import chains
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.program import ConstantStage, Program
from mechanisms.beside_mirror_image import EVERY, check_in_company
from support.models import Built, needs_gcc, own

SAMPLE = (
    "macpherson", "pushed_slider", "lifted_turret", "inverted_crank", "control_arm_multi_link",
    "plate_on_a_pin", "knee_bar", "scotch_yoke", "shaft_shake_behind_tilt_with_a_burden",
    "crosses_in_a_row", "locomotive",
)  # fmt: skip
"""Mechanisms with every step of the catalogue; all of them are tried by the fuzzer."""


@pytest.mark.parametrize("name", SAMPLE)
def test_a_copy_and_an_image_move_as_the_original_does(name):
    check_in_company(EVERY[name], np.random.default_rng([*name.encode()]))


def test_the_sample_has_every_step_of_the_catalogue():
    found = {type(action) for name in SAMPLE for action in CataloguePlan.of(EVERY[name]).steps}
    # the one is in no model but test_struts', the other has no equations yet
    assert found >= STEPS - {PlacePassive, PlaceFree}


def test_a_step_does_not_take_the_name_of_a_parameter_of_a_copy():
    """A step of that name would be replaced by the expression of the parameter."""
    height, angle = sp.symbols("rod_end_x angle")
    stage = ConstantStage(
        (height,), frozenset(["angle"]), derived={sp.Symbol("a_rod_end_x"): -height}
    )
    program = Program(stage)
    step = program.define("a_rod_end_x", sp.sin(angle))
    doubled = program.define("doubled", 2 * step)
    assert program.steps[doubled].expression == 2 * step


def test_a_copy_and_its_mirror_image_are_distinguished_where_their_defaults_do_not():
    ground, arm = g.Ground("ground"), g.Body("arm", 1.0, (0.0, 0.0, 1.0), (1.0, 1.0, 1.0))
    hinge = g.Revolute("hinge", ground, arm, g.Line(g.Point("pivot", (0.0, 0.0, 0.0)), g.FORWARD))
    flat = g.Mechanism("flat", "Flat", (hinge,), coordinates=(hinge.angle("turn", "angle"),))
    same, image = (g.Copy(flat, "one_", mirrored=mirrored).mechanism for mirrored in (False, True))
    assert repr(same) != repr(image)  # what is compiled is kept under it


@needs_gcc
def test_names_that_are_longer_than_a_line_stay_whole():
    """Lines of C end between words, also where a signature leaves no room beside it."""
    one = g.Copy(
        chains.BRICARD.mechanism, "of_a_copy_whose_name_alone_takes_nearly_the_whole_line_"
    )
    model = g.Formulation(
        name="long_names",
        title="Bricard's chain with long names",
        mechanism=g.combined("long_names", "Long names", (one,)),
        independent=one.of(chains.BRICARD.independent),
        massive=one.of(chains.BRICARD.massive),
        allow_iteration=True,
    )
    built = Built.of(model, own(model, derivatives=False))
    rates = built("rhs", np.append(built.design, 1.0))
    assert np.isfinite(rates).all()
