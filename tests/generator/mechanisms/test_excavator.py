"""The excavator: signs of its cylinders, their reach, and the order of its loops.

`test_mechanisms` compares its motion and its equations with maximal coordinates.
"""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo.generated import excavator, excavator_lifting
from kintrafo.generator.mechanisms.excavator import MODELS
from kintrafo.generator.planning.plan import CataloguePlan
from support.changes import changed

CYLINDERS = ("boom", "arm", "bucket")


def state_at(strokes):
    return np.array([*strokes, 0.0, 0.0, 0.0])


EPSILON = 2.0**-52


def test_signs_are_those_of_the_table():
    """Extended, the boom rises, the arm comes in, and the bucket curls in."""
    angles = ("boom_angle", "arm_angle", "bucket_angle")
    names = list(excavator.RELATIVE_COORDINATES)
    rows = [names.index(a) for a in angles]
    rng = np.random.default_rng(7)
    for strokes in rng.uniform((-0.55, -0.45, -0.35), (0.55, 0.85, 0.55), (40, 3)):
        rates = excavator.relative_jacobian(state_at(strokes))[rows]
        assert rates[0, 0] < 0.0  # positive down
        assert rates[1, 1] > 0.0
        assert rates[2, 2] > 0.0
        # differences of sums of some sixty products, each as large as the rates themselves
        rounding = 64 * EPSILON * np.abs(rates).max()
        np.testing.assert_allclose(rates[~np.eye(3, dtype=bool)], 0.0, atol=rounding)


@pytest.mark.parametrize(
    ("cylinder", "beyond", "loop"),
    [
        ("boom", 1.0, "chassis - boom_barrel - boom_rod - boom"),
        ("arm", 1.4, "boom - arm - arm_rod - arm_barrel"),
        ("bucket", 1.5, "arm - rocker - bucket_rod - bucket_barrel"),
    ],
)
def test_a_stroke_out_of_reach_names_its_loop(cylinder, beyond, loop):
    strokes = np.zeros(3)
    strokes[CYLINDERS.index(cylinder)] = beyond
    with pytest.raises(excavator.ClosureError) as error:
        excavator.rhs(state_at(strokes))
    assert set(loop.split(" - ")) <= set(error.value.reasons[0].replace(" cannot", "").split())


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_loops_wait_for_those_that_they_hang_on(model):
    """The bucket's loops declared first and its bodies numbered first: the same loops."""
    mechanism = model.mechanism
    backward = ((body, replace(body, order=-body.order)) for body in mechanism.bodies)
    turned = changed(mechanism, *backward)
    turned = replace(turned, joints=turned.joints[::-1])
    assert turned.bodies[1:] == mechanism.bodies[:0:-1]
    plan, expected = CataloguePlan.of(replace(model, mechanism=turned)), CataloguePlan.of(model)
    assert {t.cycle.key for t in plan.transformers} == {t.cycle.key for t in expected.transformers}
    assert plan.transformers[0].cycle.key == expected.transformers[0].cycle.key


def test_mobility():
    assert excavator.MOBILITY == 3
    assert len(MODELS[1].inputs) == 3 * (excavator_lifting.MOBILITY - 1)
    assert len(excavator.LOOPS) == 4
