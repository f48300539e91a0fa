"""Cars against the oracle in maximal coordinates; what their equations take."""

import numpy as np
import pytest
from kintrafo.generator.equations.in_motion import InMotion
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.kinematics.jointed import jointed_base
from kintrafo.generator.mechanisms import MODELS, car, model_named
from mechanisms.free_bodies import compared
from oracle.random_states import check_with_the_oracle
from support.models import Built, own

WISHBONES = model_named("double_wishbone")


def front_and_rear():
    """Return the axles of the reference car."""
    struts = car.of_corners(model_named("macpherson"), pulls="control_arm")
    return struts, car.of_corners(WISHBONES, steered=False)


def axles_without_sides():
    """Return a rigid axle and a twist-beam axle, which have coordinates named as a body's."""
    rigid, twisted = (car.of_whole_axle(model_named(n)) for n in ("rigid_axle", "twist_beam"))
    return rigid, twisted


@pytest.mark.parametrize(
    ("model", "operations"),
    [
        pytest.param(car.quarter(model_named("macpherson")), 550, id="quarter"),
        pytest.param(
            car.car("on_beams", "A car", axles_without_sides(), car.FREEDOMS[:1]),
            None,
            id="on beams",
        ),
        pytest.param(
            car.car("rolling", "A car", front_and_rear(), car.FREEDOMS), 5400, id="car that rolls"
        ),
    ],
)
def test_accelerations_are_those_of_the_oracle(model, operations, tmp_path):
    check_with_the_oracle(model, tmp_path, reach=0.05, count=3, operations=operations)


def test_a_car_that_moves_freely_is_that_of_the_oracle():
    arms = car.of_corners(model_named("trailing_arm"))
    model = car.car("free", "A car", (arms, arms), car.FREE)
    built = Built.of(model, own(model, arrays=True, derivatives=False))
    for state, inputs, _, expected, positions in compared(built, 2):
        found, scale = built("rhs", state, inputs), np.abs(expected.accelerations).max()
        np.testing.assert_allclose(
            found[positions:], expected.accelerations, rtol=1e-10, atol=1e-10 * scale
        )


def test_only_a_body_that_carries_all_is_a_base():
    assert jointed_base(car.quarter(WISHBONES)) == ([], "body")
    bodies = ["body_after_heave", "body_after_pitch"]
    rolling = car.car("rolling", "A car", front_and_rear(), car.FREEDOMS)
    assert jointed_base(rolling) == (bodies, "body")
    assert [m.name for m in MODELS if jointed_base(m)] == ["quarter_macpherson"]


def test_a_base_takes_fewer_operations(monkeypatch):
    """A suspension that is solved on its body is not solved in the axes of the world."""
    model = car.quarter(WISHBONES)

    def steps():
        return len(generate(model, derivatives=False).functions["rhs"].steps)

    on_base = steps()
    monkeypatch.setattr(f"{InMotion.__module__}.jointed_base", lambda _: None)
    assert on_base < steps()
