"""Characteristics of an axle as a rig finds them: parallel travel, roll, one wheel, steering.

    `motions`    where the wheels are: `bump`, `roll`, `single`, `steer`
    `line`       the line through the wheel centres, whose inclination is the roll
    `pair`       both wheels and the anti-roll bar in many positions
    `rolling`    roll centre, roll stiffness and jacking: the formulas
    `pitching`   anti-dive, anti-lift and anti-squat: the formulas
    `catalogue`  name, unit, definition and sign of each
    `datasets`   the labelled arrays
    `compare`    several axles over one motion
    `compliance` how both wheels give way together
    `deflection` the same by equilibrium, under loads of any size
    `elastokinematics` what bushes do over the motions of a rig
    `on_bushes`  both sides on their bushes

What a single wheel does is in `kintrafo.characteristics`. Definitions and signs: docs/axles.md.
"""

from ...assembly.motions import MOTIONS
from ...assembly.rig import Extent
from .compare import compare, over
from .datasets import bump, by_side, roll, single, steer

__all__ = [
    "MOTIONS",
    "Extent",
    "bump",
    "by_side",
    "compare",
    "over",
    "roll",
    "single",
    "steer",
]
