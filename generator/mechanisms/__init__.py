"""The mechanisms that come with the project, each declared on a page of its own."""

from ..declare import Formulation
from . import (
    andrews,
    double_wishbone,
    excavator,
    four_bar,
    front_axle,
    macpherson,
    multi_link,
    pull_rod,
    push_rod,
    rigid_axle,
    slider_crank,
    trailing_arm,
)

MODELS = (
    *macpherson.MODELS,
    *double_wishbone.MODELS,
    *push_rod.MODELS,
    *pull_rod.MODELS,
    *multi_link.MODELS,
    *trailing_arm.MODELS,
    *front_axle.MODELS,
    *rigid_axle.MODELS,
    *four_bar.MODELS,
    *slider_crank.MODELS,
    *andrews.MODELS,
    *excavator.MODELS,
)
"""Those that are emitted with the project."""

_SELDOM = (macpherson.GENERAL_FREE_RACK,)


def model_named(name: str) -> Formulation:
    """Return the equations of a name, of those that are emitted or derived when they are needed."""
    return next(model for model in (*MODELS, *_SELDOM) if model.name == name)
