"""The characteristics of assemblies, each with its formula.

    `measure`      the class of a measure, and its evaluation
    `quantities`   name, unit, definition and sign of each quantity
    `corner`, `axle`      the measures of a wheel, and of two of them
    `rigid_axle`, `steered_rigid_axle`, `twist_beam`  those of axles without sides
    `whole_axle`   springs and dampers of any axle without sides
    `rolling`      track, roll moment and roll stiffness of two wheels: the formulas
    `axle_rolling` roll centre, jacking and the anti-roll bar of two corners
    `pitching`     anti-dive, anti-lift and anti-squat
    `ackermann`    comparisons of two steered wheels

The formulas of a wheel are in `kintrafo.vehicle.assembly.wheel`.
"""

from collections.abc import Iterator
from importlib import import_module

from ...data.starter import whole_axles
from .measure import Measure


def of_whole_axles() -> Iterator[Measure]:
    """Yield the measures of all axles without sides, from the modules with their names."""
    for key in reversed(whole_axles()):
        yield from import_module(f".{key}", __package__).MEASURES
