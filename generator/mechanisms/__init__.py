"""The mechanisms that come with the project, each declared on a page of its own."""

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
    slider_crank,
)

MODELS = (
    *macpherson.MODELS,
    *double_wishbone.MODELS,
    *push_rod.MODELS,
    *pull_rod.MODELS,
    *multi_link.MODELS,
    *front_axle.MODELS,
    *four_bar.MODELS,
    *slider_crank.MODELS,
    *andrews.MODELS,
    *excavator.MODELS,
)
