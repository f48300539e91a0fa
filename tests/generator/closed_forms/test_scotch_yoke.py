"""A pin in a slot: the Scotch yoke, on the ground and on a body that moves."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo.generator import Motion
from kintrafo.generator.closed_forms.scotch_yoke import ScotchYoke
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms.scotch_yokes import yoke
from oracle.random_states import check_with_the_oracle

CASES = (yoke("scotch_yoke"), yoke("turned_yoke", turned=True), yoke("carried_yoke", carried=True))


@pytest.mark.parametrize("model", CASES, ids=lambda model: model.name)
def test_it_moves_as_the_oracle_says_all_around(model, tmp_path):
    (transformer,) = CataloguePlan.of(model).transformers
    assert type(transformer.step) is ScotchYoke
    built = check_with_the_oracle(model, tmp_path, np.pi)
    for angle in np.linspace(-np.pi, np.pi, 7):
        state = np.concatenate((np.full(built.size, angle), np.zeros(built.size)))
        given = built("relative_coordinates", state)
        residuals = built.residuals(given, state, np.zeros(len(built.module.INPUTS)))
        np.testing.assert_allclose(residuals, 0.0, atol=1e-14)


def test_a_crank_that_is_driven_by_what_is_given_drives_it_too(tmp_path):
    model = yoke("given_yoke", carried=True)
    frame, crank = model.independent
    turn = Motion("turn", "rad", "turn of the frame")
    given = replace(model, independent=(crank,), prescribed={frame: turn})
    check_with_the_oracle(given, tmp_path, 1.0)


def test_a_slot_along_the_guide_is_refused(tmp_path, refused):
    built = check_with_the_oracle(CASES[0], tmp_path, 1.0, count=1)
    along = {**built.parameters, "slot_x": 1.0, "slot_y": 0.2}
    refused(ValueError, lambda: built.module.prepare(along))
