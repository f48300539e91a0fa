"""What acts on single joints, points and bodies, against the mechanism in maximal coordinates."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from changes import changed
from kintrafo.generator import Direction, Formulation, Weight
from oracle_check import check_with_the_oracle
from own_forces import loaded_bar, loaded_crank

if TYPE_CHECKING:
    from pathlib import Path

TILTED = Weight(upward=Direction("uphill", (0.5, -0.4, 2.0)))


def under_a_slope(model: Formulation) -> Formulation:
    """Return a model on which gravity does not pull downward."""
    (weight,) = (f for f in model.mechanism.forces if isinstance(f, Weight))
    return changed(model, (weight, TILTED))


@pytest.mark.parametrize(
    "model", [under_a_slope(loaded_crank()), loaded_bar()], ids=lambda m: m.name
)
def test_accelerations_are_those_of_maximal_coordinates(model: Formulation, tmp_path: Path) -> None:
    check_with_the_oracle(model, tmp_path, reach=0.2)


def test_only_the_direction_of_fixed_components_counts(tmp_path: Path) -> None:
    """A guide along (1.0, 0.3, -0.2), which is no unit vector, slides by metres."""
    model = loaded_crank("fixed_way")
    way = model.mechanism.joint("way")
    fixed = replace(way, direction=Direction("fixed_way", fixed=(1.0, 0.3, -0.2)))
    check_with_the_oracle(changed(model, (way, fixed)), tmp_path, reach=0.1, count=3)
